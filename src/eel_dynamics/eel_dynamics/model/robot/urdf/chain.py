# SPDX-License-Identifier: Apache-2.0
"""The chain of links and joints in a URDF, in the axes of the base link's zero configuration."""

import math
from dataclasses import dataclass, field
from itertools import product
from typing import NamedTuple

import numpy as np
from eel_common.files.xml_tree import Element
from eel_common.wording import shown

from eel_dynamics.model.robot.urdf.elements import fail, name_of, number_of, origin_of, positive_of, vector_of

MOVABLE = ("revolute", "continuous")
NEEDED = "a chain of revolute joints"


class ChainJoint(NamedTuple):
    """A joint that moves."""

    element: Element
    origin: np.ndarray  # (3,) m
    axis: np.ndarray  # (3,) unit


@dataclass
class Link:
    """A link and everything fixed to it, in the axes of the base link's zero configuration."""

    element: Element
    mass: float = 0.0
    moment: np.ndarray = field(default_factory=lambda: np.zeros(3))  # kg m, mass times centre
    inertia: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))  # kg m^2, about the base's origin
    corners: list[np.ndarray] = field(default_factory=list)  # (2, 3) m, boxes along the axes around shapes

    @property
    def name(self) -> str:
        return name_of(self.element)

    @property
    def centre(self) -> np.ndarray:
        """Its centre of mass (3,) [m]."""
        return self.moment / self.mass

    def extent(self, axes: np.ndarray) -> np.ndarray:
        """Least and greatest coordinates (2, 3) [m] of its shapes along the axes; for a mesh, of the equal cylinder."""
        if self.corners:
            turned = np.array([axes @ corner for box in self.corners for corner in product(*box.T)])
            return np.array([turned.min(axis=0), turned.max(axis=0)])
        if not self.mass > 0.0:
            fail(self.element, "link", "must have a box, cylinder, sphere or a mass, got none")
        centre = axes @ self.centre
        moments = self._moments(axes)
        length = math.sqrt(max(6.0 * (moments[1] + moments[2] - moments[0]) / self.mass, 0.0))
        return np.array([centre - 0.5 * length, centre + 0.5 * length])

    def half_axes(self, axes: np.ndarray, start: float, end: float) -> tuple[float, float]:
        """Half-width and half-height [m] of the sections from X = start to end."""
        if self.corners:
            low, high = self.extent(axes)
            width, height = 0.5 * (high - low)[1:]
        else:
            moments = self._moments(axes)
            slender = self.mass * (end - start) ** 2 / 12.0
            height, width = (2.0 * math.sqrt(max(each - slender, 0.0) / self.mass) for each in moments[1:])
            if min(width, height) <= 0.0:  # longer than the inertia allows: round, of the same moment along it
                width = height = math.sqrt(max(2.0 * moments[0], 0.0) / self.mass)
        if not (width > 0.0 and height > 0.0):
            fail(self.element, "link", "must have a width and a height, got none")
        return float(width), float(height)

    def _moments(self, axes: np.ndarray) -> np.ndarray:
        """Moments of inertia (3,) [kg m^2] about the section axes through the centre of mass."""
        c = self.centre
        about = self.inertia - self.mass * ((c @ c) * np.eye(3) - np.outer(c, c))
        return np.asarray(np.einsum("ai,ij,aj->a", axes, about, axes))


