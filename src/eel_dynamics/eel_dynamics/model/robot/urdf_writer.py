# SPDX-License-Identifier: Apache-2.0
"""A swimmer as a URDF: a straight chain of rigid links, from the head to the tail.

The base link has the head's frame: x forward, y left, z up (REP-103), at the nose. It has no mass, as KDL requires; the
link at the nose is fixed to it. The frame of each other link lies in its joint. At angles of 0 its axes are parallel to
the head's. A joint of the robot bends over a short width; here it is a hinge in the middle of it, with the axis and the
sign of `joint_states`. Each link has the mass, the centre of mass and the inertia of its part of the body. Between two
joints at one place there is a short link, with a slice of the body.

URDF has no elliptic sections, so boxes replace them: a row of short ones as visual shapes, and one as collision shape,
with the section in the link's middle. `left_out`, and a comment, list what a URDF cannot describe.
"""

import re
from bisect import bisect_left
from collections.abc import Iterable, Mapping
from dataclasses import fields
from itertools import pairwise
from types import MappingProxyType
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
from eel_common.quantity import checked_instance, is_finite, number
from eel_common.wording import shown

from eel_dynamics.model.body.body import Body, checked_body
from eel_dynamics.model.fins.fins import Fin
from eel_dynamics.model.rigid_parts import SAME, RigidPart, rigid_parts
from eel_dynamics.model.robot.actuators import Servo, Torque
from eel_dynamics.model.robot.compiled import mode_table
from eel_dynamics.model.robot.joint import Joint
from eel_dynamics.model.robot.joint_signs import message_limits, sense_of
from eel_dynamics.model.robot.robot import Robot, checked_robot
from eel_dynamics.model.robot.urdf.elements import UNLIMITED

MOST_JOINTS = 1000  # per axis, for an imposed shape
SLICES = 50  # visual boxes per length of the body
SLICE_OF_CROSS = 0.125  # of a link between joints at one place: its length by the distance to the next joint or end
DIGITS = 15  # of numbers in the file
SKIN = "0.30 0.48 0.50 1"  # colour, rgba
VECTORS = {"yaw": (0, 0, 1), "pitch": (0, 1, 0)}
WRITTEN = {"position", "axis", "limits", "damping", "actuator", "name"}  # fields of a Joint
WRITTEN_OF_SERVO = {"torque_limit", "speed_limit"}
NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
ABOUT = "the straight body in kg, m and rad, without its water; the frame of the base link is the head's"


class Urdf(NamedTuple):
    """A URDF, and the properties of the swimmer that it cannot describe."""

    text: str
    left_out: tuple[str, ...]


class Hinge(NamedTuple):
    """A joint of a URDF."""

    name: str
    place: float  # m, X
    axis: tuple[int, int, int]
    limits: tuple[float, float] | None = None  # rad
    effort: float | None = None  # N m; None with `speed`: no limits are written
    speed: float | None = None  # rad/s
    damping: float = 0.0  # N m s/rad


def urdf_of(
    body: Body | None = None,
    robot: Robot | None = None,
    *,
    yaw_joints: int = 0,
    pitch_joints: int = 0,
    density: float | None = None,
    fins: Iterable[Fin] = (),
    base_link: str = "base_link",
    frames: Mapping[str, float] = MappingProxyType({}),
) -> Urdf:
    """The URDF of a `robot`, or of a `body` whose shape is imposed.

    Args:
        body: by default the robot's own, or that of Boyer, Porez and Leroyer 2010.
        robot: its joints become the joints of the URDF.
        yaw_joints, pitch_joints: without a robot, numbers of joints per axis, as the parameters of the node `dynamics`:
            yaw_1, ..., in the middles of equal parts of the body. Without any, the URDF is one rigid link.
        density: [kg/m^3] of a scene, instead of a homogeneous body's own.
        fins: they are listed in `left_out`.
        base_link: name of the base link, the head's frame. Its part up to the last "/" is a prefix of all links' names.
        frames: X [m] by name of further links without mass, such as those of sensors. Each is fixed to the link at X.

    `ValueError` names a bad argument.
    """
    robot = checked_robot(robot)
    body = checked_body(robot.body if body is None and robot is not None else body)
    for name, count in (("yaw_joints", yaw_joints), ("pitch_joints", pitch_joints)):
        if not is_finite(count) or count != int(count) or not 0 <= count <= MOST_JOINTS:
            raise ValueError(f"{name} must be a whole number, 0 to {MOST_JOINTS}, got {shown(count)}")
        if robot is not None and count:
            raise ValueError(f"{name} must be 0 with a robot, which has joints of its own, got {count}")
    if robot is None:
        hinges = _imposed(body, {"yaw": int(yaw_joints), "pitch": int(pitch_joints)})
    else:
        mode_table(robot, body)  # checks that the robot fits the body
        hinges = [_hinge(joint) for joint in robot.joints]
    called = (body if robot is None else robot).name or "eel"
    checked_instance("frames", frames, Mapping)
    for name in (called, base_link, *(hinge.name for hinge in hinges), *frames):
        if not isinstance(name, str) or not name or NOT_IN_XML.search(name):
            raise ValueError(f"names in a URDF must be texts that XML can hold, got {shown(name)}")
    for name, place in frames.items():
        number(f"frame {shown(name)}", place, "m", minimum=0.0, maximum=body.length)
    left_out = (*_left_out(robot, len(hinges)), *(f"fin {shown(fin.name or fin.side)}" for fin in fins))
    root = _Writer(body, hinges, base_link, density).robot(called, frames)
    _check_names(root)
    said = "; ".join((ABOUT, *(f"left out: {each}" for each in left_out)))
    root.insert(0, ElementTree.Comment(re.sub("-(?=-)", "- ", f" {said} ")))  # -- ends a comment
    ElementTree.indent(root)
    return Urdf(f'<?xml version="1.0"?>\n{ElementTree.tostring(root, encoding="unicode")}\n', left_out)


