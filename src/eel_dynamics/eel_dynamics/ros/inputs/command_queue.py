# SPDX-License-Identifier: Apache-2.0
"""Passes commands of joints and fins, currents and external wrenches to the simulation at their times.

A command acts from its stamp on, or at once if the stamp is empty or past, until the next one. If several begin at one
instant, only the newest for each joint or fin is kept, to save memory and time. A command older than one that has acted
is dropped.
"""

import math
from bisect import bisect_left
from collections import deque
from collections.abc import Mapping
from itertools import pairwise
from operator import itemgetter
from typing import Any

from eel_common.ros.loop.diagnostics import ERROR, Report
from eel_common.wording import shown
from eel_gaits.laws.law import Law

from eel_dynamics.model.fins.fins import checked_commands, commanded_names
from eel_dynamics.model.robot.joint_signs import message_limits, message_sign
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.ros.inputs.awaited import FINS, JOINTS, MESSAGES, Awaited
from eel_dynamics.ros.inputs.command_messages import Values, fin_command_from_message, joint_command_from_message
from eel_dynamics.simulation.simulation import Simulation

IN_A_ROW = 4  # commands that make a stream
LONGEST_WAY = 5.0  # s: most that a command may lie ahead of the simulation
MOST_WAITING = 10_000  # instants ahead: 2 kHz for LONGEST_WAY
STAND_IN = Law(name="joint_commands")  # law of a swimmer that only joint commands bend
INSTANT = itemgetter(0)
UNITS = {"position": "rad", "velocity": "rad/s", "effort": "N m"}


