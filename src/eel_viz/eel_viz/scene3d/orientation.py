# SPDX-License-Identifier: Apache-2.0
"""Converts quaternions to axes. Quaternions are x, y, z, w; body axes are REP-103 (x forward, y left, z up).

The section axes of the messages differ from them by half a turn about z: 1 = -x, 2 = -y, 3 = +z.
"""

import numpy as np
from eel_base.attitude import world_from_body


def world_from_section(orientation: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Rotate `vectors`, shape (..., 3), from section axes to the world; `orientation` (..., 4): of the REP-103 axes."""
    body_axes = np.asarray(vectors) * (-1.0, -1.0, 1.0)
    return np.asarray(np.einsum("...ij,...j->...i", world_from_body(orientation), body_axes))


def turns_of_up_into(directions: np.ndarray) -> np.ndarray:
    """Quaternions (n, 4) x y z w that turn the world's axis 3 into unit vectors (n, 3), by the shortest way."""
    x, y, z = directions.T
    turns = np.stack((-y, x, np.zeros_like(x), 1.0 + z), axis=1)
    turns[z < -1.0 + 1e-9] = (1.0, 0.0, 0.0, 0.0)  # straight down, every way is as short
    return np.asarray(turns / np.linalg.norm(turns, axis=1)[:, None])
