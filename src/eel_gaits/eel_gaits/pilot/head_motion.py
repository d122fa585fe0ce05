# SPDX-License-Identifier: Apache-2.0
"""The head's motion as a controller sees it: in REP-103 axes, as on the topic `odom`.

The swimmer heads for +x, y is left, z is up.
"""

import math
from typing import NamedTuple

import numpy as np

from eel_base import attitude


class HeadMotion(NamedTuple):
    """Pose and twist of the head, in REP-103 axes."""

    position: np.ndarray  # (3,) m, world
    orientation: np.ndarray  # (4,) x y z w, world from head
    angular_velocity: np.ndarray  # (3,) rad/s, head's axes: about forward, left, up
    velocity: np.ndarray  # (3,) m/s, head's axes: forward, left, up

    @property
    def heading(self) -> float:
        """Angle [rad] about the vertical, positive to the left, from -pi to pi."""
        return attitude.heading(self.orientation.tolist())

    @property
    def climb(self) -> float:
        """Angle [rad] of the head above the horizontal."""
        return attitude.climb(self.orientation.tolist())

    @property
    def roll(self) -> float:
        """Angle [rad] about the forward axis, positive where the right side is down, from -pi to pi."""
        return attitude.roll(self.orientation.tolist())


def wrapped(angle: float) -> float:
    """The `angle` [rad] from -pi to pi."""
    return math.remainder(angle, 2.0 * math.pi)