class CommandQueue:
    """Commands for parts of a swimmer, such as its joints. For the run loop's thread.

    lockstep: whether the run waits for inputs.

    Attributes:
        topic: of the commands. parts: what they command, in words. hold: whether a repeated value changes nothing.
        simulation: Simulation, which a reset may replace.
        names: of the parts that can be commanded.
    """

    topic = parts = ""
    hold = True

    def __init__(self, awaited: Awaited, lockstep: bool, report: Report) -> None:
        self._awaited, self._lockstep, self._report = awaited, lockstep, report
        self.simulation: Simulation
        self.names: tuple[str, ...] = ()
        self._waiting: list[tuple[float, dict[str, tuple[float, Any]]]] = []  # instant [s]; stamp [s] and value by name
        self._present: Values = {}  # in force
        self._stamps: dict[str, float] = {}  # s, of commands that have acted
        self._arrivals: deque[float] = deque(maxlen=IN_A_ROW)  # s, simulation time: arrival of the last commands

    def read(self, message: Any) -> tuple[float, Values]:
        """Stamp [s] and values of a `message`. `ValueError` if they do not fit the present swimmer."""
        raise NotImplementedError

    def give(self, values: Values) -> None:
        """Let the simulation take these `values` from now on. `ValueError` names an invalid one."""
        raise NotImplementedError

    def add(self, stamp: float, values: Values) -> None:
        """Queue commands of parts from `stamp` [s] on. `ValueError` for a command that lies too far ahead."""
        now = self.simulation.time
        ahead = stamp - now
        if self._awaited.is_echo(self.topic, ahead):
            self._report.note("echo", f"{MESSAGES[self.topic]} of {stamp:g} s left out: sent before the reset")
            return
        if ahead > LONGEST_WAY:
            rule = f"header.stamp must be at most {LONGEST_WAY:g} s ahead of the simulation ({now:.9g} s)"
            raise ValueError(f"{rule}, got {stamp:.9g} s")
        is_stamped = stamp > 0.0 or now == 0.0
        if not is_stamped and self._lockstep and self._awaited.counts_as_stamped(self.topic, values):
            return  # a late answer to sample 0, which is repeated while the run stands at its start
        given = {name: value for name, value in values.items() if value != {}}
        self._queue(stamp if is_stamped else now, max(stamp, now), given, is_stamped)
        self._arrivals.append(now)
        if is_stamped:
            self._awaited.come(self.topic, stamp, now, values if self._lockstep else ())

    def _queue(self, stamp: float, instant: float, values: Values, is_stamped: bool) -> None:
        """Let the `values` act at an `instant` [s], except on parts where a newer `stamp` [s] has acted."""
        newer = {name: (stamp, value) for name, value in values.items() if stamp >= self._stamps.get(name, -math.inf)}
        for old in values.keys() - newer:
            than = f"t = {stamp:.9g} s is older than that of t = {self._stamps[old]:.9g} s"
            self._warn("old", f"of {than}{_for(old)}: left out, as are further ones")
        place = bisect_left(self._waiting, instant, key=INSTANT)
        if not newer:
            return
        if place == len(self._waiting) or self._waiting[place][0] > instant:
            if len(self._waiting) == MOST_WAITING:
                now = self.simulation.time
                raise ValueError(f"at most {MOST_WAITING} of different stamps can wait ahead of t = {now:.9g} s")
            self._waiting.insert(place, (instant, {}))
        there = self._waiting[place][1]
        for name, (_, value) in newer.items():
            before = there.get(name, (self._stamps.get(name, math.nan), self._present.get(name)))
            if is_stamped and before[0] == stamp > 0.0 and before[1] != value:
                self._warn("double", f"of t = {stamp:.9g} s{_for(name)} came with another value: the newest is taken")
            if name not in there or stamp >= before[0]:
                there[name] = stamp, value

    def _warn(self, kind: str, text: str) -> None:
        """Warn of a `kind` of commands once in a run."""
        self._report.begin(f"{kind} {self.topic}", f"a {MESSAGES[self.topic]} {text}")

    def next_instant(self, before: float) -> float:
        """The time [s] of the next command, or `before` [s] if no command comes earlier."""
        return min(before, max(self._waiting[0][0], self.simulation.time)) if self._waiting else before

    def act(self) -> bool:
        """Let the commands of the present time act. Returns whether there are any. An invalid one is logged."""
        if self.next_instant(math.inf) > self.simulation.time:
            return False
        values: Values = {}
        while self._waiting and self._waiting[0][0] <= self.simulation.time:
            for name, (stamp, value) in self._waiting.pop(0)[1].items():
                self._stamps[name], values[name] = stamp, value
        held = self._present if self.hold else {}
        changed = {name: value for name, value in values.items() if held.get(name) != value}
        try:
            if changed:
                self.give(changed)
            self._present |= changed
        except ValueError as error:
            self._report.event(self.topic, f"{MESSAGES[self.topic]} refused: {error}", ERROR, differing=True)
        return True

    def check(self, timeout: float) -> None:
        """Warn if a stream of commands has stopped for `timeout` [s] of simulation time; 0: never.

        Commands with longer pauses are set points. They hold without a warning.
        """
        time, arrivals, topic = self.simulation.time, self._arrivals, self.topic
        if not timeout > 0.0 or len(arrivals) < IN_A_ROW or time - arrivals[-1] <= timeout:
            return
        if max(after - before for before, after in pairwise(arrivals)) <= timeout:
            said = f"no {MESSAGES[topic]} for {timeout:g} s of simulation time at t = {time:g} s: the last one holds"
            self._report.begin(f"no {topic}", said)

    def _begin(self, simulation: Simulation, names: tuple[str, ...]) -> None:
        """Begin at time 0 of a `simulation`, without commands for its parts with these names."""
        self.simulation, self.names = simulation, names
        self._waiting, self._present, self._stamps = [], {}, {}
        self._arrivals.clear()
        for kind in ("old", "double"):
            self._report.end(f"{kind} {self.topic}")

    def values(self) -> dict[str, Any]:
        """For /diagnostics: how many joints or fins are commanded."""
        return {f"commanded_{self.parts}": len(self._present)} if self._present else {}


