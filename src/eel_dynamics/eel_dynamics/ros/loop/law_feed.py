# SPDX-License-Identifier: Apache-2.0
"""Checks laws and samples of laws as they arrive, drops duplicates, and passes them to the simulation.

A subscription that takes samples from best-effort publishers takes those of reliable publishers a second time.

There are two subscriptions to laws: one also gets earlier messages (transient local), the other matches any publisher
(volatile). So most laws arrive twice. If laws come faster than they are read, each subscription drops different ones:
an old law that the other subscription has dropped is not adopted.
"""

import reprlib
import time

import numpy as np
from eel_base.wording import shown
from eel_ros.deliveries import Deliveries
from eel_ros.stamps import seconds_of

from eel_dynamics.curvature.curvature_samples import LateSample
from eel_dynamics.ros.diagnostics import ERROR, WARN

FAR_AHEAD = 3600.0  # s: a stamp further ahead of the simulation is wall time by mistake
DROPPED = 1_000_000_000  # ns: a publisher's law that arrives after a later one is at most this much older
JOIN = "a controller that joins a running simulation begins 1/rate or more after the stamp of the last odom"
LONGEST_WAY = 5.0  # s from the last sample, or from the simulation, to the next one: it is not on the same way
ECHO = 2.0  # s after a reset, within which samples that were sent before it may come
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
        self._laws, self._samples = Deliveries(), Deliveries()
        self._newest = {}  # subscription: time of sending [ns] and count of its last law

    def receive_law(self, data, info: dict, subscription: int = 0):
        """Pass on the law in the serialised message `data`; `info`: message info, to recognise a second delivery."""
        if self._is_outdated(info, subscription) or self._laws.repeats(info):
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

    def _is_outdated(self, info: dict, subscription: int) -> bool:
        """Whether the other subscription has received a later law of the same publisher."""
        sent, count = delivery = info.get("source_timestamp"), info.get("publication_sequence_number")
        if not sent or count is None:  # the middleware does not tell
            return False
        self._newest[subscription] = delivery
        others = (newest for other, newest in self._newest.items() if other != subscription)
        return any(later > sent > later - DROPPED and further > count for later, further in others)

    def receive_samples(self, message, info: dict):
        """Pass on one instant of a law from a controller; `info` as in `receive_law`."""
        if self._samples.repeats(info):
            return
        try:
            self._checked_stamp(message.header.stamp)
            samples = self._samples_of(message)
        except ValueError as error:
            self._report.event("samples", refused(error), ERROR)
        else:
            self._run.take_samples(samples)

    def _checked_stamp(self, stamp) -> float:
        stamped = seconds_of(stamp)
        if stamped > self._run.time + FAR_AHEAD:
            raise ValueError(
                f"header.stamp must be simulation time, at most {FAR_AHEAD:g} s ahead of {self._run.time:g} s, "
                f"got {stamped:.3f} s: that looks like wall time, does its publisher have use_sim_time set?"
            )
        return stamped


def refused(error: Exception, driven: bool = False) -> str:
    """The log line for curvature samples that are refused with `error`. driven: whether others drive the swimmer, or
    have run out."""
    reason = str(error).removeprefix("curvature samples ")
    if reason.startswith("time "):
        reason = f"header.stamp{reason.removeprefix('time')}"
    if isinstance(error, LateSample):
        reason += f": {'send them further ahead' if driven else JOIN}"
    return f"curvature samples refused: {reason}"


