# SPDX-License-Identifier: Apache-2.0
"""Joints as rings about the body, each with the ends of its axle."""

import numpy as np

from eel_viz.messages import Backbone, Body
from eel_viz.scene3d.centre_line import Resampling

POINTS = 12  # of half a ring
AROUND, AXLE = 1.12, 1.6  # half axes of the ring, and ends of the axle [half axes of the body]


class JointRings:
    """Places the rings of the joints of a `body`."""

    def __init__(self, body: Body) -> None:
        self._stations = np.array([joint.station for joint in body.joints])
        half = np.stack([np.interp(self._stations, body.x, row) for row in (body.half_width, body.half_height)], axis=1)
        begin = np.array([np.pi / 2 if joint.axis == 3 else 0.0 for joint in body.joints])
        turns = begin[:, None] + np.concatenate([np.linspace(k * np.pi, (k + 1) * np.pi, POINTS) for k in range(2)])
        out = np.full(turns.shape, AROUND)
        for place in (2 * POINTS, POINTS, 0):  # the ends of the axle, from behind
            turns = np.insert(turns, place, turns[:, min(place, 2 * POINTS - 1)], axis=1)
            out = np.insert(out, place, AXLE, axis=1)
        ring = (out[:, :, None] * np.stack([np.cos(turns), np.sin(turns)], axis=2)) * half[:, None]
        self._offset = np.concatenate([np.zeros((*ring.shape[:2], 1)), ring], axis=2)  # (J, P, 3) m, section axes

    def place(self, backbone: Backbone) -> np.ndarray:
        """One strip for each joint, (J, P, 3) [m], in the world."""
        middle, axes = Resampling(backbone.x, self._stations).centre_line(backbone.position, backbone.orientation)
        return np.asarray(middle[:, None] + np.einsum("jik,jpk->jpi", axes, self._offset))
