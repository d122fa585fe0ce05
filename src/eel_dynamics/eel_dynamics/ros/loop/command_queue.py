# SPDX-License-Identifier: Apache-2.0
"""Passes commands of a robot's joints, and of fins, to the simulation at their times.

A command is in force from its stamp on, or at once where it has none or a past one; the last one holds. Of those that
begin at one instant the last of each joint or fin is kept: what cannot act any more takes no room, and no time.
"""

import math
from bisect import bisect_left
from collections.abc import Mapping
from operator import itemgetter
from typing import Any

from eel_gaits.laws.law import Law
from eel_model.fins.fins import checked_commands, commanded_names
from eel_ros.loop.diagnostics import ERROR, Report

from eel_dynamics.ros.command_messages import Values, fin_command_from_message, joint_command_from_message
from eel_dynamics.ros.loop.awaited import Awaited, Echo
from eel_dynamics.simulation.simulation import Simulation

LONGEST_WAY = 5.0  # s that a command may lie ahead of the simulation
MOST_WAITING = 10_000  # instants ahead: 2 kHz for so long
STAND_IN = Law(name="joint_commands")  # of a swimmer that is straight but for its commands
INSTANT = itemgetter(0)


class CommandQueue:
    """Commands for parts of the `simulation`, which may be replaced at a reset. For the run loop's thread.

    Attributes:
        topic: where they come from; what: one of them is called; parts: that are commanded.
        simulation: Simulation.
        names: of the parts that can be commanded.
        awaited: Awaited.
    """

    topic = what = parts = ""

    def __init__(self, report: Report) -> None:
        self._report, self.awaited, self._echo = report, Awaited(self.topic, self.what, report), Echo()
        self.simulation: Simulation
        self.names: tuple[str, ...] = ()
        self._waiting: list[tuple[float, Values]] = []  # in the order of their times [s]
        self._present: Values = {}  # what the parts do
        self._last = math.nan  # s, simulation time at which the last command came; NaN: none has

    def read(self, message: Any) -> tuple[float, Values]:
        """Stamp [s] and values of a `message`. `ValueError` names what does not fit the present swimmer."""
        raise NotImplementedError

    def give(self, values: Values) -> None:
        """Have parts do so from now on. `ValueError` names what does not fit."""
        raise NotImplementedError

    def add(self, stamp: float, values: Values) -> None:
        """Queue what parts are to do from `stamp` [s] on. `ValueError` for a command that lies too far ahead."""
        now = self.simulation.time
        ahead = stamp - now
        if self._echo.holds(ahead):
            self._report.note("echo", f"{self.what} of {stamp:g} s left out: sent before the reset")
            return
        if ahead > LONGEST_WAY:
            rule = f"header.stamp must be at most {LONGEST_WAY:g} s ahead of the simulation ({now:.9g} s)"
            raise ValueError(f"{rule}, got {stamp:.9g} s")
        instant = max(stamp, now)
        place = bisect_left(self._waiting, instant, key=INSTANT)
        if place < len(self._waiting) and self._waiting[place][0] == instant:
            self._waiting[place][1].update(values)
        elif len(self._waiting) < MOST_WAITING:
            self._waiting.insert(place, (instant, dict(values)))
        else:
            raise ValueError(f"at most {MOST_WAITING} of different stamps can wait ahead of t = {now:.9g} s")
        self._last = now
        self._echo.take(ahead)
        self.awaited.come(tuple(values), stamp, now)

    def next_instant(self, before: float) -> float:
        """The time [s] of the next command, or the time `before` [s] that none precedes."""
        return min(before, max(self._waiting[0][0], self.simulation.time)) if self._waiting else before

    def act(self) -> bool:
        """Give the commands of the present time; whether there are any. What no longer fits is told, and left out."""
        if self.next_instant(math.inf) > self.simulation.time:
            return False
        values: Values = {}
        while self._waiting and self._waiting[0][0] <= self.simulation.time:
            values |= self._waiting.pop(0)[1]
        changed = {name: value for name, value in values.items() if self._present.get(name) != value}
        try:
            if changed:  # not sent again
                self.give(changed)
            self._present |= changed
        except ValueError as error:
            self._report.event(self.topic, f"{self.what} refused: {error}", ERROR, differing=True)
        return True

    def check(self, timeout: float) -> None:
        """Warn where no command has come for `timeout` [s] of simulation time; 0: never."""
        time = self.simulation.time
        if timeout > 0.0 and time - self._last > timeout:
            self.awaited.miss(timeout, "of simulation time", time)

    def _begin(self, simulation: Simulation, names: tuple[str, ...]) -> None:
        """Begin at time 0 of a `simulation`, without commands for its parts with these names."""
        self.simulation, self.names = simulation, names
        self._waiting, self._present, self._last = [], {}, math.nan
        self.awaited.reset(names)
        self._echo.reset()

    def values(self) -> dict[str, Any]:
        """For /diagnostics: how many joints or fins are commanded."""
        return {f"commanded_{self.parts}": len(self._present)} if self._present else {}


class JointCommands(CommandQueue):
    """Commands for the servos of a robot. The first starts a swimmer without a law, which is straight but for it."""

    topic, what, parts = "joint_commands", "joint command", "joints"

    def begin(self, simulation: Simulation, interfaces: Mapping[str, str]) -> None:
        """Begin at time 0 of a `simulation`, whose joints are driven by these `interfaces`."""
        self._interfaces, robot = interfaces, simulation.robot
        self._begin(simulation, () if robot is None else robot.driven_names)

    def read(self, message: Any) -> tuple[float, Values]:
        stamp, values = joint_command_from_message(message, self._interfaces, self.simulation.time)
        for name in values.keys() - self.names:
            self.simulation.check_driven(name)
        return stamp, values

    def add(self, stamp: float, values: Values) -> None:
        super().add(stamp, values)
        if not self.simulation.ready:
            self.simulation.adopt(STAND_IN)

    def give(self, values: Values) -> None:
        for joint, (interface, value) in values.items():
            self.simulation.command(joint, **{interface: value})


class FinCommands(CommandQueue):
    """Commands for the servos of fins."""

    topic, what, parts = "fin_command", "fin_command", "fins"

    def begin(self, simulation: Simulation) -> None:
        """Begin at time 0 of a `simulation`."""
        self._begin(simulation, commanded_names(simulation.fins))

    def read(self, message: Any) -> tuple[float, Values]:
        stamp, angles = fin_command_from_message(message, self.simulation.time)
        return stamp, checked_commands(self.simulation.fins, angles)

    def give(self, values: Values) -> None:
        self.simulation.command_fins(values)
