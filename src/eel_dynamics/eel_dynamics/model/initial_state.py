# SPDX-License-Identifier: Apache-2.0
"""The initial state of the head, and quantities that follow from its velocity."""

import math
from typing import NamedTuple

import numpy as np
from eel_common.attitude import unit_quaternion, world_from_body
from eel_common.head_motion import HeadMotion
from eel_common.quantity import checked_row
from eel_common.wording import shown
from numpy.typing import ArrayLike


class InitialState(NamedTuple):
    """The head at t = 0."""

    position: np.ndarray  # (3,) m, world
    orientation: np.ndarray  # (4,) x y z w, world from head
    twist: np.ndarray  # (6,) (Omega, V) rad/s, m/s, head's axes

    def in_water(self, current: np.ndarray) -> np.ndarray:
        """Twist (6,) of the head relative to water with the velocity `current` (3,) [m/s]."""
        return self.against_water(-current).twist.copy()

    def against_water(self, current: np.ndarray) -> "InitialState":
        """The state relative to the world, from one whose twist is relative to water with the velocity `current`
        (3,)."""
        if not current.any():
            return self
        twist = self.twist.copy()
        twist[3:] += world_from_body(self.orientation).T @ current
        return self._replace(twist=twist)


AT_REST = InitialState(np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6))


def head_motion_of(head: InitialState) -> HeadMotion:
    """The motion of a simulation's `head`, as on the topic `odom`: so a controller for it can also drive the node."""
    return HeadMotion(head.position, head.orientation, head.twist[:3], head.twist[3:])


def level_orientation(heading: float) -> tuple[float, float, float, float]:
    """The orientation (x, y, z, w) of a level head with this `heading` [rad]."""
    return 0.0, 0.0, math.sin(0.5 * heading), math.cos(0.5 * heading)


def time_scale(twist: np.ndarray, length: float) -> float:
    """The shorter of the times [s] in which a `twist` (6,) moves a body by its `length` [m] or turns it by 1 rad."""
    a, b, c, u, v, w = twist.tolist()
    speed, spin = math.hypot(u, v, w), math.hypot(a, b, c)
    return min(length / speed if speed else np.inf, 1.0 / spin if spin else np.inf)


def checked_state(planar: bool, position: ArrayLike, orientation: ArrayLike, twist: ArrayLike) -> InitialState:
    """The state from these arguments of `Simulation`. `ValueError` if a `planar` scene does not allow it."""
    place, turn = checked_row("position", position, 3), checked_row("orientation", orientation, 4).tolist()
    quaternion, motion = unit_quaternion("orientation", turn), checked_row("twist", twist, 6)
    if planar:
        x, y, _, _ = quaternion
        if abs(x) > 1e-12 or abs(y) > 1e-12:
            raise ValueError(f"orientation must be a turn about z in a planar scene, got {shown(list(quaternion))}")
        roll, pitch, _, _, _, heave = rates = motion.tolist()
        if roll or pitch or heave:
            raise ValueError(
                f"twist must lie in the plane of a planar scene (Omega_1 = Omega_2 = V_3 = 0), got {shown(rates)}"
            )
    return InitialState(place, np.array(quaternion), motion)
