# SPDX-License-Identifier: Apache-2.0
"""Reads the commands of a robot's joints and of fins from messages (sensor_msgs/JointState).

A joint is driven by position, velocity or effort, whichever the parameter `command_interfaces` says; the other fields
of the message are empty, or NaN for the joint.
"""

import math
from collections.abc import Mapping
from typing import Any

from eel_base.quantity import is_finite
from eel_base.wording import not_one_of, shown
from eel_model.robot.robot import Robot
from sensor_msgs.msg import JointState

from eel_dynamics.ros.messages import stamped

INTERFACES = ("position", "velocity", "effort")
MOST_JOINTS = 1000  # of one message
Values = dict[str, Any]  # of a fin the angle [rad]; of a joint its interface, and the value [rad, rad/s or N m]


def interfaces_of(robot: Robot | None, given: tuple[str, ...]) -> dict[str, str]:
    """The interface of each joint. `ValueError` for the parameter `given`, which is one for all, or one for each."""
    if robot is None:
        return {}
    names = [joint.name for joint in robot.joints]
    for each in given:
        if each not in INTERFACES:
            raise ValueError(not_one_of("command_interfaces", each, INTERFACES))
    if len(given) not in (1, len(names)):
        raise ValueError(f"command_interfaces must be one, or one for each of {len(names)} joints, got {len(given)}")
    return dict(zip(names, given if len(given) > 1 else given * len(names), strict=True))


def joint_command_from_message(message: JointState, interfaces: Mapping[str, str], now: float) -> tuple[float, Values]:
    """The stamp [s] of a `message` that comes at simulation time `now` [s], and what joints are to do from then on.

    `ValueError` names what does not fit.
    """
    names = list(message.name)
    if not 1 <= len(names) <= MOST_JOINTS:
        raise ValueError(f"name must hold 1 to {MOST_JOINTS} joints, got {len(names)}")
    for field in INTERFACES:
        if len(getattr(message, field)) not in (0, len(names)):
            rule = f"{field} must be empty or have as many values as name, {len(names)}"
            raise ValueError(f"{rule}, got {len(getattr(message, field))}")
    joints: Values = {}
    for index, name in enumerate(names):
        if name not in interfaces:
            raise ValueError(not_one_of("joint", name, interfaces))
        if name in joints:
            raise ValueError(f"name must hold each joint once, got {shown(name)} twice")
        values = {field: getattr(message, field)[index] for field in INTERFACES if len(getattr(message, field))}
        own = interfaces[name]
        if not is_finite(values.get(own)):
            raise ValueError(f"{own} of joint {shown(name)} must be finite, got {values.get(own, 'none')}")
        others = [field for field, value in values.items() if field != own and not math.isnan(value)]
        if others:
            raise ValueError(f"joint {shown(name)} is driven by {own}, got {others[0]} too")
        joints[name] = own, float(values[own])
    return stamped(message.header.stamp, now), joints


def fin_command_from_message(message: JointState, now: float) -> tuple[float, dict[str, float]]:
    """The stamp [s] of a `message` that comes at simulation time `now` [s], and angles [rad] by the names of fins.

    `ValueError` for an invalid stamp, or for another number of positions than names.
    """
    if len(message.name) != len(message.position) or not message.name:
        raise ValueError(
            f"it must have a position for each name, one or more, got {len(message.name)} names and "
            f"{len(message.position)} positions"
        )
    return stamped(message.header.stamp, now), dict(zip(message.name, message.position, strict=True))
