# SPDX-License-Identifier: Apache-2.0
"""Gives joints of older bags the signs of REP-103, which joints have in messages (JointGeometry).

Before, the angles of a robot's joints had the signs of the library, "yaw" positive to the left, and those that an
imposed motion asks of motors the signs of section axes. A bag is older where its own definitions of messages lack the
fields that came with the signs.
"""

from collections.abc import Collection
from dataclasses import replace
from typing import Any

import numpy as np

from eel_viz.bags.bag import Bag
from eel_viz.recording.destination import LogFunction

YAW = 3  # JointGeometry.axis
CAME_WITH_THEM = {  # topic: the message and its field that came with the signs
    "body": ("eel_msgs/msg/JointGeometry", "sense"),
    "motor_states": ("eel_msgs/msg/MotorStates", "name"),
    "hydrodynamic_load": ("eel_msgs/msg/HydrodynamicLoad", "fin_name"),
}
SIGNED = {"joint_states": ("position", "velocity", "effort"), "motor_states": ("torque",)}
BEFORE = "recorded before joints had the signs of REP-103"


class JointSigns:
    """The signs of the joints of the swimmer in this `namespace`, "" or "/NAME", of a `bag`.

    turned: names of the joints whose sign was another one; None: those that the topic `body` tells.
    """

    def __init__(
        self, bag: Bag, namespace: str, log_warning: LogFunction, turned: Collection[str] | None = None
    ) -> None:
        self._joints: list[Any] | None = None  # JointGeometry
        self._turned = turned
        if not is_older(bag, namespace):
            self._turned = ()
            return
        topic = f"{namespace}/body"
        body: Any = next((each for _, _, each in bag.messages(topic)), None) if topic in bag.topics else None
        self._joints = None if body is None else body.joints
        if turned is not None or not any(f"{namespace}/{name}" in bag.topics for name in SIGNED):
            return
        if self._joints is None:
            self._turned = ()
            log_warning(f"{BEFORE}, and without a body: the signs of joints are left as they are")
        elif self._joints:
            self._turned = {joint.name for joint in self._joints if joint.axis == YAW}
            log_warning(
                f"{BEFORE}: those in yaw are turned; for a robot from a URDF that is wrong, give it to from_bag"
            )

    def turn(self, topic: str, message: Any) -> Any:
        """The `message` of a `topic` with the signs of today."""
        if topic not in SIGNED or self._turned == ():
            return message
        if topic == "joint_states":
            names = list(message.name)
        else:
            names = [joint.name for joint in self._joints or ()]
        signs = np.array([-1.0 if self._is_turned(name) else 1.0 for name in names])
        rows = {field: np.asarray(getattr(message, field), dtype=float) for field in SIGNED[topic]}
        return replace(message, **{field: row * signs + 0.0 for field, row in rows.items() if len(row) == len(signs)})

    def _is_turned(self, name: str) -> bool:
        if self._turned is None:  # of an imposed motion
            return name.startswith("pitch_")
        return name in self._turned


def is_older(bag: Bag, namespace: str) -> bool:
    """Whether a `bag` was recorded before joints had the signs of REP-103, by its definitions of messages."""
    known = [(f"{namespace}/{topic}", kind, field) for topic, (kind, field) in CAME_WITH_THEM.items()]
    return any(not bag.has_field(topic, kind, field) for topic, kind, field in known if topic in bag.topics)
