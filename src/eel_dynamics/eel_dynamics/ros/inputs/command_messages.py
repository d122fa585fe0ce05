# SPDX-License-Identifier: Apache-2.0
"""Reads messages with commands for joints and fins (sensor_msgs/JointState), external wrenches, currents and states.

A joint command holds position, velocity or effort, or several of them. A message need not have a value for each joint:
a value may be NaN, and an array may be shorter than `name` if some joints lack that interface (the parameter
`command_interfaces`). joint_state_topic_hardware_interface of ros2_control sends such messages. A joint without a
value keeps its last command.
"""

import math
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
from eel_common.quantity import checked_choice
from eel_common.wording import shown
from geometry_msgs.msg import Vector3Stamped, WrenchStamped
from sensor_msgs.msg import JointState

from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.ros.inputs.stamps import stamped
from eel_dynamics.ros.parameters import unit_quaternion
from eel_msgs.srv import SetState

INTERFACES = ("position", "velocity", "effort")
ANY, NONE = "any", "none"  # special values of command_interfaces
MOST_JOINTS = 1000  # of one message
Values = dict[str, Any]  # by name: angle [rad] of a fin; of a joint [rad, rad/s, N m], by interface


def interfaces_of(robot: Robot | None, given: tuple[str, ...]) -> dict[str, tuple[str, ...]]:
    """The command interfaces of each joint, by name.

    given: the parameter, with one entry for all joints, or one for each. `ValueError` for another number of entries,
    and for an unknown interface.
    """
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
    """The stamp [s] of a `message`, and its values by joint and interface: none for a joint without a value.

    now: simulation time [s]. `ValueError` names an invalid field, joint or interface.
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
        whose = names if len(values) == len(names) else _joints_with(field, len(values), names, interfaces)
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


def _joints_with(field: str, count: int, names: list[str], interfaces: Mapping[str, tuple[str, ...]]) -> list[str]:
    """The joints among `names` with the interface `field`. `ValueError` if they are not `count`, as the values are."""
    having = [name for name in names if field in interfaces[name]]
    if count == len(having):
        return having
    rule = f"as many values as name, {len(names)}"
    if len(having) < len(names):
        rule += f", or one for each of the {len(having)} joints with that interface"
    hint = "" if len(having) < len(names) else ": with fewer, command_interfaces must say which joints they are for"
    raise ValueError(f"{field} must be empty or have {rule}, got {count}{hint}")


def fin_command_from_message(message: JointState, now: float) -> tuple[float, dict[str, float]]:
    """The stamp [s] of a `message`, and the angle [rad] of each fin, by name.

    now: simulation time [s]. `ValueError` for an invalid stamp, and if there are not as many positions as names.
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
    """Stamp [s], frame, and force [N] and torque [N m] (6,) of a `message`.

    now: simulation time [s]. An empty frame id means the `head`. `ValueError` names an invalid field.
    """
    frame, stamp = message.header.frame_id or head, stamped(message.header.stamp, now)
    checked_choice("header.frame_id", frame, frames)
    parts = {"force": message.wrench.force, "torque": message.wrench.torque}
    rows = {name: [float(getattr(vector, axis)) for axis in "xyz"] for name, vector in parts.items()}
    for name, row in rows.items():
        if not all(map(math.isfinite, row)):
            raise ValueError(f"wrench.{name} must be finite, got {shown(row)}")
    return stamp, frame, (*rows["force"], *rows["torque"])


def current_from_message(message: Vector3Stamped, now: float, world_frame: str) -> tuple[float, np.ndarray]:
    """Stamp [s] and velocity (3,) [m/s], world, of a current. now: simulation time [s].

    `ValueError` for an invalid stamp, or another frame than `world_frame`.
    """
    frame, stamp = message.header.frame_id, stamped(message.header.stamp, now)
    if frame not in ("", world_frame):
        raise ValueError(f"header.frame_id must be {world_frame}, got {shown(frame)}")
    velocity = np.array([message.vector.x, message.vector.y, message.vector.z])
    return stamp, velocity


def state_from_message(request: SetState.Request) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The arguments of `Simulation.set_state` from a request. `ValueError` names the field."""
    pose, twist = request.pose, request.twist
    groups = {
        "pose.position": [getattr(pose.position, axis) for axis in "xyz"],
        "pose.orientation": [getattr(pose.orientation, axis) for axis in "xyzw"],
        "twist.angular": [getattr(twist.angular, axis) for axis in "xyz"],
        "twist.linear": [getattr(twist.linear, axis) for axis in "xyz"],
    }
    for name, values in groups.items():
        if not np.isfinite(values).all():
            raise ValueError(f"{name} must be finite, got {shown(values)}")
    position, orientation, angular, linear = groups.values()
    unit = unit_quaternion("pose.orientation", orientation)
    return np.array(position), np.array(unit), np.array([*angular, *linear])