class LawAdopter:
    """Passes laws and samples to the `simulation`, in the thread of the run loop.

    `SimulationStopped` if the simulation cannot continue with a law.

    Attributes:
        simulation: may be replaced at a reset.
    """

    def __init__(self, simulation, report):
        self.simulation, self._report = simulation, report
        self._origin = 0.0  # s: simulation time of the law's t = 0
        self._first = {}  # time [s] of the instants that were added at the start, and a hash of the values
        self._driven = False  # whether a controller's samples drove the swimmer when it was last looked at
        self._farthest = 0.0  # s: the greatest time by which a sample lay ahead of the simulation
        self._echo_until = 0.0  # s, steady clock: until when samples from before the last reset may come

    @property
    def name(self) -> str:
        """Name of the law that the swimmer follows, or of the topic of samples."""
        simulation = self.simulation
        if simulation.sampled or simulation.resting:
            return "curvature_samples"
        return simulation.law.name if simulation.law is not None else ""

    def adopt(self, law, origin: float):
        """Adopt a law whose own t = 0 lies at simulation time `origin` [s]; log a refusal."""
        simulation = self.simulation
        driven = simulation.law is not None and simulation.samples_until is None and not simulation.resting
        if driven and law == simulation.law and origin == self._origin:
            return  # published again: nothing to blend
        until = simulation.samples_until
        try:
            simulation.adopt(law, origin=origin)
        except REFUSALS as error:
            self._report.event("law", f"law {shown(law.name)} refused: {error}", ERROR, differing=True)
            return
        self._origin, self._driven = origin, False
        self._report.end("resting")
        self._report.note("law adopted", f"law {shown(law.name)} adopted at t = {simulation.time:g} s")
        if until is not None and until > simulation.time:
            self._report.event(
                "samples dropped",
                f"curvature samples up to t = {until:g} s are dropped: law {shown(law.name)} is newer",
            )

    def add_samples(self, samples: dict, period: float = 0.0):
        """Add one instant of a law: the arguments of `Simulation.add_samples`, in a run of one every `period` [s].

        An instant that is the same as one from before the start is an answer to a repeated sample 0, and changes
        nothing. Shortly after a reset, a sample that lies more than twice as far ahead as any before was sent before
        the controller saw the reset, and is left out. One far from all others would be the end of a long, wide
        swing of the body once they run out, and is refused.
        """
        ahead = samples["time"] - self.simulation.time
        if ahead > 2.0 * self._farthest and time.monotonic() < self._echo_until:
            self._report.note("echo", f"curvature samples of {samples['time']:g} s left out: sent before the reset")
            return
        values = hash(tuple(np.asarray(row).tobytes() for name, row in samples.items() if name != "time"))
        if self._first.get(samples["time"]) == values:
            return
        try:
            self._check_way(samples["time"], max(LONGEST_WAY, 2.0 * period))
            self.simulation.add_samples(**samples)
        except REFUSALS as error:
            level = WARN if isinstance(error, LateSample) else ERROR
            driven = self.simulation.sampled or self.simulation.resting
            self._report.event("samples", refused(error, driven), level)
        else:
            self._farthest = max(self._farthest, ahead)
            if self.simulation.time == 0.0:
                self._first[samples["time"]] = values

    def _check_way(self, time: float, longest: float):
        """`ValueError` for a sample of `time` [s] more than `longest` [s] after the last one, or the simulation."""
        last = max(self.simulation.time, self.simulation.samples_until or 0.0)
        if time > last + longest:
            raise ValueError(
                f"time must be at most {longest:g} s after the last sample or the simulation ({last:.9g} s), "
                f"got {time:.9g} s"
            )

    def lacks_samples(self, instant: float) -> bool:
        """Whether a controller's samples drive the swimmer and do not reach simulation time `instant` [s] yet."""
        until = self.simulation.samples_until
        return until is not None and until < instant and not self.simulation.resting

    def report_missing(self, instant: float, period: float, waited: float):
        """Log that samples up to `instant` [s], a `period` [s] ahead, were `waited` [s] for in vain."""
        self._report.event(
            "missing samples",
            f"no curvature sample for t >= {instant:.9g} s within {waited:g} s, the newest is for t = "
            f"{self.simulation.samples_until:.9g} s: at real_time_factor 0 a controller's samples must lie at least "
            f"1/rate = {period:.9g} s ahead of the simulation",
        )

    def reset(self):
        """Set the law's own t = 0 back to simulation time 0."""
        self._origin, self._driven = 0.0, False
        self._first.clear()
        if self._farthest > 0.0:
            self._echo_until = time.monotonic() + ECHO
        self._report.end("resting")

    def report_samples(self, instant: float):
        """Log when samples are adopted, have run out, or are back, at simulation time `instant` [s]."""
        lost, told = self.simulation.resting, self._report.lasts("resting")
        if lost and not told:
            self._report.begin("resting", f"curvature samples have run out at t = {instant:g} s: coming to rest", ERROR)
        elif told and not lost:
            self._report.end("resting", f"curvature samples are back at t = {instant:g} s")
        elif self.simulation.sampled and not self._driven:
            self._report.note("law adopted", f"curvature samples adopted at t = {instant:g} s")
        self._driven = self.simulation.sampled or self.simulation.resting
