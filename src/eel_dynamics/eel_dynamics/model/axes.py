# SPDX-License-Identifier: Apache-2.0
"""The two sets of axes, and the half turn about z between them.

Library (the paper's) axes: at rest the body lies along +x from the head and swims towards -x.
ROS (REP-103) axes: the eel swims towards +x, y is left, z up. A half turn about z takes each set into the other. It is
applied to the world and to every section alike, where a function does not say otherwise: such a function is its own
inverse.
"""

import numpy as np
from numpy.typing import ArrayLike

VECTOR, QUATERNION = np.array([-1.0, -1.0, 1.0]), np.array([-1.0, -1.0, 1.0, 1.0])


def turn_vector(vector: ArrayLike) -> np.ndarray:
    """Components (-x, -y, z) of `vector`, shape (..., 3), in the other set of axes. Its own inverse."""
    return np.asarray(vector, dtype=float) * VECTOR


def turn_quaternion(quaternion: ArrayLike) -> np.ndarray:
    """Orientation `quaternion`, shape (..., 4), order x y z w, in the other set of axes. Its own inverse.

    The axes of the world and of the body are both turned: R -> Q R Q^T with Q = diag(-1, -1, 1).
    """
    return np.asarray(quaternion, dtype=float) * QUATERNION


def turn_world(quaternion: np.ndarray) -> np.ndarray:
    """Orientation `quaternion`, shape (..., 4), order x y z w, with the axes of the world turned and the body's kept.

    R -> Q R: the unit quaternion of Q, half a turn about z, times `quaternion`.
    """
    x, y, z, w = np.moveaxis(np.asarray(quaternion, dtype=float), -1, 0)
    return np.stack([-y, x, w, -z], axis=-1)
