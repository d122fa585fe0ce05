# SPDX-License-Identifier: Apache-2.0
"""A robot from a URDF: a straight chain of links joined by revolute joints, with the base link at the nose or the tail.

Links become sections of the body, and joints become joints. In the zero configuration the joints must lie on a line. E1
of the body runs along it from the nose to the tail, and E3 is the base link's z. If modules are stacked along that z,
as they often are, E3 is the first joint's axis. A link's half-axes are half the height and width of its collision
shapes, or of its visual ones; those of a mesh follow from its moments of inertia. They change smoothly from the middle
of one link to the middle of the next. Both ends are blunt. The hull coefficients are those of a body of links
(`Body.of_links`), whose argument `joints` is not in a URDF. The body is homogeneous, with the mass of all links.

Motors have the gains of `servo`, the effort and velocity of their joint as limits, and the reduction of a transmission.
Angles keep the URDF's sign. The robot's `notes` list what is ignored.
"""

import math
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.files.xml_tree import Element, read_xml
from eel_common.wording import shown

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.links import BASE, OF_LINKS, joint_drag_of
from eel_dynamics.model.robot.actuators import Servo
from eel_dynamics.model.robot.joint import LONGEST_NAME, Joint
from eel_dynamics.model.robot.urdf.chain import ChainJoint, Link, UrdfChain
from eel_dynamics.model.robot.urdf.elements import UNLIMITED, fail, float_of, name_of, number_of

STRAIGHT = 0.02  # of the length: greatest distance of a joint from the line
UPRIGHT = 0.8  # z component of the chain's direction beyond which the base link's z is not up
BENT = 0.4  # tangent of the greatest angle between an end link and the line
RULE = "at angles of 0 the robot must be straight"
ALIGNED = 0.02  # rad: greatest angle between an axis and E2 or E3
SAME = 1e-9  # of the length: nearer places count as one
MASS_OFF = 0.05  # of a link's mass: a greater difference is noted
UNUSED = ("gazebo", "ros2_control", "safety_controller", "calibration")


def robot_in_urdf(path: str | os.PathLike[str], servo: Servo | None = None, joints: Any = None) -> dict[str, Any]:
    """The arguments of the `Robot`, with its body, in a URDF. `ValueError` names line and element.

    servo: of every joint; None: a `Servo()`. joints: "flush", or the drag coefficient of a link by itself.
    """
    found = UrdfReader(read_xml(path), Servo() if servo is None else servo, joints).arguments()
    return found | {"name": found["name"] or Path(path).stem}


