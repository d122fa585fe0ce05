# SPDX-License-Identifier: Apache-2.0
"""Passes laws, and a controller's samples of laws, to the simulation; logs refusals, and when samples run out."""

from typing import Any

import numpy as np
from eel_common.ros.loop.diagnostics import ERROR, WARN, Report
from eel_common.wording import shown
from eel_gaits.laws.law import Law

from eel_dynamics.curvature.curvature_samples import LateSample
from eel_dynamics.ros.inputs.awaited import LAW, SAMPLES, Awaited
from eel_dynamics.ros.inputs.law_messages import refused
from eel_dynamics.simulation.bending.slow_motors import slow_motors
from eel_dynamics.simulation.simulation import Simulation

LONGEST_WAY = 5.0  # s: greatest distance of a sample from the last one, or from the simulation
LOOKED_AT = 20.0  # s of a law that are checked against the speed of motors
REFUSALS = ValueError, ArithmeticError, MemoryError  # errors with which the simulation refuses laws and samples


class LawAdopter:
    """Passes laws and samples to the `simulation`. For the run loop's thread.

    `SimulationStopped` if the simulation cannot continue with a law.

    Attributes:
        simulation: Simulation, which a reset may replace.
    """

    def __init__(self, simulation: Simulation, awaited: Awaited, report: Report) -> None:
        self.simulation, self._awaited, self._report = simulation, awaited, report
        self._origin = 0.0  # s: simulation time of the law's t = 0
        self._first: dict[float, int] = {}  # samples added at the start: hash of the values by time [s]
        self._driven = False  # whether a controller's samples drove the swimmer when it was last looked at

    @property
    def name(self) -> str:
        """Name of the law that the swimmer follows, or the topic curvature_samples."""
        simulation = self.simulation
        if simulation.sampled or simulation.resting:
            return "curvature_samples"
        return simulation.law.name if simulation.law is not None else ""

    def try_law(self, law: Law, origin: float) -> None:
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
        self._awaited.come(LAW, origin, simulation.time)
        self._awaited.end(SAMPLES)
        self._report.end("resting")
        self._report.note("law adopted", f"law {shown(law.name)} adopted at t = {simulation.time:g} s")
        if slow := slow_motors(simulation.swimmer.modes, law, LOOKED_AT):
            self._report.event("slow motors", slow.text, differing=True)
        if until is not None and until > simulation.time:
            self._report.event(
                "samples dropped",
                f"curvature samples up to t = {until:g} s are dropped: law {shown(law.name)} is newer",
            )

    def add_samples(self, samples: dict[str, Any], period: float = 0.0) -> None:
        """Add one sample of a controller: the arguments of `Simulation.add_samples`. period: [s], between samples of
        the run.

        A sample equal to one from before the start is an answer to a repeated sample 0, and changes nothing. Shortly
        after a reset, a sample that lies farther ahead than any before was sent before the reset, and is dropped. A
        sample far from all others is refused: the body would swing there slowly and widely.
        """
        ahead = samples["time"] - self.simulation.time
        if self._awaited.is_echo(SAMPLES, ahead):
            self._report.note("echo", f"curvature samples of {samples['time']:g} s left out: sent before the reset")
            return
        if samples["time"] in self._first and self._first[samples["time"]] == _hash(samples):
            return
        last, longest = max(self.simulation.time, self.simulation.samples_until or 0.0), max(LONGEST_WAY, 2.0 * period)
        try:
            if samples["time"] > last + longest:
                way = f"{longest:g} s after the last sample or the simulation ({last:.9g} s)"
                raise ValueError(f"time must be at most {way}, got {samples['time']:.9g} s")
            self.simulation.add_samples(**samples)
        except REFUSALS as error:
            level = WARN if isinstance(error, LateSample) else ERROR
            driven = self.simulation.sampled or self.simulation.resting
            self._report.event("samples", refused(error, driven), level)
        else:
            self._awaited.come(SAMPLES, samples["time"], self.simulation.time)
            if self.simulation.time == 0.0:
                self._first[samples["time"]] = _hash(samples)

    def reset(self) -> None:
        """Set the law's own t = 0 back to simulation time 0."""
        self._origin, self._driven = 0.0, False
        self._first.clear()
        self._report.end("resting")

    def report_samples(self, instant: float) -> None:
        """Log when samples are adopted, have run out, or are back, at simulation time `instant` [s]."""
        lost, reported = self.simulation.resting, self._report.lasts("resting")
        if lost and not reported:
            self._report.begin("resting", f"curvature samples have run out at t = {instant:g} s: coming to rest", ERROR)
        elif reported and not lost:
            self._report.end("resting", f"curvature samples are back at t = {instant:g} s")
        elif self.simulation.sampled and not self._driven:
            self._report.note("law adopted", f"curvature samples adopted at t = {instant:g} s")
        self._driven = self.simulation.sampled or self.simulation.resting


def _hash(samples: dict[str, Any]) -> int:
    """A hash of the values of a sample."""
    return hash(tuple(np.asarray(row).tobytes() for name, row in samples.items() if name != "time"))
