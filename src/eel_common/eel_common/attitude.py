# SPDX-License-Identifier: Apache-2.0
"""An orientation as angles and as a matrix, in REP-103 axes: x forward, y left, z up.

Heading, climb and roll are the Z-Y-X angles, with the sign of the pitch reversed for the climb. Each takes a quaternion
(4,) x y z w, world from head, of any norm but 0. Quaternions (4, N) of N heads give angles (N,).
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from eel_common.wording import shown

ROUND_OFF = 1e-15  # of the norm of a normalised quaternion
ROUNDED = 1e-3  # of the norm: a quaternion rounded to few digits is accepted, and normalised


def unit_quaternion(name: str, values: Sequence[float]) -> tuple[float, ...]:
    """`values` (x, y, z, w) normalised. `ValueError` names `name` where the norm differs from 1 by over `ROUNDED`.

    A quaternion that is normalised to the last digit stays as it is.
    """
    norm = math.hypot(*values)
    if not abs(norm - 1.0) <= ROUNDED:
        raise ValueError(f"{name} must be a unit quaternion, got {shown(list(values))} of norm {norm:.6g}")
    return tuple(values) if abs(norm - 1.0) <= ROUND_OFF else tuple(value / norm for value in values)


def heading(orientation: Sequence[float] | np.ndarray) -> Any:
    """Angle [rad] from the world's x to the horizontal direction of the head's x, positive to the left, -pi to pi."""
    x, y, z, w = components(orientation)
    return _plain(np.arctan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z))


def climb(orientation: Sequence[float] | np.ndarray) -> Any:
    """Angle [rad] of the head's x above the horizontal, -pi/2 to pi/2."""
    x, y, z, w = components(orientation)
    sine = 2.0 * (x * z - w * y) / (x * x + y * y + z * z + w * w)
    return _plain(np.arcsin(np.maximum(-1.0, np.minimum(1.0, sine))))


def roll(orientation: Sequence[float] | np.ndarray) -> Any:
    """Angle [rad] about the head's x, positive where the right side is down, -pi to pi."""
    x, y, z, w = components(orientation)
    return _plain(np.arctan2(2.0 * (y * z + w * x), w * w - x * x - y * y + z * z))


def components(orientation: Sequence[float] | np.ndarray) -> Any:
    """The components of one quaternion or vector as floats, which are faster; of N as rows (N,)."""
    if isinstance(orientation, np.ndarray) and orientation.ndim == 1:
        return orientation.tolist()
    return orientation


def _plain(angle: Any) -> Any:
    """The angle as a Python float where it is a NumPy scalar."""
    return angle if isinstance(angle, np.ndarray) else float(angle)


def attitude(orientation: Sequence[float]) -> tuple[float, float, float]:
    """Heading, climb and roll [rad]."""
    return heading(orientation), climb(orientation), roll(orientation)


def product(first: Sequence[Any], second: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
    """The product of two quaternions x y z w: world from b, of world from a (`first`) and a from b (`second`).

    A component is a float or an array.
    """
    (x, y, z, w), (a, b, c, d) = first, second
    return (
        w * a + x * d + y * c - z * b,
        w * b + y * d + z * a - x * c,
        w * c + z * d + x * b - y * a,
        w * d - x * a - y * b - z * c,
    )


def world_from_body(orientation: np.ndarray) -> np.ndarray:
    """Rotation matrices of unit quaternions `orientation`, shape (..., 4); returns (..., 3, 3), columns = body axes."""
    x, y, z, w = np.moveaxis(np.asarray(orientation, dtype=float), -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def section_axes(orientation: np.ndarray) -> np.ndarray:
    """The section axes 1, 2, 3 in the world, as columns (..., 3, 3). orientation: (..., 4), of the sections.

    They are -x (towards the tail), -y and +z of the section turned as the head.
    """
    return world_from_body(orientation) * (-1.0, -1.0, 1.0)


def world_from_section(orientation: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Turn `vectors` (..., 3) from section axes into world axes. orientation: (..., 4), of the sections."""
    return np.asarray((section_axes(orientation) @ np.asarray(vectors)[..., None])[..., 0])
