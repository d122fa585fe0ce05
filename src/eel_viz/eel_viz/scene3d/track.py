# SPDX-License-Identifier: Apache-2.0
"""Draws the present and past places of the swimmer: frames of head and tail, and the midline; the head's path in short
pieces and strobes of the midline, both shown up to the cursor; and two fading trails of the last seconds: the path of
the head, and the momentum that the tail gave to the wake.
"""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone, Pose
from eel_viz.scene3d import colours
from eel_viz.scene3d.skin import tiles

LENGTH = 3.0  # s: duration of the trail
PIECES, POINTS = 10, 6  # pieces of one brightness each, and points of a piece
EDGES = 91  # across the wake
SHEER = 110  # of 255: opacity of the wake
STROBE_PERIOD = 1_000_000_000  # ns
AXES_LENGTH = 0.12  # m


class RecentRows:
    """The last seconds of a quantity of `width` numbers."""

    def __init__(self, width: int) -> None:
        self._stamps, self._rows = np.empty(0), np.empty((0, width))  # ns, and the rows

    def add(self, stamp: int, row: np.ndarray) -> np.ndarray | None:
        """Add a `row` (width,) at `stamp` [ns]. Returns the previous one, None at first."""
        previous = self._rows[-1] if len(self._rows) else None
        begin = max(0, int(np.searchsorted(self._stamps, stamp - LENGTH * 1e9)) - 1)
        self._stamps = np.append(self._stamps[begin:], stamp)
        self._rows = np.concatenate([self._rows[begin:], row[None]])
        return previous

    def at(self, stamps: np.ndarray) -> np.ndarray:
        """The quantity at `stamps` (...,) [ns], interpolated: float32 (..., width). Before the first row, that row."""
        found = [np.interp(stamps, self._stamps, column) for column in self._rows.T]
        return np.stack(found, axis=-1).astype(np.float32)


class Track:
    """Draws midline, strobes, path, trail, and the frames of head and tail, through the methods of topics."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._places = RecentRows(3)  # m
        self._ages = _ages() * 1e9  # ns, (PIECES, POINTS), from the present backwards
        stream.log_line_style(entities.TRACK, colours.dim(colours.PATH, 0.8), width=1.0)
        left = 1.0 - np.arange(PIECES) / PIECES  # shares of the colour
        stream.log_line_style(entities.TRAIL, colours.faded(colours.PATH, left), width=0.5 + 1.1 * left)
        stream.log_line_style(entities.STROBES, colours.dim(colours.LABEL, 0.65), width=0.8)
        stream.log_static(entities.BACKBONE, rr.LineStrips3D.from_fields(colors=[colours.LABEL], radii=[0.0004]))
        world = rr.Transform3D(parent_frame=f"tf#{entities.WORLD}", child_frame=entities.WORLD_FRAME)
        stream.log_static(f"{entities.WORLD}/frames", world)
        head = rr.Transform3D(parent_frame=f"tf#{entities.HEAD}", child_frame=entities.HEAD_FRAME)
        stream.log_static(f"{entities.HEAD}/frame", head)
        for path in (entities.HEAD, entities.TAIL):
            stream.log_static(path, rr.TransformAxes3D(AXES_LENGTH))

    def head_pose(self, stamp: int, pose: Pose) -> None:
        if self._stream.drawing_due("track", stamp):
            previous = self._places.add(stamp, pose.position)
            if previous is not None:
                self._stream.add_lines(stamp, entities.TRACK, np.array([[previous, pose.position]]))
            self._stream.add_lines(stamp, entities.TRAIL, self._places.at(stamp - self._ages))
            self._stream.add_pose(stamp, entities.HEAD, pose.position, pose.orientation)

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Draw the midline. The first of each `STROBE_PERIOD` stays visible."""
        midline = backbone.position[None]
        if self._stream.number_due("backbone", stamp):
            if self._stream.due("strobe", stamp, STROBE_PERIOD):
                self._stream.add_lines(stamp, entities.STROBES, midline)
            self._stream.add_lines(stamp, entities.BACKBONE, midline)
        if self._stream.drawing_due("tail", stamp):
            self._stream.add_pose(stamp, entities.TAIL, backbone.position[-1], backbone.orientation[-1])


class Wake:
    """Draws a ribbon beside the tail's path: the momentum per time given to the wake, `scale` [m per N] wide.

    This is a scheme: the model has no flow in the wake. So the ribbon stays where the tail was, even in a current.
    """

    def __init__(self, stream: BatchedStream, scale: float) -> None:
        self._stream, self._scale = stream, scale
        self._ends = RecentRows(6)  # m: the tail's place, and the ribbon's other edge
        self._ages = np.linspace(0.0, LENGTH * 1e9, EDGES)  # ns
        shades = np.repeat(colours.faded(colours.WAKE, np.linspace(1.0, 0.0, EDGES)), 2, axis=0)
        ribbon = rr.Mesh3D.from_fields(
            triangle_indices=tiles(EDGES, 2), vertex_colors=shades, albedo_factor=(255, 255, 255, SHEER)
        )
        stream.log_static(entities.WAKE, ribbon)

    def draw(self, stamp: int, tail: np.ndarray, momentum_rate: np.ndarray) -> None:
        """Extend it to the `tail`, (3,) [m], with the `momentum_rate`, (3,) [N], in the world, at `stamp` [ns]."""
        self._ends.add(stamp, np.concatenate([tail, tail + self._scale * momentum_rate]))
        self._stream.add_row(
            stamp, entities.WAKE, rr.Mesh3D, vertex_positions=self._ends.at(stamp - self._ages).reshape(-1, 3)
        )


def _ages() -> np.ndarray:
    """Ages [s] of the trail's points, (PIECES, POINTS). A piece begins where the previous one ends."""
    first = np.arange(PIECES) * LENGTH / PIECES
    return first[:, None] + np.linspace(0.0, LENGTH / PIECES, POINTS)
