"""What the swimmer is told to do: laws and samples of laws as they arrive, checked, each taken once.

Laws come over two subscriptions (one that also hears what was published before it, one that hears any publisher), so
that most arrive twice. Where laws come faster than they are read, each subscription drops others of them: one that the
other subscription has dropped is no news.
"""

import reprlib
from collections import deque

from .report import ERROR

FAR_AHEAD = 3600.0  # s: a stamp so far ahead of the simulation is wall time by mistake
DROPPED = 1_000_000_000  # ns: a publisher's earlier law that comes after a later one is no older than this
SHOWN = reprlib.Repr()
SHOWN.maxstring = 60  # characters of a refused law's name


class LawFeed:
    """Hears laws and samples, and hands them to `march` (methods time, take_law, take_samples).

    opened: what arrives, to a CurvatureLaw's name and a function that gives the message. law_of, samples_of: a message
    to a `Law`, to the arguments of `Simulation.add_samples`. ValueError: what is wrong.
    """

    def __init__(self, march, report, *, opened, law_of, samples_of):
        self._march, self._report = march, report
        self._opened, self._law_of, self._samples_of = opened, law_of, samples_of
        self._heard = deque(maxlen=256)
        self._newest = {}  # subscription: its last delivery

    def hear_law(self, data, info: dict, subscription: int = 0):
        """Takes a law from `data`; `info` tells two deliveries of one message from two messages."""
        delivery = (info.get("source_timestamp"), info.get("publication_sequence_number"))
        if delivery[0] and self._is_known(delivery, subscription):
            return
        name = ""
        try:
            name, message_of = self._opened(data)
            message = message_of()
            origin = self._checked_stamp(message.header.stamp)
            law = self._law_of(message)
        except ValueError as error:
            self._report.event("law", f"law {SHOWN.repr(name)} refused: {error}", ERROR, differing=True)
        else:
            self._march.take_law(law, origin)

    def _is_known(self, delivery: tuple, subscription: int) -> bool:
        """Whether the other subscription has heard this law, or a later one of the same publisher instead."""
        heard = delivery in self._heard
        self._heard.append(delivery)
        self._newest[subscription] = delivery
        later = (newest for other, newest in self._newest.items() if other != subscription)
        return heard or any(time > delivery[0] > time - DROPPED and number > delivery[1] for time, number in later)

    def hear_samples(self, message):
        """Takes one instant of a law from a controller."""
        try:
            self._checked_stamp(message.header.stamp)
            samples = self._samples_of(message)
        except ValueError as error:
            self._report.event("samples", f"curvature samples refused: {error}", ERROR)
        else:
            self._march.take_samples(samples)

    def _checked_stamp(self, stamp) -> float:
        time = stamp.sec + 1e-9 * stamp.nanosec
        if stamp.sec < 0 or stamp.nanosec >= 1_000_000_000:
            raise ValueError(
                f"header.stamp must be >= 0 s, with nanosec < 1e9, got sec {stamp.sec}, nanosec {stamp.nanosec}"
            )
        if time > self._march.time + FAR_AHEAD:
            raise ValueError(
                f"header.stamp must be simulation time, at most {FAR_AHEAD:g} s ahead of {self._march.time:g} s, "
                f"got {time:.3f} s: that looks like wall time, does its publisher have use_sim_time set?"
            )
        return time
