"""The camera that follows the swimmer, as it stands before a user moves it; in the frame `entities.FOLLOW`, metres."""

import numpy as np

EYE = np.array((-0.46, -0.92, 0.55))
TARGET = np.array((0.03, 0.0, -0.05))


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


AHEAD = _unit(TARGET - EYE)
RIGHT = _unit(np.cross(AHEAD, (0.0, 0.0, 1.0)))
UP = np.cross(RIGHT, AHEAD)


def before_eye(ahead: float, right: float, up: float) -> np.ndarray:
    """The point, (3,) [m], that lies so far ahead of the eye, to its right and up."""
    return EYE + ahead * AHEAD + right * RIGHT + up * UP


def in_picture(points: np.ndarray) -> np.ndarray:
    """Where `points` (..., 3) [m] before the eye are seen: (..., 2), tangents to the right and up from the centre."""
    ray = np.asarray(points) - EYE
    return np.stack([ray @ RIGHT, ray @ UP], axis=-1) / (ray @ AHEAD)[..., None]
