# SPDX-License-Identifier: Apache-2.0
"""A robot: the dynamic parts of a body, which bend under forces, in order along it.

The parts decide the law's role. In an axis (yaw, pitch) with motors the body bends only at its joints, and the law
gives the servos' references. A servo's reference is the integral of the law's curvature from midway between its joint
and the one ahead to midway to the one behind; the first reaches to the nose, the last to the tail, or to a continuous
part. In an axis without motors the law is imposed, except on the supports of its joints, tails and muscles.
"""

import math
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import partial
from pathlib import Path
from typing import Any

from eel_common.files.input_file import reading
from eel_common.quantity import checked_choice, checked_instance
from eel_common.texts import named_fields
from eel_common.wording import did_you_mean, not_one_of, shown

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.robot.actuators import Servo
from eel_dynamics.model.robot.joint import LONGEST_NAME, Joint
from eel_dynamics.model.robot.kinds import KINDS
from eel_dynamics.model.robot.part import HINGE, Part
from eel_dynamics.model.robot.ready import READY
from eel_dynamics.model.robot.robot_file import robot_in_yaml
from eel_dynamics.model.robot.urdf.reader import robot_in_urdf

MOST_PARTS = 64


@dataclass(frozen=True, init=False)
class Robot:
    """The dynamic parts of a body. Immutable; equal if all parts are.

    `ValueError` names a bad argument. The rest is checked with the body (`mode_table`).

    Attributes:
        parts: joints, passive tails and muscles, by their positions. Joints without a name are called joint_1, ...
        name: its name in messages.
        body: its own body, such as from a file; None: any.
        notes: content of its file that the robot ignores, in words.
    """

    parts: tuple[Any, ...]
    name: str
    body: Body | None
    notes: tuple[str, ...] = field(compare=False)

    def __init__(
        self,
        parts: Iterable[Part] | Part,
        *,
        name: str = "robot",
        body: Body | None = None,
        notes: Iterable[str] = (),
    ) -> None:
        given = [parts] if isinstance(parts, Part) else parts
        if isinstance(given, (str, bytes)) or not isinstance(given, Iterable):
            raise ValueError(f"robot parts must be joints, passive tails and muscles, got {shown(parts)}")
        checked = [checked_instance("a robot's part", each, tuple(KINDS.values())) for each in given]
        listed = sorted(checked, key=lambda part: part.place)
        if len(listed) > MOST_PARTS:
            raise ValueError(f"robot parts must be at most {MOST_PARTS}, got {len(listed)}")
        if not isinstance(name, str) or len(name) > LONGEST_NAME:
            raise ValueError(f"robot name must be a text of at most {LONGEST_NAME} characters, got {shown(name)}")
        object.__setattr__(self, "parts", _named(listed))
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "body", None if body is None else checked_instance("robot body", body, Body))
        object.__setattr__(self, "notes", tuple(checked_instance("robot notes", notes, Iterable)))

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Its joints, from the nose to the tail."""
        return tuple(part for part in self.parts if isinstance(part, Joint))

    @property
    def mode_count(self) -> int:
        """The number of modes of its continuous parts."""
        return sum(len(part.degrees) for part in self.parts if HINGE not in part.degrees)

    def joint(self, name: str) -> Joint:
        """The joint called `name`. `ValueError` for an unknown name."""
        found = {joint.name: joint for joint in self.joints}
        checked_choice("joint", name, found)
        return found[name]

    @property
    def servos(self) -> tuple[Servo | None, ...]:
        """The servos of its joints; None for a joint without."""
        return tuple(joint.actuator if isinstance(joint.actuator, Servo) else None for joint in self.joints)

    @property
    def ramp_ends(self) -> list[float]:
        """Times [s] of beginnings and ends of ramps in muscles' moments, where a derivative jumps."""
        terms = (term for part in self.parts if part.moment is not None for term in part.moment.terms)
        return sorted({time for term in terms for ramp in term.envelope for time in (ramp.start, ramp.end)})

    @property
    def driven_names(self) -> tuple[str, ...]:
        """Names of the joints with a servo."""
        return tuple(joint.name for joint in self.joints if isinstance(joint.actuator, Servo))

    def changed(self, part: str | None = None, **changes: Any) -> "Robot":
        """The same robot with changed fields of one `part`, or of all parts that have them; also fields of actuators.

        Examples: robot.changed(torque_limit=1.0), robot.changed("joint_3", stiffness=2.0). part: a name, or a kind:
        joints, servos, tails, muscles. `ValueError` for a field that no part, or not the named part, has.
        """
        names = [each.name for each in self.parts]
        kind = None if part in names else SORTS.get(str(part))
        if part is not None and part not in names and kind is None:
            raise ValueError(not_one_of("part", part, (*names, *SORTS)))
        meant = [part in (None, each.name) or (kind is not None and kind(each)) for each in self.parts]
        known = {
            item.name for each, yes in zip(self.parts, meant, strict=True) if yes
            for one in _with_actuator(each) for item in fields(one)
        }  # fmt: skip
        for name in changes:
            if name not in known:
                whose = "no part of the robot has" if part is None else f"{shown(part)} has no"
                raise ValueError(f"{whose} {shown(name)}{did_you_mean(name, known)}")
        parts = (_changed(each, changes) if yes else each for each, yes in zip(self.parts, meant, strict=True))
        return Robot(parts, name=self.name, body=self.body, notes=self.notes)

    def has(self, name: str) -> bool:
        """Whether a part, or its actuator, has the field at the end of `name`, as in `with_numbers`."""
        owners = (each for part in self.parts for each in _with_actuator(part))
        return any(item.name == name.rpartition(".")[2] for each in owners for item in fields(each))

    def with_numbers(self, numbers: Mapping[str, Any]) -> "Robot":
        """The same robot with these `numbers`: FIELD of all parts that have it, or PART.FIELD as in `changed`.

        Example: {"kp": 20.0, "joint_3.stiffness": 2.0, "tail.bending_stiffness": 0.3}. An infinite limit or series
        stiffness means none.
        """
        robot = self
        for name, value in checked_instance("robot numbers", numbers, Mapping).items():
            part, _, field_name = name.rpartition(".")
            none = value == math.inf and field_name in UNLIMITED
            robot = robot.changed(part or None, **{field_name: None if none else value})
        return robot

    def __repr__(self) -> str:
        kinds = [type(part).__name__ for part in self.parts]
        counts = ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds)) or "no parts"
        return f"Robot({self.name!r}, {counts})"

    @staticmethod
    def named(name: str) -> "Robot":
        """The ready robot called `name`, one of `READY`. `ValueError` for an unknown name."""
        checked_choice("robot", name, READY, "a file")
        return Robot(READY[name](), name=name)

    @staticmethod
    def from_file(path: str | os.PathLike[str], servo: Servo | None = None, joints: Any = None) -> "Robot":
        """The robot in a .yaml file (`robot_file` has the keys) or in a URDF, with its body.

        servo: gains for the motors of a URDF, which does not hold them. joints: for a URDF, the drag of its links:
        "flush", or a coefficient from 0 to 0.87 (`Body.of_links`). `ValueError` in one line names file and place.
        """
        if not isinstance(path, (str, os.PathLike)):
            raise ValueError(f"robot file must be a path, got {shown(path)}")
        with reading(f"robot file {shown(str(path))}"):
            if Path(path).suffix in (".urdf", ".xml"):
                return Robot(**robot_in_urdf(path, servo, joints))
            if joints is not None:
                raise ValueError(f"joints belong to a URDF, got {shown(joints)}")
            if Path(path).suffix in (".yaml", ".yml"):
                return Robot(**robot_in_yaml(path))
        raise ValueError(f"robot file must be .yaml, .yml, .urdf or .xml, got {shown(str(path))}")


