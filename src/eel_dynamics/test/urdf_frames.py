# SPDX-License-Identifier: Apache-2.0
"""Reads a URDF with the standard library alone: places of its links at given angles, and their masses."""

from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np


class LinkMass(NamedTuple):
    """Mass [kg], centre of mass (3,) [m] and inertia (3, 3) [kg m^2] about it, in the base link's axes."""

    mass: float
    centre: np.ndarray
    inertia: np.ndarray


def vector(element, key):
    return np.array([float(word) for word in element.get(key).split()])


def turned(axis, angle):
    """Rodrigues' formula: (3, 3)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def frames(text, angles, base=None):
    """Poses (4, 4) of all links, by name, at the `angles` [rad] by joint; `base`: that of the base link."""
    root = ElementTree.fromstring(text)
    children = {joint.find("child").get("link") for joint in root.findall("joint")}
    (first,) = {link.get("name") for link in root.findall("link")} - children
    poses = {first: np.eye(4) if base is None else base}
    for joint in root.findall("joint"):  # the parent comes before its child
        own = np.eye(4)
        own[:3, 3] = vector(joint.find("origin"), "xyz")
        if joint.get("type") != "fixed":
            own[:3, :3] = turned(vector(joint.find("axis"), "xyz"), angles[joint.get("name")])
        poses[joint.find("child").get("link")] = poses[joint.find("parent").get("link")] @ own
    return poses


def masses(text):
    """The `LinkMass` of each link that has one, at angles of 0, by name."""
    root, found = ElementTree.fromstring(text), {}
    none = {joint.get("name"): 0.0 for joint in root.findall("joint")}
    poses = frames(text, none)
    for link in root.findall("link"):
        if (inertial := link.find("inertial")) is not None:
            given = inertial.find("inertia").attrib
            xx, yy, zz, xy, xz, yz = (float(given[key]) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
            centre = poses[link.get("name")][:3, 3] + vector(inertial.find("origin"), "xyz")
            matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            found[link.get("name")] = LinkMass(float(inertial.find("mass").get("value")), centre, matrix)
    return found