def _check_names(root: ElementTree.Element) -> None:
    """`ValueError` if two links, or two joints, have the same name."""
    for tag in ("link", "joint"):
        names = [each.get("name") for each in root.findall(tag)]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"each {tag} in a URDF must have a name of its own, got {shown(name)} twice")


def _imposed(body: Body, counts: dict[str, int]) -> list[Hinge]:
    """The hinges of a chain whose links follow the imposed shape, from the nose to the tail."""
    hinges = [
        Hinge(f"{axis}_{k + 1}", body.length * (k + 0.5) / count, VECTORS[axis])
        for axis, count in counts.items()
        for k in range(count)
    ]
    return sorted(hinges, key=lambda hinge: hinge.place)


def _hinge(joint: Joint) -> Hinge:
    actuator, sense = joint.actuator, sense_of(joint.axis)
    x, y, z = VECTORS["yaw"] if joint.component == 2 else VECTORS["pitch"]
    effort = 0.0 if actuator is None else getattr(actuator, "torque_limit", None) or UNLIMITED
    speed = getattr(actuator, "speed_limit", None) or UNLIMITED
    axis = sense * x, sense * y, sense * z
    return Hinge(joint.name, joint.position, axis, message_limits(joint), effort, speed, joint.damping)


def _left_out(robot: Robot | None, hinges: int) -> list[str]:
    """The properties that a URDF cannot describe, in words."""
    if robot is None:
        return [] if hinges else ["bending: it is one rigid link without yaw_joints and pitch_joints"]
    said = [
        f"{part.what} {shown(part.name)} bends behind X = {part.start:g} m"
        for part in robot.parts
        if not isinstance(part, Joint)
    ]
    of_joints, of_servos = dict[str, None](), dict[str, None]()
    for joint in robot.joints:
        of_joints |= dict.fromkeys(_changed_fields(joint, WRITTEN))
        if isinstance(joint.actuator, Servo):
            of_servos |= dict.fromkeys(_changed_fields(joint.actuator, WRITTEN_OF_SERVO, always=("kp", "kd")))
        if isinstance(joint.actuator, Torque):
            said.append(f"joint {shown(joint.name)}: its torque over time")
    for what, names in (("joints", of_joints), ("servos", of_servos)):
        said += [f"{', '.join(names)} of {what}"] if names else []
    return said


def _changed_fields(given: Any, written: set[str], always: tuple[str, ...] = ()) -> list[str]:
    names = (item for item in fields(given) if item.name not in written)
    return [item.name for item in names if item.name in always or getattr(given, item.name) != item.default]


