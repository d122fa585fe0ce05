# SPDX-License-Identifier: Apache-2.0
"""Finds which servos are at their torque limit, and for how long: for /diagnostics and the log.

A short saturation, as after a step of a set point, is not reported. A saturation that a gait repeats is reported once.
"""

from typing import Any

import numpy as np
from eel_common.ros.loop.diagnostics import Report

from eel_dynamics.model.robot.actuators import at_limit
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.simulation import Simulation

TOLD_AFTER, OVER_AFTER = 0.25, 1.5  # s without interruption: at the limit, and below it


class SaturationMonitor:
    """Watches the servos of the robot of a `simulation`. A servo counts as at its limit from one sample to the next."""

    def __init__(self, simulation: Simulation, report: Report) -> None:
        robot = simulation.robot
        assert robot is not None
        self._simulation, self._names = simulation, [joint.name for joint in robot.joints]
        self._report, count = report, len(self._names)
        self._total, self._lasting = np.zeros(count), np.zeros(count)  # s
        self._before, self._time = np.zeros(count, dtype=bool), 0.0
        self._below = 0.0  # s, for how long no servo has been at its limit

    def add(self, snapshot: Snapshot) -> None:
        """Check the motors at an instant."""
        joints, step, robot = snapshot.joints, snapshot.time - self._time, self._simulation.robot
        assert robot is not None
        here = at_limit(robot.servos, joints["motor_torque"], joints["motor_power"])
        self._total += step * self._before
        self._lasting = np.where(here, self._lasting + step * self._before, 0.0)
        self._before, self._time = here, snapshot.time
        self._below = 0.0 if here.any() else self._below + step
        long = np.flatnonzero(self._lasting >= TOLD_AFTER)
        if len(long):
            listed = ", ".join(f"{self._names[k]} for {self._lasting[k]:.3g} s" for k in long)
            self._report.begin("saturated", f"at the torque limit at t = {snapshot.time:.4g} s: {listed}")
        elif self._below >= OVER_AFTER:
            self._report.end("saturated", f"all motors are below their torque limits at t = {snapshot.time:.4g} s")

    def end(self) -> None:
        """End the report, because the run restarts."""
        self._report.end("saturated")

    def values(self) -> dict[str, Any]:
        """For /diagnostics: time at the limit since the start, of each motor that was there."""
        found = [f"{self._names[k]} {self._total[k]:.4g} s" for k in np.flatnonzero(self._total > 0.0)]
        return {"at_torque_limit": ", ".join(found)} if found else {}
