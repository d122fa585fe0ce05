# SPDX-License-Identifier: Apache-2.0
"""Receives the commands of a robot's joints and of fins (sensor_msgs/JointState), checks each, and queues it.

A joint is driven by position, velocity or effort, whichever the parameter `command_interfaces` says; the other fields
of the message are empty, or NaN for the joint.
"""

import math
from typing import Any

from eel_base.quantity import is_finite
from eel_base.wording import not_one_of, shown
from eel_ros.loop.diagnostics import ERROR, Report
from eel_ros.qos import keep_all
from eel_ros.serving import ServedNode
from sensor_msgs.msg import JointState

from eel_dynamics.ros.loop.joint_commander import Joints
from eel_dynamics.ros.loop.run_loop import RunLoop
from eel_dynamics.ros.messages import stamped

TOPIC = "joint_commands"
INTERFACES = ("position", "velocity", "effort")
MOST_JOINTS = 1000  # of one message
FIN_DEPTH = 10  # commands


def interfaces_of(names: tuple[str, ...], given: tuple[str, ...]) -> dict[str, str]:
    """The interface of each joint. `ValueError` for the parameter `given`, which is one for all, or one for each."""
    for each in given:
        if each not in INTERFACES:
            raise ValueError(not_one_of("command_interfaces", each, INTERFACES))
    if len(given) not in (1, len(names)):
        raise ValueError(f"command_interfaces must be one, or one for each of {len(names)} joints, got {len(given)}")
    return dict(zip(names, given if len(given) > 1 else given * len(names), strict=True))


def command_from_message(message: JointState, interfaces: dict[str, str], now: float) -> tuple[float, Joints]:
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
    joints: dict[str, tuple[str, float]] = {}
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


class JointCommandSubscription:
    """The subscription of `node` to joint_commands, for a `run` of a robot whose joints have these `interfaces`."""

    def __init__(self, node: ServedNode, run: RunLoop, interfaces: dict[str, str], report: Report) -> None:
        self._run, self._interfaces, self._report = run, interfaces, report
        node.create_subscription(JointState, TOPIC, self._receive, keep_all(reliable=True))

    def _receive(self, message: Any) -> None:
        try:
            command = command_from_message(message, self._interfaces, self._run.time)
        except ValueError as error:
            self._report.event("commands", f"joint command refused: {error}", ERROR, differing=True)
        else:
            self._run.requests.put(self._run.take_command, *command)


def fin_command_from_message(message: JointState) -> dict[str, float]:
    """Angles [rad] by the names of fins, of a JointState. `ValueError` for as many positions as names."""
    if len(message.name) != len(message.position) or not message.name:
        raise ValueError(
            f"fin_command must have a position for each name, one or more, got {len(message.name)} names and "
            f"{len(message.position)} positions"
        )
    return dict(zip(message.name, message.position, strict=True))


class FinSubscription:
    """The subscription of `node` to fin_command, for a `run`: commands act between two samples."""

    def __init__(self, node: ServedNode, run: RunLoop, report: Report) -> None:
        self._run, self._report = run, report
        node.create_subscription(JointState, "fin_command", self.receive, FIN_DEPTH)

    def receive(self, message: JointState) -> None:
        """Pass on the command in the `message`."""
        try:
            commands = fin_command_from_message(message)
        except ValueError as error:
            self._report.event("fin command", f"fin_command refused: {error}", ERROR)
        else:
            self._run.requests.put(self._run.command_fins, commands)
