# SPDX-License-Identifier: Apache-2.0
"""Which quantity each field of the messages holds: the node, `messages_of_run` and `recorded_run` go by it."""

from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from eel_dynamics.runs.storage.variables import shape_of

ANGULAR, LINEAR = slice(0, 3), slice(3, 6)  # of a twist


class MessageField(NamedTuple):
    """A quantity of a run or a snapshot, by its name there, and which of its components a field holds.

    parts: names of the field's own fields, as of a Vector3; empty for an array of numbers.
    """

    quantity: str
    components: slice | int = slice(None)
    parts: str = ""

    def of(self, values: np.ndarray) -> np.ndarray:
        """The numbers (n,) of the field, from the `values` of its quantity at one instant."""
        return values[..., self.components].ravel()


def _by_axis(**names: str) -> dict[str, MessageField]:
    """name_1, name_2, name_3 of each quantity, along the axes of a section."""
    return {f"{name}_{axis}": MessageField(of, axis - 1) for name, of in names.items() for axis in (1, 2, 3)}


POSE = {"position": MessageField("position", parts="xyz"), "orientation": MessageField("orientation", parts="xyzw")}
TWIST = {"angular": MessageField("twist", ANGULAR, "xyz"), "linear": MessageField("twist", LINEAR, "xyz")}
# Of each topic: the path of a field in its message, and what the field holds.
FIELDS: dict[str, dict[str, MessageField]] = {
    "head_pose": {f"pose.{name}": each for name, each in POSE.items()},
    "head_twist": {f"twist.{name}": each for name, each in TWIST.items()},
    "odom": {
        **{f"pose.pose.{name}": each for name, each in POSE.items()},
        **{f"twist.twist.{name}": each for name, each in TWIST.items()},
    },
    "backbone": {"position": MessageField("backbone"), "orientation": MessageField("section_orientation")},
    "curvature": {
        **{name: MessageField("curvature", axis) for name, axis in (("pitch", 1), ("yaw", 2))},
        **{f"{name}_rate": MessageField("curvature_rate", axis) for name, axis in (("pitch", 1), ("yaw", 2))},
    },
    "internal_wrench": _by_axis(torque="torque", force="force"),
    "hydrodynamic_load": {
        **_by_axis(force="fluid_force", resistive="resistive_force"),
        **{name: MessageField(name, parts="xyz") for name in ("tail_force", "nose_force", "wake_momentum_rate")},
        "fin_force": MessageField("fin_force"),
    },
    "fin_states": {"position": MessageField("fin_angle")},
    "joint_states": {
        "position": MessageField("joint_angle"),
        "velocity": MessageField("joint_rate"),
        "effort": MessageField("joint_torque"),
    },
    "motor_states": {"torque": MessageField("motor_torque"), "power": MessageField("motor_power")},
}
OF_JOINTS = "joint_states", "motor_states"  # of a robot
SIGNED = "joint_angle", "joint_rate", "joint_torque", "motor_torque"  # of joints: in messages by `message_signs`
PROFILES = "backbone", "curvature", "internal_wrench", "hydrodynamic_load"  # with the stations x


def quantities_of(rows: dict[str, list[Any]], **sizes: int) -> dict[str, np.ndarray | None]:
    """The quantities that the messages of each topic hold, `rows` of T; None for one that no message has.

    sizes: of the dimensions station, fin and joint. `ValueError` where a message has another number of numbers.
    """
    found: dict[str, Any] = {each.quantity: None for fields in FIELDS.values() for each in fields.values()}
    for topic, messages in rows.items():
        for path, each in FIELDS.get(topic, {}).items():
            shape = shape_of(each.quantity, sizes | {"time": len(messages)})
            if not (hasattr(messages[0], path.partition(".")[0]) and all(shape)):  # an older bag has not all
                continue
            values = map(attrgetter(path), messages)
            numbers = [[getattr(value, part) for part in each.parts] if each.parts else value for value in values]
            if found[each.quantity] is None:
                found[each.quantity] = np.zeros(shape)
            place = found[each.quantity][..., each.components]
            place[...] = np.array([np.reshape(row, place.shape[1:]) for row in numbers], dtype=float)
    return found
