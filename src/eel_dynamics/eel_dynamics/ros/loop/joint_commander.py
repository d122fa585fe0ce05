# SPDX-License-Identifier: Apache-2.0
"""Passes commands of a robot's joints to the simulation at their times; warns when they stop.

A command is in force from its stamp on, or at once where it has none or a past one; the last one holds. As fast as
possible (real_time_factor 0), a controller that answers samples is waited for: the next sample is computed once a
command has come that is stamped with the last one, or later. So such a run is the same each time.
"""

import math
import time
from operator import itemgetter
from typing import Any

from eel_gaits.laws.law import Law
from eel_ros.loop.diagnostics import ERROR, Report

from eel_dynamics.simulation.simulation import Simulation

LONGEST_WAY = 5.0  # s that a command may lie ahead of the simulation
ECHO = 2.0  # s after a reset, within which commands that were sent before it may come
Joints = dict[str, tuple[str, float]]  # by name, the interface and the value [rad, rad/s or N m]


class JointCommander:
    """Commands for the `simulation`, which may be replaced at a reset. For the run loop's thread."""

    def __init__(self, simulation: Simulation, report: Report) -> None:
        self.simulation, self._report = simulation, report
        self._waiting: list[tuple[float, Joints]] = []  # in the order of their times [s]
        self._present: Joints = {}  # what the joints do
        self._newest = math.nan  # s: the latest stamp; NaN: no command has come
        self._last = math.nan  # s, simulation time at which the last command came
        self._farthest = 0.0  # s by which a command lay ahead
        self._missing_since = math.inf  # s, steady clock; -inf: no longer waited for
        self._echo_until = -math.inf  # s, steady clock

    def add(self, stamp: float, joints: Joints) -> None:
        """Queue what `joints` are to do from `stamp` [s] on.

        The first command starts a swimmer without a law: it is straight but for its commands.
        """
        now = self.simulation.time
        ahead = stamp - now
        if ahead > 2.0 * self._farthest and time.monotonic() < self._echo_until:
            self._report.note("echo", f"joint command of {stamp:g} s left out: sent before the reset")
            return
        if ahead > LONGEST_WAY:
            rule = f"header.stamp must be at most {LONGEST_WAY:g} s ahead of the simulation ({now:.9g} s)"
            self._report.event("commands", f"joint command refused: {rule}, got {stamp:.9g} s", ERROR, True)
            return
        self._farthest, self._last = max(self._farthest, ahead), now
        if not stamp <= self._newest:
            self._newest, self._missing_since = stamp, math.inf
        self._report.end("no commands", f"joint commands are back at t = {now:g} s")
        self._waiting.append((stamp, joints))
        self._waiting.sort(key=itemgetter(0))  # a stable sort: those of one time in their order
        if not self.simulation.ready:
            self.simulation.adopt(Law(name="joint_commands"))

    def next_instant(self, before: float) -> float | None:
        """The time [s] of the next command, if it lies before a time [s]."""
        if not self._waiting or self._waiting[0][0] >= before:
            return None
        return max(self._waiting[0][0], self.simulation.time)

    def execute(self) -> None:
        """Give the next command at the present time."""
        for joint, (interface, value) in self._waiting.pop(0)[1].items():
            if self._present.get(joint) == (interface, value):
                continue  # sent again
            self.simulation.command(joint, **{interface: value})
            self._present[joint] = interface, value

    def waits(self, now: float, timeout: float) -> bool:
        """Whether to wait for a command of the present instant, for `timeout` [s] at most. now: [s, steady clock]."""
        if math.isnan(self._newest) or self._newest >= self.simulation.time:
            self._missing_since = math.inf
            return False
        self._missing_since = min(self._missing_since, now)
        if now - self._missing_since < timeout:
            return True
        self._missing_since = -math.inf
        self._warn(timeout, "of wall time")
        return False

    def check(self, timeout: float) -> None:
        """Warn where no command has come for `timeout` [s] of simulation time; 0: never."""
        if timeout > 0.0 and self.simulation.time - self._last > timeout:
            self._warn(timeout, "of simulation time")

    def _warn(self, timeout: float, kind: str) -> None:
        at = f"at t = {self.simulation.time:g} s"
        self._report.begin("no commands", f"no joint command for {timeout:g} s {kind} {at}: the last one holds")

    def reset(self) -> None:
        """Begin again at time 0, without commands."""
        self._waiting, self._present = [], {}
        self._newest = self._last = math.nan
        self._missing_since = math.inf
        if self._farthest > 0.0:
            self._echo_until = time.monotonic() + ECHO
        self._report.end("no commands")

    def values(self) -> dict[str, Any]:
        """For /diagnostics: how many joints are commanded."""
        return {"commanded_joints": len(self._present)} if self._present else {}
