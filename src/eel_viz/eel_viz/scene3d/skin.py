"""The swimmer's skin: elliptic sections on the backbone, as one closed triangle mesh with exact normals.

A point of the skin is r(X) + b(X) cos(angle) t2 + a(X) sin(angle) t3, with b the half width (section axis 2) and a the
half height (axis 3). The normal is the gradient of (y/b)^2 + (z/a)^2 - 1 in section axes, times a b / 2:
(-(a cos^2 b' + b sin^2 a'), a cos, b sin). Half axes are interpolated in their squares, since they go like sqrt(X)
at the nose.
"""

import numpy as np

from eel_viz.scene3d.centre_line import Resampling

RINGS = 20
SIDES = 12


class Skin:
    """The mesh of one body. `x`, `half_width`, `half_height` [m], each (B,), as in the message `BodyGeometry`."""

    def __init__(
        self, x: np.ndarray, half_width: np.ndarray, half_height: np.ndarray, *, rings: int = RINGS, sides: int = SIDES
    ):
        length = float(x[-1])
        self.x = length * _graded(rings)  # [m], (rings,)
        fine = np.linspace(0.0, 1.0, 400) ** 2 * length
        width = np.sqrt(np.interp(self.x, x, np.square(half_width)))
        height = np.sqrt(np.interp(self.x, x, np.square(half_height)))
        # b b' and a a' are half the slopes of the squares, which are finite at the nose
        width_slope = np.interp(self.x, fine, np.gradient(np.interp(fine, x, np.square(half_width)), fine)) / 2
        height_slope = np.interp(self.x, fine, np.gradient(np.interp(fine, x, np.square(half_height)), fine)) / 2
        angle = np.linspace(0.0, 2 * np.pi, sides, endpoint=False)
        cos, sin = np.cos(angle), np.sin(angle)
        zero = np.zeros((rings, sides))
        self._offset = np.stack([zero, np.outer(width, cos), np.outer(height, sin)], axis=2)
        b, a = np.maximum(width, 1e-6), np.maximum(height, 1e-6)
        normal = np.stack(
            [
                -(np.outer(a / b * width_slope, cos**2) + np.outer(b / a * height_slope, sin**2)),
                np.outer(a, cos),
                np.outer(b, sin),
            ],
            axis=2,
        )
        normal[0] = (-1.0, 0.0, 0.0)
        self._normal = normal / np.linalg.norm(normal, axis=2, keepdims=True)
        self.triangles = _triangles(rings, sides)
        self._sides = sides
        self._resampling: Resampling | None = None

    def resampling(self, x: np.ndarray) -> Resampling:
        """The interpolation from stations `x` (M,) [m] to the rings; cached while the stations stay the same."""
        if self._resampling is None or not self._resampling.matches(x, self.x):
            self._resampling = Resampling(x, self.x)
        return self._resampling

    def place(self, x: np.ndarray, position: np.ndarray, orientation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Vertices [m] and normals in the world, float32 (rings * sides, 3), of a backbone at stations `x` [m]."""
        points, axes = self.resampling(x).centre_line(position, orientation)
        turn = np.swapaxes(axes, 1, 2)
        vertices = points[:, None, :] + self._offset @ turn
        normals = self._normal @ turn
        return vertices.reshape(-1, 3).astype(np.float32), normals.reshape(-1, 3).astype(np.float32)

    def spread(self, x: np.ndarray, values: np.ndarray) -> np.ndarray:
        """One value for each vertex, (rings * sides,), from `values` at stations `x`, (M,)."""
        return np.repeat(self.resampling(x).linear(values), self._sides)


def _graded(rings: int) -> np.ndarray:
    """Abscissae from 0 to 1, finer at the nose: quadratic over the first rings, then even."""
    nose = max(4, rings // 6)
    start = 0.06
    return np.concatenate([start * (np.arange(nose) / nose) ** 2, np.linspace(start, 1.0, rings - nose)])


def _triangles(rings: int, sides: int) -> np.ndarray:
    """Indices of the triangles between neighbouring rings, and of the fan that closes the tail, uint32 (T, 3).

    Counter-clockwise seen from outside: angles go from t2 to t3, and rings go along t1 = t2 x t3.
    """
    ring, side = np.meshgrid(np.arange(rings - 1), np.arange(sides), indexing="ij")
    here = ring * sides + side
    beside = ring * sides + (side + 1) % sides
    quads = np.stack([here, beside, here + sides, beside, beside + sides, here + sides], axis=-1).reshape(-1, 3)
    last = (rings - 1) * sides
    fan = [(last, last + k, last + k + 1) for k in range(1, sides - 1)]
    return np.concatenate([quads, fan]).astype(np.uint32)
