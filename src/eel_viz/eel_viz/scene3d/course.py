# SPDX-License-Identifier: Apache-2.0
"""Draws the way points of a goal: the legs between them, and the distance at which a point is reached."""

from typing import Any

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Body
from eel_viz.scene3d import colours


class Course:
    """Draws the last course, for all times: its legs, a sphere about each point, a tube of that radius about each leg.

    reach: the radius [body lengths] within which a way point is reached. Until the body's length is known, 1 m is
    assumed.
    """

    def __init__(self, stream: BatchedStream, reach: float) -> None:
        self._stream, self._reach, self._length = stream, reach, 1.0  # m, of the body
        self._points: np.ndarray | None = None  # (n, 3) m

    def body(self, stamp: int, body: Body) -> None:
        """Take the body's length, and redraw a course that exists."""
        self._length = body.length
        if self._points is not None:
            self.goal(stamp, self._points)

    def goal(self, stamp: int, points: np.ndarray) -> None:
        """Draw the way `points` (n, 3) [m] in the world."""
        self._points, reach = points, self._reach * self._length
        thin: Any = rr.Radius.ui_points(0.8)
        legs = rr.LineStrips3D([points.astype(np.float32)], colors=[colours.LABEL], radii=[thin])
        self._stream.log_static(entities.COURSE, legs)
        spheres = rr.Ellipsoids3D(
            centers=points, half_sizes=np.full((len(points), 3), reach), colors=[colours.COURSE], line_radii=[thin]
        )
        self._stream.log_static(entities.WAY_POINTS, spheres)
        along = np.diff(points, axis=0)
        lengths = np.linalg.norm(along, axis=1)
        tube = rr.Capsules3D(
            lengths=lengths,
            radii=np.full(len(lengths), reach),
            translations=points[:-1],
            quaternions=turns_of_up_into(along / np.maximum(lengths, 1e-9)[:, None]),
            colors=[colours.COURSE],
            line_radii=[thin],
            fill_mode="majorwireframe",
        )
        self._stream.log_static(entities.TUBE, tube)


def turns_of_up_into(directions: np.ndarray) -> np.ndarray:
    """Quaternions (n, 4) x y z w of the shortest rotations from the world's axis 3 to unit vectors (n, 3)."""
    x, y, z = directions.T
    turns = np.stack((-y, x, np.zeros_like(x), 1.0 + z), axis=1)
    turns[z < -1.0 + 1e-9] = (1.0, 0.0, 0.0, 0.0)  # straight down, all ways are equally short
    return np.asarray(turns / np.linalg.norm(turns, axis=1)[:, None])
