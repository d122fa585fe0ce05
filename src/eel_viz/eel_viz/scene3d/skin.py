# SPDX-License-Identifier: Apache-2.0
"""The swimmer's surface: elliptic sections on the backbone, with exact normals.

A point of the surface is r(X) + b(X) cos(angle) t2 + a(X) sin(angle) t3, with b the half width (section axis 2) and a
the half height (axis 3). The normal is the gradient of (y/b)^2 + (z/a)^2 - 1 in section axes, times a b / 2:
(-(a cos^2 b' + b sin^2 a'), a cos, b sin). Half axes are interpolated in their squares, as they behave like sqrt(X) at
the nose. If the body ends blunt, the skin is rounded within the last half height: it is nowhere wider than the body,
nor longer.
"""

import numpy as np

from eel_viz.scene3d import colours
from eel_viz.scene3d.centre_line import Resampling

RINGS = 26
SIDES = 12
NOSE, TAIL = 0.06, 0.04  # shares of the length with finer rings
FLANK = 0.6  # sine of the greatest angle that is coloured fully
EYE_AT, EYE_HEIGHT = 0.04, 0.34  # eyes: X [lengths], and height above the middle [half heights]
EYE_DEPTH = 0.06  # depth of their middle in the skin [half heights]
EYE_SIZES = np.array(((0.32, 0.08, 0.32), (0.20, 0.095, 0.20)))  # half axes of iris and pupil [half heights]


class Skin:
    """The closed skin of `rings` rings with `sides` vertices.

    x, half_width, half_height: [m], each (B,), as in the message `BodyGeometry`.

    Attributes:
        x, half_width: of the rings [m], (rings,). triangles: indices of vertices, uint32 (T, 3).
        shades: colours of the vertices without torque, uint8 (V, 3): dark back (+ axis 3), light belly, to show roll.
        eyes, eye_sizes: middles and half axes [m] of iris and pupil on both sides, each (4, 3), in the nose's REP-103
            axes.
    """

    def __init__(
        self, x: np.ndarray, half_width: np.ndarray, half_height: np.ndarray, *, rings: int = RINGS, sides: int = SIDES
    ):
        length = float(x[-1])
        self.x = length * _graded(rings)  # [m], (rings,)
        fine = length * np.sin(np.linspace(0.0, np.pi / 2, 800)) ** 2
        rounded = max(float(half_height[-1]), 1e-9)  # m: length of the rounded tail

        def axis(half: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            """Half axis b and b b' at the rings: half the slope of the square, which is finite at both ends."""
            at_rings, squares = (
                np.interp(at, x, np.square(half)) * (1.0 - np.maximum(0.0, (at - length) / rounded + 1.0) ** 2)
                for at in (self.x, fine)
            )
            return np.sqrt(at_rings), np.interp(self.x, fine, np.gradient(squares, fine)) / 2

        (width, width_slope), (height, height_slope) = axis(half_width), axis(half_height)
        angles = np.linspace(0.0, 2 * np.pi, sides, endpoint=False)
        cos, sin = np.cos(angles), np.sin(angles)
        self.half_width = width
        self._offset = np.stack([np.zeros((rings, sides)), np.outer(width, cos), np.outer(height, sin)], axis=2)
        b, a = np.maximum(width, 1e-6), np.maximum(height, 1e-6)
        slopes = -(np.outer(a / b * width_slope, cos**2) + np.outer(b / a * height_slope, sin**2))
        normal = np.stack([slopes, np.outer(a, cos), np.outer(b, sin)], axis=2)
        normal[0], normal[-1] = (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)
        self._normal = normal / np.linalg.norm(normal, axis=2, keepdims=True)
        self.triangles = _triangles(rings, sides)
        self._sides = sides
        self._flank = np.tile(np.abs(sin) < FLANK, rings)
        back = np.clip(0.5 + 0.8 * sin, 0.0, 1.0)[:, None]
        around = back * np.array(colours.BACK) + (1.0 - back) * np.array(colours.BELLY)
        self.shades = np.tile(around.round().astype(np.uint8), (rings, 1))
        at = EYE_AT * length
        side, up = (float(np.sqrt(np.interp(at, x, np.square(half)))) for half in (half_width, half_height))
        outwards = side * np.sqrt(1.0 - EYE_HEIGHT**2) - EYE_DEPTH * up
        self.eyes = np.array([(-at, sign * outwards, EYE_HEIGHT * up) for sign in (1, 1, -1, -1)])
        self.eye_sizes = up * np.tile(EYE_SIZES, (2, 1))

    def place(self, x: np.ndarray, position: np.ndarray, orientation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Vertices [m] and normals in the world, float32 (V, 3), of a backbone at stations `x` [m]."""
        points, axes = Resampling(x, self.x).centre_line(position, orientation)
        turn = np.swapaxes(axes, 1, 2)
        vertices = points[:, None, :] + self._offset @ turn
        normals = self._normal @ turn
        return vertices.reshape(-1, 3).astype(np.float32), normals.reshape(-1, 3).astype(np.float32)

    def at_vertices(self, x: np.ndarray, values: np.ndarray) -> np.ndarray:
        """One value for each vertex, (V,), from `values` at stations `x`, (M,)."""
        return np.repeat(Resampling(x, self.x).linear(values), self._sides)

    def coloured(self, x: np.ndarray, torque: np.ndarray, limit: float) -> np.ndarray:
        """The `shades`, with flanks coloured by the `torque` (M,) at stations `x`, deepest at `limit`."""
        shades = self.shades.copy()
        shades[self._flank] = colours.diverging(self.at_vertices(x, torque)[self._flank], limit)
        return shades


def _graded(rings: int) -> np.ndarray:
    """Abscissae from 0 to 1: quadratic and finer at nose and tail, even in between."""
    nose, tail = max(4, rings // 5), max(3, rings // 6)
    middle = np.linspace(NOSE, 1.0 - TAIL, rings - nose - tail)
    ends = NOSE * (np.arange(nose) / nose) ** 2, 1.0 - TAIL * (np.arange(tail) / tail)[::-1] ** 2
    return np.concatenate([ends[0], middle, ends[1]])


def _triangles(rings: int, sides: int) -> np.ndarray:
    """Indices of the triangles between neighbouring rings, uint32 (T, 3).

    Counter-clockwise seen from outside: angles go from t2 to t3, and rings go along t1 = t2 x t3.
    """
    ring = np.arange(rings - 1)[:, None] * sides
    side = np.arange(sides)
    here, beside = ring + side, ring + (side + 1) % sides
    quads = np.stack([here, beside, here + sides, beside, beside + sides, here + sides], axis=-1)
    return quads.reshape(-1, 3).astype(np.uint32)


def tiles(along: int, across: int) -> np.ndarray:
    """Indices of the triangles, (T, 3), between `along` rows of `across` vertices of an open surface."""
    here = (np.arange(along - 1)[:, None] * across + np.arange(across - 1)).reshape(-1, 1)
    return np.asarray(here + np.array((0, across, across + 1, 0, across + 1, 1))).reshape(-1, 3)
