# SPDX-License-Identifier: Apache-2.0
"""Points around a swimmer at which a flow is shown: multiples of a spacing, so that they stand still in the world."""

import numpy as np

from eel_model.flow.flow import Flow

SPACINGS = 6.0  # in a body's length
REACH = np.array([8, 6, 3])  # spacings to each side, along x, y and z


def lattice_around(place: np.ndarray, length: float, flow: Flow) -> np.ndarray:
    """Points (n, 3) [m] around a `place` (3,) [m] of a body of this `length` [m].

    They lie in a horizontal sheet at the place's height; an upright one along x crosses it where the flow changes with
    the height. Their number depends on the flow alone.
    """
    spacing = length / SPACINGS
    middle = np.round(np.asarray(place) / spacing)
    x, y, z = (np.arange(-reach, reach + 1) for reach in REACH)
    level = np.stack(np.meshgrid(x, y, [0], indexing="ij"), axis=-1).reshape(-1, 3)
    upright = np.stack(np.meshgrid(x, [0], z[z != 0], indexing="ij"), axis=-1).reshape(-1, 3)
    return np.asarray(spacing * (middle + (level if flow.in_plane else np.concatenate([level, upright]))))


def velocities_at(flow: Flow, points: np.ndarray, time: float) -> np.ndarray:
    """Velocities (n, 3) [m/s] at the `points` at `time` [s]; 0 where they are not known."""
    velocity: np.ndarray = np.nan_to_num(flow.rows_at(points, time)[..., 3:6], nan=0.0)
    return velocity
