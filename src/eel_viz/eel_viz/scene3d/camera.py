"""The camera that follows the swimmer: its motion, and its initial pose [m] in the frame `entities.FOLLOW`."""

import numpy as np

EYE = np.array((-0.40, -0.80, 0.48))
TARGET = np.array((0.03, 0.0, -0.05))


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


AHEAD = _unit(TARGET - EYE)
RIGHT = _unit(np.cross(AHEAD, (0.0, 0.0, 1.0)))
UP = np.cross(RIGHT, AHEAD)
SEEN = np.stack([RIGHT, UP, AHEAD], axis=1)  # vector @ SEEN: its components to the right, up and ahead


def before_eye(ahead: float, right: float, up: float) -> np.ndarray:
    """The point, (3,) [m], at the given distances [m] ahead of the eye, to its right and up."""
    return EYE + ahead * AHEAD + right * RIGHT + up * UP


def in_picture(points: np.ndarray) -> np.ndarray:
    """Projection of `points` (..., 3) [m] before the eye: (..., 2), tangents to the right and up from the centre."""
    seen = (np.asarray(points) - EYE) @ SEEN
    return seen[..., :2] / seen[..., 2:]


class FollowFilter:
    """Low-pass filter of a moving point x: p'' + 2 w p' + w^2 p = 2 w x' + w^2 x, critically damped.

    A steady motion is followed without lag; a quarter of an oscillation with a period of 1 s passes.
    """

    RATE = 0.8  # w [rad/s]
    JUMP = 2.0  # s without a call, after which the filter jumps to the point

    def __init__(self) -> None:
        self._stamp: int | None = None
        self.position = np.zeros(3)  # m
        self._velocity = np.zeros(3)  # m/s

    def follow(self, stamp: int, target: np.ndarray) -> np.ndarray:
        """The filtered position, (3,) [m], at `stamp` [ns], when the point is at `target`, (3,) [m]."""
        elapsed = np.inf if self._stamp is None else (stamp - self._stamp) * 1e-9
        self._stamp = stamp
        if elapsed > self.JUMP:
            self.position, self._velocity = np.array(target, dtype=float), np.zeros(3)
            return self.position
        turn, decay = self.RATE * elapsed, np.exp(-self.RATE * elapsed)
        behind = self.position - target
        # exact for a target that has been at its new place since the last call
        self.position = target + decay * ((1.0 - turn) * behind + elapsed * self._velocity)
        self._velocity = decay * (-self.RATE * turn * behind + (1.0 + turn) * self._velocity)
        return self.position
