# SPDX-License-Identifier: Apache-2.0
"""Shapes of parts: fins as half ellipses of their own area and span, turned about the hinge line at half chord; joints
as rings; appendages as balls.

With the angle a, the root's normal n at rest and the section's axis E1 (towards the tail), the chord's direction
towards the leading edge is sin(a) n - cos(a) E1, as in eel_core/fins.hpp.
"""

import numpy as np

from eel_viz.messages import Backbone, Body
from eel_viz.scene3d.centre_line import Resampling

EDGE = 13  # vertices of a fin's round edge; one more is the middle of the root
HALF_RING = 12  # points of half a joint's ring
AROUND, AXLE = 1.12, 1.6  # of the ring and of the axle's ends [half axes of the body]


class FinPlates:
    """Places the fins of a `body`. Attributes: names of the fins, and triangles: indices of vertices, uint32 (T, 3)."""

    def __init__(self, body: Body) -> None:
        fins = body.fins
        self.names = tuple(fin.name for fin in fins)
        self._stations = np.array([fin.station for fin in fins])
        side, tilt = np.array([fin.side for fin in fins]), np.array([fin.dihedral for fin in fins])
        none, cos, sin = np.zeros(len(fins)), np.cos(tilt), np.sin(tilt)
        axis, self._normal = np.stack([none, side * cos, sin], 1), np.stack([none, -side * sin, cos], 1)
        root = np.stack([none, side * np.interp(self._stations, body.x, body.half_width), none], 1)
        span, area = np.array([fin.span for fin in fins]), np.array([fin.area for fin in fins])
        around = np.linspace(-np.pi / 2, np.pi / 2, EDGE)
        out, along = np.append(np.cos(around), 0.0), np.append(np.sin(around), 0.0)
        self._fixed = root[:, None] + np.einsum("f,k,fi->fki", span, out, axis)  # (F, K, 3) m
        self._along = np.outer(2.0 * area / (np.pi * span), along)  # (F, K) m, towards the leading edge
        k = np.arange(EDGE - 1)
        fan = np.stack([np.full_like(k, EDGE), k, k + 1], 1)
        self.triangles = (np.arange(len(fins))[:, None, None] * (EDGE + 1) + fan).reshape(-1, 3).astype(np.uint32)

    def place(self, backbone: Backbone, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Vertices [m] and normals in the world, float32 (V, 3), at `angles` (F,) [rad]."""
        middle, axes = Resampling(backbone.x, self._stations).centre_line(backbone.position, backbone.orientation)
        cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
        aft = np.array((1.0, 0.0, 0.0))
        chord, normal = sin * self._normal - cos * aft, cos * self._normal + sin * aft
        local = self._fixed + self._along[:, :, None] * chord[:, None]
        vertices = middle[:, None] + np.einsum("fij,fkj->fki", axes, local)
        normals = np.repeat(np.einsum("fij,fj->fi", axes, normal), EDGE + 1, axis=0)
        return vertices.reshape(-1, 3).astype(np.float32), normals.astype(np.float32)


class AppendageBalls:
    """Places the appendages of a `body`. radii: (A,) [m], of circles whose areas are their drag areas."""

    def __init__(self, body: Body) -> None:
        self._stations, offsets, area = body.appendages[:, 0], body.appendages[:, 1:3], body.appendages[:, 3]
        self._offset = np.column_stack((np.zeros(len(area)), offsets))
        self.radii = np.sqrt(area / np.pi).astype(np.float32)

    def place(self, backbone: Backbone) -> np.ndarray:
        """(A, 3) [m], in the world."""
        middle, axes = Resampling(backbone.x, self._stations).centre_line(backbone.position, backbone.orientation)
        return np.asarray(middle + np.einsum("aij,aj->ai", axes, self._offset))


class JointRings:
    """Places the rings around the joints of a `body`, each with the ends of its axle."""

    def __init__(self, body: Body) -> None:
        self._stations = np.array([joint.station for joint in body.joints])
        half = np.stack([np.interp(self._stations, body.x, row) for row in (body.half_width, body.half_height)], axis=1)
        begin = np.array([np.pi / 2 if joint.axis == 3 else 0.0 for joint in body.joints])
        turns = begin[:, None] + np.concatenate([np.linspace(k * np.pi, (k + 1) * np.pi, HALF_RING) for k in range(2)])
        out = np.full(turns.shape, AROUND)
        for place in (2 * HALF_RING, HALF_RING, 0):  # the ends of the axle, from behind
            turns = np.insert(turns, place, turns[:, min(place, 2 * HALF_RING - 1)], axis=1)
            out = np.insert(out, place, AXLE, axis=1)
        ring = (out[:, :, None] * np.stack([np.cos(turns), np.sin(turns)], axis=2)) * half[:, None]
        self._offset = np.concatenate([np.zeros((*ring.shape[:2], 1)), ring], axis=2)  # (J, P, 3) m, section axes

    def place(self, backbone: Backbone) -> np.ndarray:
        """One strip for each joint, (J, P, 3) [m], in the world."""
        middle, axes = Resampling(backbone.x, self._stations).centre_line(backbone.position, backbone.orientation)
        return np.asarray(middle[:, None] + np.einsum("jik,jpk->jpi", axes, self._offset))
