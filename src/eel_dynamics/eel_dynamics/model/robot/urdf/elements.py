# SPDX-License-Identifier: Apache-2.0
"""Numbers, poses and errors of the elements of a URDF."""

import math
from typing import NoReturn

import numpy as np
from eel_common.files.input_file import Misplaced, is_number
from eel_common.files.xml_tree import Element
from eel_common.wording import shown

LARGEST = UNLIMITED = 1e6  # of a number of the file, in its SI unit; of an effort or a velocity: none


def name_of(element: Element) -> str:
    name = element.attributes.get("name", "")
    if not name:
        fail(element, element.tag, "must have a name")
    return name


def origin_of(element: Element) -> np.ndarray:
    """The pose (4, 4) in the element's origin."""
    from scipy.spatial.transform import Rotation

    origin, pose = element.first("origin"), np.eye(4)
    if origin is not None:
        pose[:3, 3] = vector_of(origin, "xyz", (0.0, 0.0, 0.0))
        pose[:3, :3] = Rotation.from_euler("xyz", vector_of(origin, "rpy", (0.0, 0.0, 0.0))).as_matrix()
    return pose


def vector_of(element: Element, key: str, default: tuple[float, float, float] | None) -> np.ndarray:
    text = element.attributes.get(key)
    if text is None:
        if default is None:
            fail(element, element.tag, f"must have the attribute {key}")
        return np.array(default)
    words = text.split()
    if len(words) != 3:
        fail(element, element.tag, f"{key} must be three numbers, got {shown(text)}")
    return np.array([float_of(element, key, word) for word in words])


def number_of(parent: Element, tag: str, key: str, default: float) -> float:
    """The number in the attribute `key` of the child `tag`."""
    found = parent.first(tag)
    if found is None or key not in found.attributes:
        return default
    return float_of(found, key, found.attributes[key])


def positive_of(element: Element, key: str) -> float:
    value = float_of(element, key, element.attributes.get(key, ""))
    if not value > 0.0:
        fail(element, element.tag, f"{key} must be > 0 m, got {value:g}")
    return value


def float_of(element: Element, key: str, text: str) -> float:
    value = float(text) if is_number(text) else math.nan
    if not abs(value) <= LARGEST:
        fail(element, element.tag, f"{key} must be a number of at most {LARGEST:g} in size, got {shown(text)}")
    return value


def fail(element: Element, tag: str, reason: str) -> NoReturn:
    name = element.attributes.get("name", "")
    raise Misplaced(f"line {element.line}, {tag}{f' of {shown(name)}' if name else ''}", reason)