class UrdfChain:
    """The chain below the root element of a URDF.

    Attributes:
        elements: of the links, by name.
        links, joints: from the base on; parts fixed to a link belong to it.
        notes: what the reader ignores.
    """

    def __init__(self, root: Element) -> None:
        self.elements = {name_of(each): each for each in root.all("link")}
        self.links: list[Link] = []
        self.joints: list[ChainJoint] = []
        self.notes: list[str] = []
        self._walk(root)
        if not self.joints:
            fail(root, "robot", f"must be {NEEDED}, got none")

    def _walk(self, root: Element) -> None:
        """Links and joints from the base on. What is fixed to a link is part of it."""
        children: dict[str, list[Element]] = {}
        below_another: set[str] = set()
        for joint in root.all("joint"):
            kind = joint.attributes.get("type", "")
            if kind not in (*MOVABLE, "fixed"):
                fail(joint, "joint", f"type must be revolute, continuous or fixed, got {shown(kind)}")
            parent, child = (self._end(joint, tag) for tag in ("parent", "child"))
            if child in below_another:
                fail(joint, "joint", f"child {shown(child)} has two parents")
            below_another.add(child)
            children.setdefault(parent, []).append(joint)
        bases = [name for name in self.elements if name not in below_another]
        if len(bases) != 1:
            fail(root, "robot", f"must have one link without a parent, got {shown(bases)}")
        name, pose, seen = bases[0], np.eye(4), 0
        while True:
            link = Link(self.elements[name])
            following: list[tuple[Element, np.ndarray]] = []
            todo = [(name, pose)]
            while todo:
                here, at = todo.pop()
                seen += 1
                self._add(link, self.elements[here], at)
                for joint in children.get(here, []):
                    below = at @ origin_of(joint)
                    if joint.attributes["type"] == "fixed":
                        todo.append((self._end(joint, "child"), below))
                    else:
                        following.append((joint, below))
            self.links.append(link)
            if len(following) > 1:
                fail(following[1][0], "joint", f"must be one of {NEEDED}: {shown(name)} has two that move")
            if not following:
                break
            joint, pose = following[0]
            axis = pose[:3, :3] @ self._axis(joint)
            self.joints.append(ChainJoint(joint, pose[:3, 3], axis))
            name = self._end(joint, "child")
        if seen != len(self.elements):
            fail(root, "robot", f"must be {NEEDED}: {len(self.elements) - seen} links are not part of it")

    def _axis(self, joint: Element) -> np.ndarray:
        found = joint.first("axis")
        axis = np.array([1.0, 0.0, 0.0]) if found is None else vector_of(found, "xyz", (1.0, 0.0, 0.0))
        length = float(np.linalg.norm(axis))
        if not length > 0.0:
            fail(joint, "axis", f"must have a direction, got {shown(axis.tolist())}")
        return axis / length

    def _end(self, joint: Element, tag: str) -> str:
        found = joint.first(tag)
        name = "" if found is None else found.attributes.get("link", "")
        if name not in self.elements:
            fail(joint, tag, f"must name a link, got {shown(name)}")
        return name

    def _add(self, link: Link, element: Element, pose: np.ndarray) -> None:
        """Add mass and shapes of a link at `pose` (4, 4) to `link`."""
        inertial = element.first("inertial")
        if inertial is not None:
            at = pose @ origin_of(inertial)
            mass = number_of(inertial, "mass", "value", 0.0)
            if mass < 0.0:
                fail(inertial, "mass", f"must be >= 0 kg, got {mass:g}")
            names = "ixx", "iyy", "izz", "ixy", "ixz", "iyz"
            xx, yy, zz, xy, xz, yz = (number_of(inertial, "inertia", name, 0.0) for name in names)
            inner = at[:3, :3] @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ at[:3, :3].T
            c = at[:3, 3]
            link.mass += mass
            link.moment = link.moment + mass * c
            link.inertia = link.inertia + inner + mass * ((c @ c) * np.eye(3) - np.outer(c, c))
        for shape in element.all("collision") or element.all("visual"):
            half = self._half_size(shape)
            if half is None:
                continue
            at = pose @ origin_of(shape)
            reach = np.abs(at[:3, :3]) @ half
            link.corners.append(np.array([at[:3, 3] - reach, at[:3, 3] + reach]))

    def _half_size(self, shape: Element) -> np.ndarray | None:
        """Half of the size (3,) [m] of the box around a shape; None of a mesh."""
        geometry = shape.first("geometry")
        if geometry is None or not geometry.children:
            fail(shape, shape.tag, "must have a geometry")
        form = geometry.children[0]
        if form.tag == "box":
            half = 0.5 * vector_of(form, "size", None)
        elif form.tag in ("cylinder", "capsule"):
            radius, length = (positive_of(form, name) for name in ("radius", "length"))
            half = np.array([radius, radius, 0.5 * length + (radius if form.tag == "capsule" else 0.0)])
        elif form.tag == "sphere":
            half = np.full(3, positive_of(form, "radius"))
        elif form.tag == "mesh":
            self.notes.append(f"mesh {shown(form.attributes.get('filename', ''))} is not read")
            return None
        else:
            fail(form, form.tag, "must be box, cylinder, capsule, sphere or mesh")
        if np.any(half <= 0.0):
            fail(form, form.tag, f"must have a size > 0 m, got {shown((2.0 * half).tolist())}")
        return np.asarray(half)
