# SPDX-License-Identifier: Apache-2.0
"""Monitors the model's limits during a run: each violation is logged once, and stays in /diagnostics until a reset.

A leading tail is reported until the first window of time in which the tail does not lead. Windows are whole periods of
the law, together at least `WINDOW` of simulated time. They begin `SETTLING` after the start, and after each new law.
"""

import math
from time import monotonic

import numpy as np
from eel_common.ros.loop.diagnostics import REPEAT, Report
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.analysis.model_limits import ModelLimits
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.simulation import Simulation

SETTLING = 5.0  # s after the start in which speed and tail are not checked: a swimmer starts from rest
WINDOW = 5.0  # s


class LimitsMonitor:
    """Checks snapshots of a `simulation` against the model's limits, and reports violations to `report`."""

    def __init__(self, simulation: Simulation, report: Report) -> None:
        self._simulation = simulation
        self._limits = ModelLimits(simulation.body, simulation.scene, simulation.x)
        self._current = np.array(simulation.scene.current)
        self._report = report
        self._reported: set[str] = set()  # kinds of violations
        self._excess, self._above = (0.0, ""), 0  # torque since its last report: greatest, text; samples above
        self._torque_reported = -math.inf  # s, steady clock
        self._law, self._window = simulation.law, (math.inf, math.inf)  # s: begin and end, for the tail
        self._wake_power: list[float] = []  # W, in the window
        self._since: tuple[float, np.ndarray] | None = None  # time [s] and centre of mass [m], for the speed
        self._warn("slenderness", self._limits.of_body())

    def end(self) -> None:
        """End the reported violations, and report the torque."""
        self.report_torque()
        for kind in self._reported:
            self._report.end(kind)
        self._reported = set()

    def add(self, snapshot: Snapshot, check: bool) -> None:
        """Add a snapshot; with `check`, compare all since the last check with the limits."""
        if snapshot.energy is not None:
            self._check_tail(snapshot.time, float(snapshot.energy.wake_power))
        if check:
            self._check(snapshot)

    def check_torque(self, snapshot: Snapshot, limit: float) -> None:
        """Report once a second of wall time the greatest internal torque above the `limit` [N m]; 0: no limit."""
        if limit > 0.0:
            if snapshot.torque is None:
                self._warn("torque", "torque_limit does nothing without scene.internal_wrench")
            else:
                self._compare_torque(snapshot, limit)
        if monotonic() - self._torque_reported >= REPEAT:
            self.report_torque()

    def report_torque(self) -> None:
        """Report the greatest torque above the limit since the last report."""
        if not self._above:
            return
        many = f" (the greatest of {self._above} samples above it)" if self._above > 1 else ""
        self._report.event("torque limit", self._excess[1] + many, differing=True)
        self._excess, self._above, self._torque_reported = (0.0, ""), 0, monotonic()

    def _compare_torque(self, snapshot: Snapshot, limit: float) -> None:
        size = np.abs(snapshot.torque)
        station, axis = np.unravel_index(np.argmax(size), size.shape)
        if size[station, axis] > limit:
            self._above += 1
        if size[station, axis] > max(limit, self._excess[0]):
            self._excess = (
                size[station, axis],
                f"torque_{axis + 1} of {size[station, axis]:.3g} N m exceeds torque_limit {limit:g} N m at "
                f"X = {snapshot.x[station]:.3g} m, t = {snapshot.time:.4g} s",
            )

    def _check_tail(self, time: float, wake_power: float) -> None:
        if self._simulation.flow is not None:  # in moving water the power of the wake does not have the sign of V1(l)
            return
        law, (begin, end) = self._simulation.law, self._window
        if law is not self._law or begin == math.inf:
            self._law, self._wake_power = law, []
            self._window = time + SETTLING, time + SETTLING + window_of(law)
        elif time >= begin:
            self._wake_power.append(wake_power)
            if time >= end and len(self._wake_power) > 1:
                text = self._limits.of_tail(self._wake_power, f" from t = {begin:.4g} s to {time:.4g} s")
                if text:
                    self._warn("tail", text)
                elif "tail" in self._reported:
                    self._reported.remove("tail")
                    self._report.end("tail", f"the tail no longer leads at t = {time:.4g} s")
                self._wake_power, self._window = [], (time, time + window_of(law))

    def _check(self, snapshot: Snapshot) -> None:
        limits, time = self._limits, np.array([snapshot.time])
        bend = snapshot.curvature[None]
        self._warn("bending", limits.of_bending(time, bend))
        self._warn(
            "contact", limits.of_contact(time, bend, snapshot.backbone[None], snapshot.section_orientation[None])
        )
        centre = snapshot.center_of_mass - snapshot.time * self._current
        if self._since is None or snapshot.time < self._since[0]:
            self._since = snapshot.time, centre.copy()
        elif snapshot.time - self._since[0] >= SETTLING:
            start, before = self._since
            if start > 0.0:
                self._warn("speed", limits.of_speed(float(np.linalg.norm(centre - before)) / (snapshot.time - start)))
            self._since = snapshot.time, centre.copy()

    def _warn(self, kind: str, text: str) -> None:
        if text and kind not in self._reported:
            self._reported.add(kind)
            self._report.begin(kind, text)


def window_of(law: Law | SampledLaw | None) -> float:
    """Length [s] of the windows in which the tail is checked, for a swimmer that follows `law`."""
    period = max((term.period for term in getattr(law, "terms", ())), default=0.0)
    return period * math.ceil(WINDOW / period) if period > 0.0 else WINDOW
