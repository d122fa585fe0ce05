# SPDX-License-Identifier: Apache-2.0
"""Heading, climb and roll of a head, in REP-103 axes: x forward, y left, z up.

They are the Z-Y-X angles of the orientation, but the climb has the sign of the pitch turned. An `orientation` is a
quaternion (4,) x y z w, world from head, of any norm but 0.
"""

import math
from collections.abc import Sequence


def heading(orientation: Sequence[float]) -> float:
    """Angle [rad] from the world's x to the horizontal direction of the head's x, positive to the left, -pi to pi."""
    x, y, z, w = orientation
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def climb(orientation: Sequence[float]) -> float:
    """Angle [rad] of the head's x above the horizontal, -pi/2 to pi/2."""
    x, y, z, w = orientation
    return math.asin(max(-1.0, min(1.0, 2.0 * (x * z - w * y) / (x * x + y * y + z * z + w * w))))


def roll(orientation: Sequence[float]) -> float:
    """Angle [rad] about the head's x, positive where the right side is down, -pi to pi."""
    x, y, z, w = orientation
    return math.atan2(2.0 * (y * z + w * x), w * w - x * x - y * y + z * z)


def attitude(orientation: Sequence[float]) -> tuple[float, float, float]:
    """Heading, climb and roll [rad]."""
    return heading(orientation), climb(orientation), roll(orientation)