class UrdfReader:
    """Makes the arguments of a `Robot` from the root element of a URDF."""

    def __init__(self, root: Element, servo: Servo, joints: Any) -> None:
        if root.tag != "robot":
            fail(root, "robot", f"must be the root, got {shown(root.tag)}")
        if any("xacro:" in each.tag for each in root.children):
            fail(root, "robot", "holds xacro: expand it with xacro first")
        chain = UrdfChain(root)
        self._root, self._servo, self._joints_drag, self._notes = root, servo, joints, chain.notes
        along = _direction(chain)
        self._from_tail = bool(along[0] > ALIGNED)
        """Whether the base link is the tail: the chain leads along its x."""
        turn = -1 if self._from_tail else 1
        self._links, self._joints = chain.links[::turn], chain.joints[::turn]
        along, up = turn * along, self._up(along)
        self._axes = np.array([along, np.cross(up, along), up])
        """Axes (3, 3) of the sections, rows in the base's."""
        for link, joint in ((self._links[0], self._joints[0]), (self._links[-1], self._joints[-1])):
            self._check_straight(link, joint)
        self._nose = float(self._links[0].extent(self._axes)[0, 0])
        self._places = [float(along @ joint.origin - self._nose) for joint in self._joints]

    def _check_straight(self, link: Link, joint: ChainJoint) -> None:
        """Refuse an end link whose mass and shapes lie off the line."""
        middles = [self._axes.T @ link.extent(self._axes).mean(axis=0), *([link.centre] if link.mass > 0.0 else [])]
        places = np.abs((np.array(middles) - joint.origin) @ self._axes.T)
        off = np.hypot(places[:, 1], places[:, 2])
        if (off > BENT * places[:, 0]).all():
            rule = f"must lie on the line of the joints, got its middle {off.min():.4g} m off it: {RULE}"
            fail(link.element, "link", rule)

    def _up(self, along: np.ndarray) -> np.ndarray:
        """E3 (3,) of the sections, in the base's axes."""
        up, stacked = np.array([0.0, 0.0, 1.0]), abs(along[2]) > UPRIGHT
        if stacked:
            axis = self._joints[0].axis
            up = axis * np.sign(axis[np.argmax(np.abs(axis))])
        up = up - (up @ along) * along
        if not (size := float(np.linalg.norm(up))) > ALIGNED:
            fail(self._joints[0].element, "axis", "must point across the line of joints, got one along it")
        if stacked:
            axes = [round(float(each), 3) + 0.0 for each in up / size]
            end = "tail" if self._from_tail else "nose"
            rule = f"it is the {end}, and what turns about the first joint's axis is yaw: up is"
            self._notes.append(f"modules are stacked along the base link's z: {rule} {shown(axes)} in its axes")
        return np.asarray(up / size)

    def arguments(self) -> dict[str, Any]:
        """parts, name, body and notes."""
        if self._from_tail:
            self._notes.append("the base link is the tail: the chain leads along its x")
        body = self._body()
        parts = [self._joint(joint, place) for joint, place in zip(self._joints, self._places, strict=True)]
        for tag in UNUSED:
            if any(each.first(tag) for each in (self._root, *self._root.all("joint"))):
                self._notes.append(f"elements {tag} are not read")
        name = self._root.attributes.get("name", "")[:LONGEST_NAME]
        return {"parts": parts, "name": name, "body": body, "notes": tuple(self._notes)}

    # -- the body

    def _body(self) -> Body:
        places = self._places
        end = float(self._links[-1].extent(self._axes)[1, 0] - self._nose)
        for i, place in enumerate(places[1:]):
            if abs(place - places[i]) < SAME * end:  # a link between two joints at one place, as in a universal joint
                places[i + 1] = places[i]
        bounds = np.array([0.0, *places, end])
        spans = np.diff(bounds)
        falls = np.flatnonzero((spans < 0.0) | ((spans == 0.0) & np.isin(bounds[1:], (0.0, end))))
        if len(falls):
            index = min(int(falls[0]), len(self._joints) - 1)
            fail(self._joints[index].element, "joint", f"must lie behind the one ahead, got X = {places[index]:.4g} m")
        longer = np.flatnonzero(spans)
        middles = (0.5 * (bounds[1:] + bounds[:-1]))[longer]
        half = np.array([self._links[i].half_axes(self._axes, *bounds[i : i + 2]) for i in longer])
        for link, (width, height) in zip((self._links[i] for i in longer), half, strict=True):
            if not link.corners:
                self._notes.append(f"link {shown(link.name)}: half-axes {width:.3g}, {height:.3g} m from its inertia")
        x = np.concatenate(([0.0], middles, [end]))
        width, height = (np.concatenate((column[:1], column, column[-1:])) for column in half.T)
        name = self._root.attributes.get("name", "urdf")
        hull = OF_LINKS | {
            "joint_drag": joint_drag_of(self._joints_drag),
            "link_length": end / len(self._links),
            "base_drag": BASE,
        }
        body = Body(x=x, half_width=width, half_height=height, blunt_nose=True, name=name, **hull)
        mass = sum(link.mass for link in self._links)
        if not mass > 0.0:
            self._notes.append(f"no link has a mass: the density is that of water, {body.density:g} kg/m^3")
            return body
        body = body.changed(density=mass / body.volume)
        fine = np.linspace(0.0, 1.0, 201)
        for link, start, stop in zip(self._links, bounds, bounds[1:], strict=False):
            at = start + (stop - start) * fine
            kept = body.density * float(np.trapezoid(np.pi * body.half_width(at) * body.half_height(at), at))
            if stop > start and abs(kept - link.mass) > MASS_OFF * max(kept, link.mass):
                self._notes.append(
                    f"link {shown(link.name)}: mass {link.mass:.4g} kg becomes {kept:.4g} kg (one density)"
                )
            if link.mass > 0.0:
                _, right, up = self._axes @ (link.centre - self._joints[0].origin)
                if (off := math.hypot(right, up)) > 1e-3:
                    self._notes.append(
                        f"link {shown(link.name)}: centre of mass {off:.3g} m off the line is put onto it"
                    )
        return body

    # -- joints

    def _joint(self, joint: ChainJoint, place: float) -> Joint:
        element, axis = joint.element, joint.axis
        name = name_of(element)
        parts = self._axes @ axis
        component = int(np.argmax(np.abs(parts)))
        if component == 0 or 1.0 - abs(parts[component]) > 0.5 * ALIGNED**2:
            rule = "must point up (yaw) or to the side (pitch), across the line of joints"
            fail(element, "axis", f"{rule}, got {shown([round(each, 4) for each in axis.tolist()])}")
        # E2 is -y, E3 is z; if the base link is the tail, the part ahead turns about the axis
        right_handed = ((parts[component] > 0.0) == (component == 2)) != self._from_tail
        servo, limits = self._motor(element, name)
        dynamics = element.first("dynamics")
        damping = number_of(element, "dynamics", "damping", 0.0) if dynamics is not None else 0.0
        if dynamics is not None and number_of(element, "dynamics", "friction", 0.0):
            self._notes.append(f"joint {shown(name)}: dry friction is not modelled")
        if element.first("mimic") is not None:
            self._notes.append(f"joint {shown(name)}: mimic is not kept, it has a motor of its own")
        try:
            return Joint(
                place,
                f"{'' if right_handed else '-'}{'y' if component == 1 else 'z'}",
                damping=damping,
                limits=limits,
                actuator=servo,
                name=name[:LONGEST_NAME],
            )
        except ValueError as error:
            fail(element, "joint", str(error))

    def _motor(self, element: Element, name: str) -> tuple[Servo, tuple[float, float] | None]:
        """Servo and stops of a joint."""
        limit, servo = element.first("limit"), self._servo
        if limit is None:
            if element.attributes["type"] == "revolute":
                self._notes.append(f"joint {shown(name)}: no limit, so no stops and the servo's own torque")
            return servo, None
        changes: dict[str, Any] = {}
        for key, attribute in (("torque_limit", "effort"), ("speed_limit", "velocity")):
            value = number_of(element, "limit", attribute, 0.0)
            if 0.0 < value < UNLIMITED:
                changes[key] = value
            elif value < 0.0:
                fail(limit, "limit", f"{attribute} must be >= 0, got {value:g}")
        for transmission in self._root.all("transmission"):
            joint = transmission.first("joint")
            ratios = filter(None, (each.first("mechanicalReduction") for each in transmission.all("actuator")))
            ratio = next(ratios, None)
            if joint is not None and joint.attributes.get("name") == name and ratio is not None:
                changes["gear"] = abs(float_of(ratio, "mechanicalReduction", ratio.text))
        try:
            servo = replace(servo, **changes)
        except ValueError as error:
            fail(limit, "limit", str(error))
        if element.attributes["type"] == "continuous":
            return servo, None
        low, high = (number_of(element, "limit", key, 0.0) for key in ("lower", "upper"))
        if not low < high:
            fail(limit, "limit", f"lower must be < upper, got {low:g} and {high:g}")
        return servo, (low, high)


def _direction(chain: UrdfChain) -> np.ndarray:
    """Unit vector (3,) from the base along the joints, which lie on a line."""
    origins = np.array([joint.origin for joint in chain.joints])
    last = chain.joints[-1].element
    if len(origins) > 1:
        along = origins[-1] - origins[0]
    else:
        ends = [link.extent(np.eye(3)).mean(axis=0) for link in chain.links]
        along = ends[1] - ends[0]
    length = float(np.linalg.norm(along))
    if not length > 0.0:
        fail(last, "joint", "origins of the joints must differ, got the same place")
    along = along / length
    off = origins - origins[0] - np.outer((origins - origins[0]) @ along, along)
    worst = int(np.argmax(np.linalg.norm(off, axis=1)))
    if (far := float(np.linalg.norm(off[worst]))) > STRAIGHT * length:
        rule = f"must lie on the line of the joints, got {far:.4g} m off it: {RULE}"
        fail(chain.joints[worst].element, "origin", rule)
    return np.asarray(along)
