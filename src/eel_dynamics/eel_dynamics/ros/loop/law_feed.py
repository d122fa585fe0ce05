"""Laws and samples of laws: checked as they arrive, each taken once, and given to the simulation.

Laws come over two subscriptions (one that also hears what was published before it, one that hears any publisher), so
that most arrive twice. Where laws come faster than they are read, each subscription drops others of them: one that the
other subscription has dropped is no news.
"""

import reprlib
from collections import deque

from eel_gaits.wording import shown

from eel_dynamics.ros.diagnostics import ERROR

FAR_AHEAD = 3600.0  # s: a stamp so far ahead of the simulation is wall time by mistake
DROPPED = 1_000_000_000  # ns: a publisher's earlier law that comes after a later one is no older than this
SHOWN = reprlib.Repr()
SHOWN.maxstring = 60  # characters of a refused law's name
UNFIT = ValueError, ArithmeticError, MemoryError  # what the simulation refuses laws and samples with


class LawFeed:
    """Takes laws and samples from messages to `run` (time, take_law, take_samples), in the thread of callbacks.

    opened: what arrives, to a CurvatureLaw's name and a function that gives the message. law_of, samples_of: a message
    to a `Law`, to the arguments of `Simulation.add_samples`. ValueError: what is wrong.
    """

    def __init__(self, run, report, *, opened, law_of, samples_of):
        self._run, self._report = run, report
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
            self._run.take_law(law, origin)

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
            self._run.take_samples(samples)

    def _checked_stamp(self, stamp) -> float:
        time = stamp.sec + 1e-9 * stamp.nanosec
        if stamp.sec < 0 or stamp.nanosec >= 1_000_000_000:
            raise ValueError(
                f"header.stamp must be >= 0 s, with nanosec < 1e9, got sec {stamp.sec}, nanosec {stamp.nanosec}"
            )
        if time > self._run.time + FAR_AHEAD:
            raise ValueError(
                f"header.stamp must be simulation time, at most {FAR_AHEAD:g} s ahead of {self._run.time:g} s, "
                f"got {time:.3f} s: that looks like wall time, does its publisher have use_sim_time set?"
            )
        return time


class LawAdopter:
    """Gives laws and samples to the `simulation`, in the thread of the run loop; `SimulationStopped`: it cannot go on
    with a law."""

    def __init__(self, simulation, report):
        self._simulation, self._report = simulation, report
        self._origin = 0.0  # s: simulation time of the law's t = 0

    @property
    def name(self) -> str:
        """Name of what the swimmer follows."""
        simulation = self._simulation
        if simulation.sampled or simulation.resting:
            return "curvature_samples"
        return simulation.law.name if simulation.law is not None else ""

    def adopt(self, law, origin: float):
        """Have the swimmer follow a law whose own t = 0 lies at simulation time `origin` [s]."""
        simulation = self._simulation
        driven = simulation.law is not None and simulation.samples_until is None and not simulation.resting
        if driven and law == simulation.law and origin == self._origin:
            return  # published again: nothing to blend
        try:
            simulation.adopt(law, origin=origin)
        except UNFIT as error:
            self._report.event("law", f"law {shown(law.name)} refused: {error}", ERROR, differing=True)
        else:
            self._origin = origin
            self._report.end("resting")
            self._report.note("law taken on", f"law {shown(law.name)} taken on at t = {simulation.time:g} s")

    def add_samples(self, samples: dict):
        """Add one instant of a law: the arguments of `Simulation.add_samples`."""
        try:
            self._simulation.add_samples(**samples)
        except UNFIT as error:
            self._report.event("samples", f"curvature samples refused: {error}", ERROR)

    def lacks_samples(self, time: float) -> bool:
        """Whether the samples of a controller that drives the swimmer do not reach simulation time `time` [s] yet."""
        until = self._simulation.samples_until
        return until is not None and until < time and not self._simulation.resting

    def reset(self):
        """The law begins at t = 0 again."""
        self._origin = 0.0
        self._report.end("resting")

    def report_resting(self, time: float):
        """Log when samples have run out, or are back, at simulation time `time` [s]."""
        if self._simulation.resting:
            self._report.begin("resting", f"curvature samples have run out at t = {time:g} s: coming to rest")
        elif self._report.lasts("resting"):
            self._report.end("resting", f"curvature samples are back at t = {time:g} s")