class JointCommands(CommandQueue):
    """Commands for the servos of a robot. The first one starts a swimmer without a law.

    Values have the signs of messages, and `give` converts them.
    """

    topic, parts = JOINTS, "joints"

    def __init__(self, awaited: Awaited, lockstep: bool, report: Report) -> None:
        super().__init__(awaited, lockstep, report)
        self._interfaces: Mapping[str, tuple[str, ...]] = {}
        self._limited: Robot | None = None  # the robot that has the `_limits`
        self._limits: dict[tuple[str, str], tuple[float, float]] = {}  # by joint and interface
        self._beyond: set[str] = set()  # kinds of warnings that were given
        self._signs: dict[str, int] = {}  # `message_sign` by joint

    def begin(self, simulation: Simulation, interfaces: Mapping[str, tuple[str, ...]]) -> None:
        """Begin at time 0 of a `simulation`, whose joints are driven by these `interfaces`."""
        self._interfaces, robot = interfaces, simulation.robot
        self._signs = {joint.name: message_sign(joint.axis) for joint in (() if robot is None else robot.joints)}
        self._begin(simulation, () if robot is None else robot.driven_names)
        for kind in ("no values", *self._beyond):
            self._report.end(kind)
        self._beyond.clear()

    def read(self, message: Any) -> tuple[float, Values]:
        """As in `CommandQueue`. Values beyond limits are clipped and joints without a value dropped, with a warning."""
        if not self.names:
            raise ValueError("there are no servos: the shape is imposed, by curvature_law or curvature_samples")
        stamp, values = joint_command_from_message(message, self._interfaces, self.simulation.time)
        if any(values.values()):
            self._report.end("no values")
        else:
            self._report.begin("no values", "joint commands without a number: what is NaN leaves a joint as it is")
        for name in values.keys() - set(self.names):
            if values.pop(name):
                self.simulation.check_driven(name)
        robot = self.simulation.robot
        if robot is not None and robot is not self._limited:  # a new torque limit makes a new robot
            self._limited, self._limits = robot, limits_of(robot)
        for name, given in values.items():
            for interface, value in given.items():
                low, high = self._limits[name, interface]
                if not low <= value <= high:
                    given[interface] = low if value < low else high
                    self._warn_of_limit(name, interface, value, given[interface])
                elif self._beyond:
                    self._report.end(limit_of(name, interface))
        return stamp, values

    def _warn_of_limit(self, name: str, interface: str, value: float, limit: float) -> None:
        """Warn once in a run, since a wave may exceed a limit in each period. A value within the limit ends the
        warning."""
        kind, unit = limit_of(name, interface), UNITS[interface]
        if kind not in self._beyond:
            said = f"{interface} {value:g} {unit} of joint {shown(name)} is beyond its limit {limit:g} {unit}: clipped"
            self._report.begin(kind, said)
            self._beyond.add(kind)

    def add(self, stamp: float, values: Values) -> None:
        super().add(stamp, values)
        if not self.simulation.ready:
            self.simulation.adopt(STAND_IN)

    def give(self, values: Values) -> None:
        for name, given in values.items():
            sign = self._signs[name]
            self.simulation.command(name, **{interface: sign * value for interface, value in given.items()})


class FinCommands(CommandQueue):
    """Commands for the servos of fins."""

    topic, parts = FINS, "fins"

    def begin(self, simulation: Simulation) -> None:
        """Begin at time 0 of a `simulation`."""
        self._begin(simulation, commanded_names(simulation.fins))

    def read(self, message: Any) -> tuple[float, Values]:
        if not self.names:
            raise ValueError("no fin is commanded: angle=commanded in the parameter fins makes one")
        stamp, angles = fin_command_from_message(message, self.simulation.time)
        return stamp, checked_commands(self.simulation.fins, angles)

    def give(self, values: Values) -> None:
        self.simulation.command_fins(values)


def limits_of(robot: Robot) -> dict[tuple[str, str], tuple[float, float]]:
    """Least and greatest value by joint and interface, for the joints of a `robot` with a servo; signs of messages."""
    limits = {}
    for joint, servo in zip(robot.joints, robot.servos, strict=True):
        if servo is not None:
            speed, torque = servo.speed_limit or math.inf, servo.torque_limit or math.inf
            limits[joint.name, "position"] = message_limits(joint) or (-math.inf, math.inf)
            limits[joint.name, "velocity"], limits[joint.name, "effort"] = (-speed, speed), (-torque, torque)
    return limits


def limit_of(name: str, interface: str) -> str:
    return f"limit of {name} {interface}"


def _for(name: str) -> str:
    return f" for {name}" if name else ""
