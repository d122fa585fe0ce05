"""How a swim begins: where the head is and how it moves, and what follows from that for the run."""

import math
from typing import NamedTuple

import numpy as np
from eel_gaits.law import Law

from .frames import matrix_of

THROWN = 0.2  # periods, in which one who starts faster than a swimmer goes by its length, or turns by one


class Start(NamedTuple):
    """The head at t = 0."""

    position: np.ndarray  # (3,) m, world
    orientation: np.ndarray  # (4,) x y z w, world from head
    twist: np.ndarray  # (6,) (Omega, V) rad/s, m/s, head's axes

    def in_water(self, current: np.ndarray) -> np.ndarray:
        """Twist (6,) of the head relative to water that flows with the `current` (3,) [m/s]."""
        relative = self.twist - 0.0
        if current.any():
            relative[3:] -= matrix_of(self.orientation).T @ current
        return relative


def time_scale(twist: np.ndarray, length: float) -> float:
    """Time [s] in which a `twist` (6,) takes a body by its `length` [m], or turns it by one."""
    a, b, c, u, v, w = twist.tolist()
    speed, spin = math.hypot(u, v, w), math.hypot(a, b, c)
    return min(length / speed if speed else np.inf, 1.0 / spin if spin else np.inf)


def is_thrown(law: Law | None, scale: float) -> bool:
    """Whether one whose motion has the time `scale` [s] starts much faster than `law` swims."""
    periods = [term.period for term in law.terms if term.period] if isinstance(law, Law) else []
    return scale < THROWN * min(periods, default=1.0)


def stays_in_plane(law: Law | None, relative: np.ndarray) -> bool:
    """Whether a swim stays in the plane of the head's axes 1 and 2: the law bends in yaw alone, and the head, of the
    twist `relative` to the water, does not move out of it."""
    if law is None or not law.in_plane:
        return False
    return not (relative[0] or relative[1] or relative[5])
