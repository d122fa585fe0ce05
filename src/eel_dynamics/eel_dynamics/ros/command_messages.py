# SPDX-License-Identifier: Apache-2.0
"""Reads the commands of a robot's joints and of fins from messages (sensor_msgs/JointState), and wrenches from outside.

A joint is driven by position, velocity or effort, or several of them. A joint for which a message has no value
goes on as before: its values are NaN, or an array is shorter than `name`, as the joint's interfaces (the parameter
`command_interfaces`) are others. So sends joint_state_topic_hardware_interface of ros2_control.
"""

import math
from collections.abc import Collection, Mapping
from typing import Any

from eel_common.quantity import checked_choice
from eel_common.wording import shown
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.ros.messages import stamped

INTERFACES = ("position", "velocity", "effort")
ANY, NONE = "any", "none"  # in place of interfaces
MOST_JOINTS = 1000  # of one message
Values = dict[str, Any]  # of a fin the angle [rad]; of a joint values [rad, rad/s, N m] by interface


def interfaces_of(robot: Robot | None, given: tuple[str, ...]) -> dict[str, tuple[str, ...]]:
    """The interfaces of each joint. `ValueError` for the parameter `given`, which is one for all, or one for each."""
    if robot is None:
        return {}
    names = [joint.name for joint in robot.joints]
    if len(given) not in (1, len(names)):
        raise ValueError(f"command_interfaces must be one, or one for each of {len(names)} joints, got {len(given)}")
    each = [_interfaces(words) for words in given]
    return dict(zip(names, each if len(given) > 1 else each * len(names), strict=True))


def _interfaces(words: str) -> tuple[str, ...]:
    """The interfaces of one joint, from such as "position velocity", any or none."""
    if words in (ANY, NONE):
        return INTERFACES if words == ANY else ()
    for word in words.split() or [words]:
        checked_choice("command_interfaces", word, INTERFACES, ANY, NONE)
    return tuple(words.split())


def joint_command_from_message(
    message: JointState, interfaces: Mapping[str, tuple[str, ...]], now: float
) -> tuple[float, Values]:
    """The stamp [s] of a `message` that comes at simulation time `now` [s], and what joints are to do from then on.

    A joint that it has no value for has none. `ValueError` names what does not fit.
    """
    names = list(message.name)
    if not 1 <= len(names) <= MOST_JOINTS:
        raise ValueError(f"name must hold 1 to {MOST_JOINTS} joints, got {len(names)}")
    joints: Values = {name: {} for name in names}
    for name in joints:
        checked_choice("joint", name, interfaces)
    if len(joints) < len(names):
        twice = next(name for index, name in enumerate(names) if name in names[:index])
        raise ValueError(f"name must hold each joint once, got {shown(twice)} twice")
    for field in INTERFACES:
        values = getattr(message, field)
        if not values:
            continue
        whose = names if len(values) == len(names) else _whose(field, len(values), names, interfaces)
        for name, value in zip(whose, values, strict=True):
            if math.isnan(value):
                continue
            if math.isinf(value):
                raise ValueError(f"{field} of joint {shown(name)} must be finite, got {value}")
            if field not in interfaces[name]:
                own = " and ".join(interfaces[name]) or "none"
                raise ValueError(f"joint {shown(name)} has the command interface {own}, got {field} too")
            joints[name][field] = value
    return stamped(message.header.stamp, now), joints


def _whose(field: str, count: int, names: list[str], interfaces: Mapping[str, tuple[str, ...]]) -> list[str]:
    """The joints of `names` that the `count` values of a `field` are for: those that have that interface."""
    having = [name for name in names if field in interfaces[name]]
    if count == len(having):
        return having
    rule = f"as many values as name, {len(names)}"
    if len(having) < len(names):
        rule += f", or one for each of the {len(having)} joints with that interface"
    hint = "" if len(having) < len(names) else ": with fewer, command_interfaces must say which joints they are for"
    raise ValueError(f"{field} must be empty or have {rule}, got {count}{hint}")


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


def wrench_from_message(
    message: WrenchStamped, frames: Collection[str], head: str, now: float
) -> tuple[float, str, tuple[float, ...]]:
    """Stamp [s], frame, and force [N] and torque [N m] (6,) of a `message` that comes at simulation time `now` [s].

    An empty frame id is that of the `head`. `ValueError` names what does not fit.
    """
    frame, stamp = message.header.frame_id or head, stamped(message.header.stamp, now)
    checked_choice("header.frame_id", frame, frames)
    parts = {"force": message.wrench.force, "torque": message.wrench.torque}
    rows = {name: [float(getattr(vector, axis)) for axis in "xyz"] for name, vector in parts.items()}
    for name, row in rows.items():
        if not all(map(math.isfinite, row)):
            raise ValueError(f"wrench.{name} must be finite, got {shown(row)}")
    return stamp, frame, (*rows["force"], *rows["torque"])