class _Writer:
    """Makes the elements of a URDF, for a `body` with `hinges` in order from the nose."""

    def __init__(self, body: Body, hinges: list[Hinge], base_link: str, density: float | None) -> None:
        self._body, self._hinges, self._base = body, hinges, base_link
        self._prefix = "".join(base_link.rpartition("/")[:2])
        self._links = [f"{self._prefix}link_{k}" for k in range(len(hinges) + 1)]
        cuts = self._cuts([hinge.place for hinge in hinges])
        self._bounds = [0.0, *cuts, body.length]
        self._parts = rigid_parts(body, cuts, density)

    def _cuts(self, places: list[float]) -> list[float]:
        """Places [m] at which the body is cut: each joint, and both sides of joints at one place."""
        length = self._body.length
        groups: list[list[float]] = []
        for place in places:
            if groups and place - groups[-1][0] < SAME * length:
                groups[-1].append(place)
            else:
                groups.append([place])
        ends, cuts = [0.0, *(group[0] for group in groups), length], list[float]()
        for k, group in enumerate(groups):
            if len(group) > 1:
                half = SLICE_OF_CROSS * min(np.diff(ends[k : k + 3]))
                group = np.linspace(group[0] - half, group[0] + half, len(group)).tolist()
            cuts += group
        return cuts

    def robot(self, name: str, frames: Mapping[str, float]) -> ElementTree.Element:
        """The root element. frames: X [m] of further links, by name."""
        root = ElementTree.Element("robot", name=name)
        ElementTree.SubElement(ElementTree.SubElement(root, "material", name="skin"), "color", rgba=SKIN)
        ElementTree.SubElement(root, "link", name=self._base)
        taken, fixed = {hinge.name for hinge in self._hinges}, "head_joint"
        while fixed in taken:
            fixed += "_"
        origin = 0.0
        self._join(root, fixed, "fixed", self._base, self._links[0], 0.0)
        for k, (link, part) in enumerate(zip(self._links, self._parts, strict=True)):
            if k:
                hinge = self._hinges[k - 1]
                self._add_hinge(root, hinge, self._links[k - 1], link, hinge.place - origin)
                origin = hinge.place
            self._add_link(root, link, part, origin, self._bounds[k], self._bounds[k + 1])
        places = [hinge.place for hinge in self._hinges]
        for frame, x in frames.items():
            k = bisect_left(places, x)  # number of joints ahead of it
            ElementTree.SubElement(root, "link", name=f"{self._prefix}{frame}")
            along = x - (places[k - 1] if k else 0.0)
            self._join(root, f"{frame}_joint", "fixed", self._links[k], f"{self._prefix}{frame}", along)
        return root

    def _add_link(
        self, root: ElementTree.Element, name: str, part: RigidPart, origin: float, start: float, end: float
    ) -> None:
        """A link with the part of the body from X = start to end [m], and its frame at X = origin [m]."""
        link = ElementTree.SubElement(root, "link", name=name)
        if part.mass > 0.0:
            inertial = ElementTree.SubElement(link, "inertial")
            ElementTree.SubElement(inertial, "origin", xyz=_row(part.centre + np.array([origin, 0.0, 0.0])))
            ElementTree.SubElement(inertial, "mass", value=_text(part.mass))
            names = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
            ElementTree.SubElement(
                inertial, "inertia", {key: _text(part.inertia[place]) for key, place in names.items()}
            )
        count = max(1, round(SLICES * (end - start) / self._body.length))
        for ends in pairwise(np.linspace(start, end, count + 1).tolist()):
            visual = self._add_box(link, "visual", origin, *ends, digits=6)
            ElementTree.SubElement(visual, "material", name="skin")
        self._add_box(link, "collision", origin, start, end)

    def _add_box(
        self, link: ElementTree.Element, tag: str, origin: float, start: float, end: float, digits: int = DIGITS
    ) -> ElementTree.Element:
        """A box from X = start to end [m], as wide and high as the section in its middle."""
        middle = 0.5 * (start + end)
        element = ElementTree.SubElement(link, tag)
        ElementTree.SubElement(element, "origin", xyz=_row((origin - middle, 0.0, 0.0), digits))
        size = end - start, *(2.0 * float(half(middle)) for half in (self._body.half_width, self._body.half_height))
        ElementTree.SubElement(ElementTree.SubElement(element, "geometry"), "box", size=_row(size, digits))
        return element

    def _add_hinge(self, root: ElementTree.Element, hinge: Hinge, parent: str, child: str, along: float) -> None:
        kind = "continuous" if hinge.limits is None else "revolute"
        joint = self._join(root, hinge.name, kind, parent, child, along)
        ElementTree.SubElement(joint, "axis", xyz=_row(hinge.axis))
        if hinge.effort is not None and hinge.speed is not None:
            limits = (
                {} if hinge.limits is None else dict(zip(("lower", "upper"), map(_text, hinge.limits), strict=True))
            )
            ElementTree.SubElement(joint, "limit", limits, effort=_text(hinge.effort), velocity=_text(hinge.speed))
        if hinge.damping:
            ElementTree.SubElement(joint, "dynamics", damping=_text(hinge.damping))

    def _join(
        self, root: ElementTree.Element, name: str, kind: str, parent: str, child: str, along: float
    ) -> ElementTree.Element:
        """A joint whose frame lies `along` [m] behind the frame of its parent."""
        joint = ElementTree.SubElement(root, "joint", name=name, type=kind)
        ElementTree.SubElement(joint, "parent", link=parent)
        ElementTree.SubElement(joint, "child", link=child)
        ElementTree.SubElement(joint, "origin", xyz=_row((-along, 0.0, 0.0)))
        return joint


def _text(value: float, digits: int = DIGITS) -> str:
    return f"{value + 0.0:.{digits}g}"


def _row(values: Iterable[float], digits: int = DIGITS) -> str:
    return " ".join(_text(value, digits) for value in values)
