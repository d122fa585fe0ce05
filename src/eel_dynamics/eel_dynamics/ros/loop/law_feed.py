"""Checks laws and samples of laws as they arrive, drops duplicates, and passes them to the simulation.

There are two subscriptions to laws: one also gets earlier messages (transient local), the other matches any publisher
(volatile). So most laws arrive twice. If laws come faster than they are read, each subscription drops different ones:
an old law that the other subscription has dropped is not adopted.
"""

import reprlib
from collections import deque

from eel_gaits.wording import shown

from eel_dynamics.ros.diagnostics import ERROR

FAR_AHEAD = 3600.0  # s: a stamp further ahead of the simulation is wall time by mistake
DROPPED = 1_000_000_000  # ns: a publisher's law that arrives after a later one is at most this much older
SHOWN = reprlib.Repr()
SHOWN.maxstring = 60  # characters of a refused law's name
REFUSALS = ValueError, ArithmeticError, MemoryError  # errors with which the simulation refuses laws and samples


class LawFeed:
    """Passes laws and samples from messages to `run` (time, take_law, take_samples), in the thread of callbacks.

    parse(data): name of a serialised CurvatureLaw, and a function that deserialises it. law_of(message): the `Law`.
    samples_of(message): the arguments of `Simulation.add_samples`. All raise `ValueError` for bad content.
    """

    def __init__(self, run, report, *, parse, law_of, samples_of):
        self._run, self._report = run, report
        self._parse, self._law_of, self._samples_of = parse, law_of, samples_of
        self._received = deque(maxlen=256)
        self._newest = {}  # subscription: its last delivery

    def receive_law(self, data, info: dict, subscription: int = 0):
        """Pass on the law in the serialised message `data`; `info`: message info, to recognise a second delivery."""
        delivery = (info.get("source_timestamp"), info.get("publication_sequence_number"))
        if delivery[0] and self._is_known(delivery, subscription):
            return
        name = ""
        try:
            name, message_of = self._parse(data)
            message = message_of()
            origin = self._checked_stamp(message.header.stamp)
            law = self._law_of(message)
        except ValueError as error:
            self._report.event("law", f"law {SHOWN.repr(name)} refused: {error}", ERROR, differing=True)
        else:
            self._run.take_law(law, origin)

    def _is_known(self, delivery: tuple, subscription: int) -> bool:
        """Whether the other subscription has received this law, or a later one of the same publisher."""
        received = delivery in self._received
        self._received.append(delivery)
        self._newest[subscription] = delivery
        later = (newest for other, newest in self._newest.items() if other != subscription)
        return received or any(time > delivery[0] > time - DROPPED and number > delivery[1] for time, number in later)

    def receive_samples(self, message):
        """Pass on one instant of a law from a controller."""
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
    """Passes laws and samples to the `simulation`, in the thread of the run loop.

    `SimulationStopped` if the simulation cannot continue with a law.
    """

    def __init__(self, simulation, report):
        self._simulation, self._report = simulation, report
        self._origin = 0.0  # s: simulation time of the law's t = 0

    @property
    def name(self) -> str:
        """Name of the law that the swimmer follows, or of the topic of samples."""
        simulation = self._simulation
        if simulation.sampled or simulation.resting:
            return "curvature_samples"
        return simulation.law.name if simulation.law is not None else ""

    def adopt(self, law, origin: float):
        """Adopt a law whose own t = 0 lies at simulation time `origin` [s]; log a refusal."""
        simulation = self._simulation
        driven = simulation.law is not None and simulation.samples_until is None and not simulation.resting
        if driven and law == simulation.law and origin == self._origin:
            return  # published again: nothing to blend
        until = simulation.samples_until
        try:
            simulation.adopt(law, origin=origin)
        except REFUSALS as error:
            self._report.event("law", f"law {shown(law.name)} refused: {error}", ERROR, differing=True)
            return
        self._origin = origin
        self._report.end("resting")
        self._report.note("law adopted", f"law {shown(law.name)} adopted at t = {simulation.time:g} s")
        if until is not None and until > simulation.time:
            self._report.event(
                "samples dropped",
                f"curvature samples up to t = {until:g} s are dropped: law {shown(law.name)} is newer",
            )

    def add_samples(self, samples: dict):
        """Add one instant of a law: the arguments of `Simulation.add_samples`."""
        try:
            self._simulation.add_samples(**samples)
        except REFUSALS as error:
            self._report.event("samples", f"curvature samples refused: {error}", ERROR)

    def lacks_samples(self, time: float) -> bool:
        """Whether a controller's samples drive the swimmer and do not reach simulation time `time` [s] yet."""
        until = self._simulation.samples_until
        return until is not None and until < time and not self._simulation.resting

    def reset(self):
        """Set the law's own t = 0 back to simulation time 0."""
        self._origin = 0.0
        self._report.end("resting")

    def report_resting(self, time: float):
        """Log when samples have run out, or are back, at simulation time `time` [s]."""
        if self._simulation.resting:
            self._report.begin("resting", f"curvature samples have run out at t = {time:g} s: coming to rest")
        elif self._report.lasts("resting"):
            self._report.end("resting", f"curvature samples are back at t = {time:g} s")
