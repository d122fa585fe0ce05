# SPDX-License-Identifier: Apache-2.0
"""Triangles between rows of vertices; turns of the world's up, as quaternions x, y, z, w."""

import numpy as np


def turns_of_up_into(directions: np.ndarray) -> np.ndarray:
    """Quaternions (n, 4) x y z w that turn the world's axis 3 into unit vectors (n, 3), by the shortest way."""
    x, y, z = directions.T
    turns = np.stack((-y, x, np.zeros_like(x), 1.0 + z), axis=1)
    turns[z < -1.0 + 1e-9] = (1.0, 0.0, 0.0, 0.0)  # straight down, every way is as short
    return np.asarray(turns / np.linalg.norm(turns, axis=1)[:, None])


def tiles(along: int, across: int) -> np.ndarray:
    """Indices of the triangles, (T, 3), between `along` rows of `across` vertices."""
    here = (np.arange(along - 1)[:, None] * across + np.arange(across - 1)).reshape(-1, 1)
    return np.asarray(here + np.array((0, across, across + 1, 0, across + 1, 1))).reshape(-1, 3)
