# SPDX-License-Identifier: Apache-2.0
"""The head's motion for controllers: in REP-103 axes, as on the topic `odom`.

The swimmer heads for +x, y is left, z is up.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from eel_common import attitude

TURN = 2.0 * math.pi  # rad
_TURN = np.array(TURN)  # faster with arrays
MANY_TURNS = 1e9  # rad


class HeadMotion(NamedTuple):
    """Pose and twist of the head, in REP-103 axes. For N heads each field has a further axis (., N)."""

    position: np.ndarray  # (3,) m, world
    orientation: np.ndarray  # (4,) x y z w, world from head
    angular_velocity: np.ndarray  # (3,) rad/s, head's axes: about forward, left, up
    velocity: np.ndarray  # (3,) m/s, head's axes: forward, left, up

    @property
    def heading(self) -> Any:
        """Angle [rad] about the vertical, positive to the left, from -pi to pi."""
        return attitude.heading(self.orientation)

    @property
    def climb(self) -> Any:
        """Angle [rad] of the head above the horizontal."""
        return attitude.climb(self.orientation)

    @property
    def roll(self) -> Any:
        """Angle [rad] about the forward axis, positive where the right side is down, from -pi to pi."""
        return attitude.roll(self.orientation)


def wrapped(angle: Any) -> Any:
    """The `angle` [rad] wrapped to -pi to pi, element by element."""
    if type(angle) is float and abs(angle) < MANY_TURNS:  # faster
        return angle - TURN * round(angle / TURN)
    inside = angle - _TURN * np.rint(angle / _TURN)
    return inside if isinstance(inside, np.ndarray) else float(inside)
