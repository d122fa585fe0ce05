# SPDX-License-Identifier: Apache-2.0
"""Frames of REP-103: frame ids below a namespace, and the heading of an orientation."""

import math
from collections.abc import Sequence


def frame_in(namespace: str, frame: str) -> str:
    """`frame` below the `namespace` of a node, such as eel1/odom; without a leading slash, which tf2 refuses.

    So two robots in two namespaces do not share a frame.
    """
    return f"{namespace}/{frame}".strip("/")


def heading(orientation: Sequence[float]) -> float:
    """Angle [rad] from the world's x to the horizontal direction of the head's x, positive to the left.

    orientation: (4,) x y z w, world from head; of any norm but 0.
    """
    x, y, z, w = orientation
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)
