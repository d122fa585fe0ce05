# SPDX-License-Identifier: Apache-2.0
"""The signs of joints in messages: those of REP-103, as in a URDF whose base link is the head.

In joint_commands, joint_states and motor_states a positive angle turns the part behind the joint about +z (yaw) or +y
(pitch) of the part ahead; for the axes -yaw, -pitch, -z, -y about -z or -y (`sense_of`). In the library the joint's
`axis` gives the sign: "yaw" is positive to the left, which turns the part behind about -z. Rates and torques have the
sign of the angle.
"""

import numpy as np

from eel_dynamics.model.axes import VECTOR
from eel_dynamics.model.robot.joint import Joint
from eel_dynamics.model.robot.part import AXES
from eel_dynamics.model.robot.robot import Robot

TO_THE_LEFT = "yaw", "-yaw"  # axes with the sign of gaits: the others have the sign of messages
OF_SECTIONS = VECTOR  # (3,) sign in messages of a turn of the part behind, about each section axis


def message_sign(axis: str) -> int:
    """The factor of a joint's angle from library to message and back, for this `axis`: 1 or -1."""
    return -1 if axis in TO_THE_LEFT else 1


def message_signs(robot: Robot | None) -> np.ndarray:
    """(J,) `message_sign` of each joint of a `robot`."""
    return np.array([message_sign(joint.axis) for joint in (() if robot is None else robot.joints)], dtype=float)


def message_limits(joint: Joint) -> tuple[float, float] | None:
    """The limits [rad] of a `joint` in the sign of messages; None without limits."""
    if joint.limits is None or message_sign(joint.axis) > 0:
        return joint.limits
    low, high = joint.limits
    return -high, -low


def sense_of(axis: str) -> int:
    """The sense of a joint's angle in messages, about +y or +z: 1 right-handed, -1 left-handed (JointGeometry)."""
    component, sign = AXES[axis]
    return int(message_sign(axis) * sign * OF_SECTIONS[component])