UNLIMITED = ("torque_limit", "speed_limit", "series_stiffness")  # None is no limit, or no spring
SORTS: dict[str, Callable[[Any], bool]] = {  # kinds of parts by name
    "joints": lambda part: isinstance(part, Joint),
    "servos": lambda part: isinstance(part.actuator, Servo),
}
SORTS |= {key: partial(lambda kind, part: isinstance(part, kind), kind) for key, kind in KINDS.items()}


def robot_of(text: str) -> Robot | None:
    """The robot called `text`, or in that file; None for an empty text. `ValueError` for an unknown name.

    A URDF needs the drag of its links, such as "chain.urdf joints=flush", or a coefficient from 0 to 0.87.
    """
    if not text:
        return None
    with reading("robot"):
        given = named_fields("robot", "name", text)
        name, joints = given.pop("name"), given.pop("joints", None)
        if given:
            raise ValueError(f"{shown(text)} must be a name, or a file, of a URDF with joints=flush or a number")
        return Robot.from_file(name, joints=joints) if Path(name).suffix or joints else Robot.named(name)


def checked_robot(robot: Any) -> Robot | None:
    """`robot`, if it is a `Robot` with parts; None for None or no parts. `ValueError` for anything else."""
    if isinstance(robot, (str, os.PathLike)):
        raise ValueError(f"robot must be a Robot, got {shown(robot)}: Robot.named(...) finds one by its name")
    if robot is None or not checked_instance("robot", robot, Robot).parts:
        return None
    made: Robot = robot
    return made


def _named(parts: list[Any]) -> tuple[Any, ...]:
    """The `parts`, each with its own name."""
    taken, count = {part.name for part in parts if part.name}, 0
    named: list[Any] = []
    for part in parts:
        if isinstance(part, Joint):
            count += 1
            while not part.name and f"joint_{count}" in taken:
                count += 1
        if any(other.name == part.name for other in named):
            raise ValueError(f"each part of a robot must have a name of its own, got {shown(part.name)} twice")
        named.append(part if part.name else replace(part, name=f"joint_{count}"))
    return tuple(named)


def _with_actuator(part: Any) -> tuple[Any, ...]:
    actuator = getattr(part, "actuator", None)
    return (part,) if actuator is None else (part, actuator)


def _changed(part: Any, changes: dict[str, Any]) -> Any:
    """`part` with those of the `changes` that it has. Fields of the actuator are changed there."""
    own = {name: value for name, value in changes.items() if name in {item.name for item in fields(part)}}
    rest = {name: value for name, value in changes.items() if name not in own}
    if len(_with_actuator(part)) > 1 and "actuator" not in own:
        inner = {item.name for item in fields(part.actuator)} & rest.keys()
        own |= {"actuator": replace(part.actuator, **{name: rest[name] for name in inner})} if inner else {}
    return replace(part, **own)
