# SPDX-License-Identifier: Apache-2.0
"""The cameras: frames that keep the swimmer in the picture, and the eye in front of them.

The eye of every view is fixed in its frame, at `EYE` from the origin, and looks at the origin. A frame has a place in
the world, its centre, and a scale, its radius [m]. The radius is chosen so that all that must be seen lies in `CLEAR`,
the part of the picture without legend. So the eye steps back if the swimmer needs more room, and swimmers of all
lengths fill the picture equally. Each view must be at least `LEAST_ASPECT` times as wide as high.
"""

import numpy as np

FIELD_OF_VIEW = np.radians(55.0)  # vertical; Rerun's default
EYE_FROM = np.array((-0.43, -0.80, 0.53))  # direction of the eye, from the origin
LEAST_ASPECT = 1.3
CLOSE = 0.36  # least radius of a frame [body lengths]
RELEASE = 2.5  # s: time constant of a shrinking frame


def _unit(vector: np.ndarray) -> np.ndarray:
    return np.asarray(vector / np.linalg.norm(vector))


EYE = _unit(EYE_FROM) / np.sin(FIELD_OF_VIEW / 2)  # radii: the unit sphere touches the picture's upper and lower edge
FORWARD = _unit(-EYE)
RIGHT = _unit(np.cross(FORWARD, (0.0, 0.0, 1.0)))
UP = np.cross(RIGHT, FORWARD)
SEEN = np.stack([RIGHT, UP, FORWARD], axis=1)  # vector @ SEEN: its components to the right, up and ahead
EDGE = np.tan(FIELD_OF_VIEW / 2)  # tangent of the picture's upper edge
CLEAR = {"right": 0.88 * LEAST_ASPECT * EDGE, "up": 0.86 * EDGE, "down": 0.70 * EDGE}  # tangents; left as right


def before_eye(ahead: float, right: float, up: float) -> np.ndarray:
    """The point, (3,) [radii], at these distances [radii] ahead of the eye, to its right and up."""
    return np.asarray(EYE + ahead * FORWARD + right * RIGHT + up * UP)


def in_picture(points: np.ndarray) -> np.ndarray:
    """Projection of `points` (..., 3) [radii]: (..., 2), tangents to the right and up from the picture's centre."""
    seen = (np.asarray(points) - EYE) @ SEEN
    return np.asarray(seen[..., :2] / seen[..., 2:])


def least_radius(points: np.ndarray) -> float:
    """The least radius of a frame in which `points` (N, 3) [m], relative to its centre, lie in `CLEAR`.

    A point is seen at the tangent right / (D radius + ahead), with D the eye's distance: linear in the radius.
    """
    right, up, ahead = (np.asarray(points) @ SEEN).T
    wanted = np.abs(right) / CLEAR["right"], up / CLEAR["up"], -up / CLEAR["down"]
    return float((np.max(wanted, axis=0) - ahead).max() / np.linalg.norm(EYE))


class FollowFilter:
    """Low-pass filter of a moving point x: p'' + 2 w p' + w^2 p = 2 w x' + w^2 x, critically damped.

    A steady motion is followed without lag. A quarter of an oscillation with a period of 1 s passes.
    """

    RATE = 0.8  # w [rad/s]
    JUMP = 2.0  # s without a call: the filter jumps to the point, as it does when time goes back

    def __init__(self) -> None:
        self._stamp: int | None = None
        self.position = np.zeros(3)  # m
        self.velocity = np.zeros(3)  # m/s

    def follow(self, stamp: int, target: np.ndarray) -> np.ndarray:
        """The filtered position, (3,) [m], at `stamp` [ns], when the point is at `target`, (3,) [m]."""
        elapsed = np.inf if self._stamp is None else (stamp - self._stamp) * 1e-9
        self._stamp = stamp
        if abs(elapsed) > self.JUMP:
            self.position, self.velocity = np.array(target, dtype=float), np.zeros(3)
            return self.position
        turn, decay = self.RATE * elapsed, np.exp(-self.RATE * elapsed)
        behind = self.position - target
        # exact for a target that has been at its new place since the last call
        self.position = target + decay * ((1.0 - turn) * behind + elapsed * self.velocity)
        self.velocity = decay * (-self.RATE * turn * behind + (1.0 + turn) * self.velocity)
        return self.position


class FollowFrame:
    """The frame that moves with one swimmer or two without turning. It grows at once, and shrinks slowly."""

    def __init__(self) -> None:
        self.filter = FollowFilter()
        self._last: tuple[int, float] | None = None  # ns, m

    def follow(self, stamp: int, positions: np.ndarray, length: float) -> tuple[np.ndarray, float]:
        """Centre (3,) and radius [m] at `stamp` [ns].

        positions: (N, 3) [m] in the world, of everything that must be seen. length: of the body [m].
        """
        middle = self.filter.follow(stamp, positions.mean(axis=0))
        radius = least = max(CLOSE * length, least_radius(positions - middle))
        if self._last is not None and stamp >= self._last[0]:
            kept = np.exp((self._last[0] - stamp) * 1e-9 / RELEASE)
            radius = max(least, float(least + kept * (self._last[1] - least)))
        self._last = stamp, radius
        return middle, radius


class PathFrame:
    """The growing frame around all places of the body so far."""

    def __init__(self) -> None:
        self._low, self._high = np.full(3, np.inf), np.full(3, -np.inf)

    def include(self, positions: np.ndarray, length: float) -> tuple[np.ndarray, float]:
        """Include the `positions` (N, 3) [m] of a body of `length` [m]. Returns centre (3,) and radius [m]."""
        np.minimum(self._low, positions.min(axis=0), out=self._low)
        np.maximum(self._high, positions.max(axis=0), out=self._high)
        middle = (self._low + self._high) / 2
        corners = np.stack(np.meshgrid(*zip(self._low, self._high, strict=True)), axis=-1).reshape(-1, 3)
        return middle, max(CLOSE * length, least_radius(corners - middle))
