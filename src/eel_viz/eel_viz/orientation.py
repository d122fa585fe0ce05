"""Quaternions to axes. Quaternions are x, y, z, w; body axes are REP-103 (x forward, y left, z up).

The section axes of the messages differ from them by half a turn about z: 1 = -x, 2 = -y, 3 = +z.
"""

import numpy as np


def world_from_body(orientation: np.ndarray) -> np.ndarray:
    """Rotation matrices of unit quaternions `orientation`, shape (..., 4); returns (..., 3, 3), columns = body axes."""
    x, y, z, w = np.moveaxis(np.asarray(orientation, dtype=float), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def world_from_section(orientation: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Turn `vectors`, shape (..., 3) in section axes, into the world; `orientation` (..., 4) are the REP-103 axes."""
    return np.einsum("...ij,...j->...i", world_from_body(orientation), np.asarray(vectors) * (-1.0, -1.0, 1.0))


def attitude(orientation: np.ndarray) -> tuple[float, float, float]:
    """Heading, pitch, roll [rad] of one unit quaternion: yaw about z (0 = +x, positive to the left), pitch positive
    nose up, roll positive right side down (Z-Y-X angles, pitch with the sign turned)."""
    matrix = world_from_body(orientation)
    heading = np.arctan2(matrix[1, 0], matrix[0, 0])
    pitch = np.arcsin(np.clip(matrix[2, 0], -1.0, 1.0))
    roll = np.arctan2(matrix[2, 1], matrix[2, 2])
    return float(heading), float(pitch), float(roll)
