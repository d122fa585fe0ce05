# SPDX-License-Identifier: Apache-2.0
"""Actions that are commands for the joints of a robot: positions, velocities, or torques of its servos."""

from typing import Any

import numpy as np
from eel_common.quantity import checked_choice, checked_instance, positive
from eel_common.wording import shown
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.simulation.sampled_swimmers import Array

KINDS = {"position": ("rad", None), "velocity": ("rad/s", "speed_limit"), "torque": ("N m", "torque_limit")}
"""For each kind of command: its unit, and the servo's field with its limit."""
GREATEST_ANGLE = 0.6  # rad, default of a greatest position
ANGLE, RATE = 0.3, 2.0  # rad, rad/s: scales of what is observed of a joint


class JointAction:
    """Turns actions into commands, which hold during a control step. The policy sees angle and rate of each joint.

    An action holds one value for each joint with a servo, from -1 to 1 times its greatest command, in the joint's sign.
    The body's own bend is added to position commands, an equal share to each joint. Other commands ignore it.

    Args:
        robot: a `Robot`, or its name.
        kind: "position", "velocity" or "torque".
        greatest: [rad, rad/s or N m]; None: 0.6 rad, or the servo's own limit.
    """

    period = 1.0  # s: averaging time of a task, as there is no wave

    def __init__(self, robot: Robot | str, kind: str = "position", greatest: float | None = None):
        self.robot = Robot.named(robot) if isinstance(robot, str) else checked_instance("robot", robot, Robot)
        checked_choice("kind", kind, KINDS)
        driven = [
            (joint.name, servo) for joint, servo in zip(self.robot.joints, self.robot.servos, strict=True) if servo
        ]
        if not driven:
            raise ValueError(f"robot must have a joint with a servo, got {shown(self.robot)}")
        self.kind, self.names = kind, tuple(name for name, _ in driven)
        unit, limit = KINDS[kind]
        if greatest is None and limit is not None:
            values = [getattr(servo, limit) for _, servo in driven]
            if None in values:
                raise ValueError(f"greatest must be given where a servo has no {limit}, got None")
            self.greatest: Array = np.array(values, dtype=float)
        else:
            value = GREATEST_ANGLE if greatest is None else positive("greatest", greatest, unit)
            self.greatest = np.full(len(driven), value)
        self._joints: Array = np.zeros((2, len(self.robot.joints)))

    @property
    def size(self) -> int:
        """The number of values in an action."""
        return len(self.names)

    def described(self) -> list[str]:
        """One line for each value of an action: name, unit, bounds."""
        unit, _ = KINDS[self.kind]
        pairs = zip(self.names, self.greatest.tolist(), strict=True)
        return [f"{self.kind} of {name} [{unit}], {-greatest:g} to {greatest:g}" for name, greatest in pairs]

    def begin(self, own_time: Any = 0.0) -> Array:
        """The first commands (size,), or (N, size) if `own_time` is (N,): all 0."""
        self._joints = np.zeros((2, len(self.robot.joints), *np.shape(own_time)))
        commands: Array = np.zeros((*np.shape(own_time), self.size))
        return commands

    def begin_some(self, swimmers: list[int], own_times: Array) -> Array:
        """The first commands (K, size) of K of N swimmers."""
        self._joints[..., swimmers] = 0.0
        commands: Array = np.zeros((len(swimmers), self.size))
        return commands

    def advance(self, action: Array, step: float) -> Array:
        """The commands (size,), or (N, size), for this `action`."""
        commands: Array = action * self.greatest
        return commands

    def see(self, joints: Array) -> None:
        """Take angles and rates (2, J), or (2, J, N), of the joints."""
        self._joints = joints

    @property
    def names_of_state(self) -> list[tuple[str, str, float]]:
        """Name, unit and scale of each value of `state`."""
        names = [joint.name for joint in self.robot.joints]
        return [(f"angle of {name}", "rad", ANGLE) for name in names] + [
            (f"rate of {name}", "rad/s", RATE) for name in names
        ]

    @property
    def state(self) -> list[Any]:
        """Angles, then rates of all joints; (N,) each for N swimmers."""
        return [*self._joints[0], *self._joints[1]]
