"""The camera that follows the swimmer: how it moves, and how it stands before a user moves it, in the frame
`entities.FOLLOW`, metres.
"""

import numpy as np

EYE = np.array((-0.40, -0.80, 0.48))
TARGET = np.array((0.03, 0.0, -0.05))


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


AHEAD = _unit(TARGET - EYE)
RIGHT = _unit(np.cross(AHEAD, (0.0, 0.0, 1.0)))
UP = np.cross(RIGHT, AHEAD)
SEEN = np.stack([RIGHT, UP, AHEAD], axis=1)  # right, up and ahead of a vector


def before_eye(ahead: float, right: float, up: float) -> np.ndarray:
    """The point, (3,) [m], that lies so far ahead of the eye, to its right and up."""
    return EYE + ahead * AHEAD + right * RIGHT + up * UP


def in_picture(points: np.ndarray) -> np.ndarray:
    """Where `points` (..., 3) [m] before the eye are seen: (..., 2), tangents to the right and up from the centre."""
    seen = (np.asarray(points) - EYE) @ SEEN
    return seen[..., :2] / seen[..., 2:]


class Steady:
    """A point that follows another without its wiggle: p'' + 2 w p' + w^2 p = 2 w x' + w^2 x, critically damped.

    It has no lag behind a steady motion, and keeps a quarter of a sway of one second.
    """

    RATE = 0.8  # w [rad/s]
    JUMP = 2.0  # s without news, after which it goes straight to the point

    def __init__(self) -> None:
        self._stamp: int | None = None
        self.position = np.zeros(3)  # m
        self._velocity = np.zeros(3)  # m/s

    def follow(self, stamp: int, target: np.ndarray) -> np.ndarray:
        """The position, (3,) [m], at `stamp` [ns], when the point is at `target`, (3,) [m]."""
        elapsed = np.inf if self._stamp is None else (stamp - self._stamp) * 1e-9
        self._stamp = stamp
        if elapsed > self.JUMP:
            self.position, self._velocity = np.array(target, dtype=float), np.zeros(3)
            return self.position
        turn, decay = self.RATE * elapsed, np.exp(-self.RATE * elapsed)
        behind = self.position - target
        # exact for a target that has stood at its new place since the last call
        self.position = target + decay * ((1.0 - turn) * behind + elapsed * self._velocity)
        self._velocity = decay * (-self.RATE * turn * behind + (1.0 + turn) * self._velocity)
        return self.position
