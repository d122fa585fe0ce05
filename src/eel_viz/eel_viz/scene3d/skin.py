# SPDX-License-Identifier: Apache-2.0
"""The swimmer's surface: elliptic sections on the backbone, with exact normals.

A point of the surface is r(X) + b(X) cos(angle) t2 + a(X) sin(angle) t3, with b the half width (section axis 2) and a
the half height (axis 3). The normal is the gradient of (y/b)^2 + (z/a)^2 - 1 in section axes, times a b / 2:
(-(a cos^2 b' + b sin^2 a'), a cos, b sin). Half axes are interpolated in their squares, since they go like sqrt(X)
at the nose.
"""

import numpy as np

from eel_viz.scene3d import colours
from eel_viz.scene3d.centre_line import Resampling

RINGS = 20
SIDES = 12
FLANK = 0.34  # rad: half of the angle that a flank covers
OUTSIDE = 1.05  # how far a flank lies outside the skin, which has flat sides


class Surface:
    """The part of the surface between the `angles` (S,) [rad] of each ring.

    x, half_width, half_height: [m], each (B,), as in the message `BodyGeometry`. edges: pairs of neighbouring angles by
    their numbers. swell: factor of the half axes.
    """

    def __init__(
        self,
        x: np.ndarray,
        half_width: np.ndarray,
        half_height: np.ndarray,
        *,
        rings: int,
        angles: np.ndarray,
        edges: list[tuple[int, int]],
        swell: float = 1.0,
    ):
        length = float(x[-1])
        self.x = length * _graded(rings)  # [m], (rings,)
        fine = np.linspace(0.0, 1.0, 400) ** 2 * length
        width = np.sqrt(np.interp(self.x, x, np.square(half_width)))
        height = np.sqrt(np.interp(self.x, x, np.square(half_height)))
        # b b' and a a' are half the slopes of the squares, which are finite at the nose
        width_slope = np.interp(self.x, fine, np.gradient(np.interp(fine, x, np.square(half_width)), fine)) / 2
        height_slope = np.interp(self.x, fine, np.gradient(np.interp(fine, x, np.square(half_height)), fine)) / 2
        cos, sin = np.cos(angles), np.sin(angles)
        zero = np.zeros((rings, len(angles)))
        self._offset = swell * np.stack([zero, np.outer(width, cos), np.outer(height, sin)], axis=2)
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
        self.triangles = _triangles(rings, len(angles), edges)
        self._angles = angles
        self._resampling: Resampling | None = None

    def resampling(self, x: np.ndarray) -> Resampling:
        """The interpolation from stations `x` (M,) [m] to the rings; cached while the stations stay the same."""
        if self._resampling is None or not self._resampling.matches(x, self.x):
            self._resampling = Resampling(x, self.x)
        return self._resampling

    def place(self, x: np.ndarray, position: np.ndarray, orientation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Vertices [m] and normals in the world, float32 (rings * S, 3), of a backbone at stations `x` [m]."""
        return self.place_on(*self.resampling(x).centre_line(position, orientation))

    def place_on(self, points: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """As `place`, on the centre line at the rings: `points` (rings, 3) [m], `axes` (rings, 3, 3)."""
        turn = np.swapaxes(axes, 1, 2)
        vertices = points[:, None, :] + self._offset @ turn
        normals = self._normal @ turn
        return vertices.reshape(-1, 3).astype(np.float32), normals.reshape(-1, 3).astype(np.float32)

    def at_vertices(self, x: np.ndarray, values: np.ndarray) -> np.ndarray:
        """One value for each vertex, (rings * S,), from `values` at stations `x`, (M,)."""
        return np.repeat(self.resampling(x).linear(values), len(self._angles))

    @property
    def shades(self) -> np.ndarray:
        """Colours of the vertices, uint8 (V, 3): dark back (+ axis 3), light belly, so that roll shows."""
        share = np.clip(0.5 + 0.8 * np.sin(self._angles), 0.0, 1.0)[:, None]
        around = share * np.array(colours.BACK) + (1.0 - share) * np.array(colours.BELLY)
        return np.tile(around.round().astype(np.uint8), (len(self.x), 1))


class Skin(Surface):
    """The closed skin."""

    def __init__(
        self, x: np.ndarray, half_width: np.ndarray, half_height: np.ndarray, *, rings: int = RINGS, sides: int = SIDES
    ):
        angles = np.linspace(0.0, 2 * np.pi, sides, endpoint=False)
        edges = [(k, (k + 1) % sides) for k in range(sides)]
        super().__init__(x, half_width, half_height, rings=rings, angles=angles, edges=edges)
        last = (rings - 1) * sides
        fan = np.array([(last, last + k, last + k + 1) for k in range(1, sides - 1)], dtype=np.uint32)
        self.triangles = np.concatenate([self.triangles, fan])  # closes the tail


class Flanks(Surface):
    """A band along each flank, just outside the skin: a layer that a torque colours."""

    def __init__(self, x: np.ndarray, half_width: np.ndarray, half_height: np.ndarray, *, rings: int = RINGS):
        band = np.array((-FLANK, 0.0, FLANK))
        edges = [(0, 1), (1, 2), (3, 4), (4, 5)]
        angles = np.concatenate([band, np.pi + band])
        super().__init__(x, half_width, half_height, rings=rings, angles=angles, edges=edges, swell=OUTSIDE)


def _graded(rings: int) -> np.ndarray:
    """Abscissae from 0 to 1, finer at the nose: quadratic over the first rings, then even."""
    nose = max(4, rings // 6)
    start = 0.06
    return np.concatenate([start * (np.arange(nose) / nose) ** 2, np.linspace(start, 1.0, rings - nose)])


def _triangles(rings: int, sides: int, edges: list[tuple[int, int]]) -> np.ndarray:
    """Indices of the triangles between neighbouring rings, uint32 (T, 3).

    Counter-clockwise seen from outside: angles go from t2 to t3, and rings go along t1 = t2 x t3.
    """
    ring = np.arange(rings - 1)[:, None] * sides
    side, beside = np.array(edges).T
    here, next_to = ring + side, ring + beside
    quads = np.stack([here, next_to, here + sides, next_to, next_to + sides, here + sides], axis=-1)
    return quads.reshape(-1, 3).astype(np.uint32)
