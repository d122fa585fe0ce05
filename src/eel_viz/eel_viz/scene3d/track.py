# SPDX-License-Identifier: Apache-2.0
"""Draws where the swimmer was: the path of the head in short pieces and strobes of the midline, both shown up to the
cursor, and the last seconds of the head as a trail that fades out.
"""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.scene3d import colours

LENGTH = 3.0  # s: duration of the trail
PIECES, POINTS = 10, 6  # pieces of one brightness each, and points of a piece
STROBE_PERIOD = 1_000_000_000  # ns
ROOM = 64  # positions, at least, between two reallocations of the history


class Track:
    """Draws path and trail."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._stamps, self._places = np.empty(0), np.empty((0, 3))  # ns, m: rows `begin` to `end` are the last seconds
        self._begin = self._end = 0
        self._ages = _ages() * 1e9  # ns, (PIECES, POINTS), from the present backwards
        thin = rr.Radius.ui_points(0.8)
        stream.log_static(
            entities.TRACK, rr.LineStrips3D.from_fields(colors=[colours.dim(colours.AMBER)], radii=[thin])
        )
        left = 1.0 - np.arange(PIECES) / PIECES  # of the colour
        shades = np.outer(left, colours.AMBER) + np.outer(1.0 - left, colours.WATER_BACKGROUND)
        radii = [rr.Radius.ui_points(0.5 + 1.1 * share) for share in left]
        stream.log_static(entities.TRAIL, rr.LineStrips3D.from_fields(colors=shades.astype(np.uint8), radii=radii))

    def draw(self, stamp: int, position: np.ndarray) -> None:
        """Continue to `position`, (3,) [m] in the world, at `stamp` [ns]."""
        if self._end > self._begin:
            piece = np.array([self._places[self._end - 1], position])
            self._stream.add_row(stamp, entities.TRACK, rr.LineStrips3D, strips=piece[None])
        stamps, places = self._remember(stamp, position)
        wanted, trail = stamp - self._ages, np.empty((PIECES, POINTS, 3), dtype=np.float32)
        for axis in range(3):
            trail[..., axis] = np.interp(wanted, stamps, places[:, axis])
        self._stream.add_row(stamp, entities.TRAIL, rr.LineStrips3D, strips=trail)

    def _remember(self, stamp: int, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Add a position; returns stamps (K,) [ns] and positions (K, 3) [m] of the last seconds."""
        if self._end == len(self._stamps):  # make room for as many again
            kept, count = slice(self._begin, self._end), self._end - self._begin
            stamps, places = np.empty(2 * count + ROOM), np.empty((2 * count + ROOM, 3))
            stamps[:count], places[:count] = self._stamps[kept], self._places[kept]
            self._stamps, self._places, self._begin, self._end = stamps, places, 0, count
        self._stamps[self._end], self._places[self._end] = stamp, position
        self._end += 1
        while self._end - self._begin > 2 and self._stamps[self._begin + 1] < stamp - LENGTH * 1e9:
            self._begin += 1
        return self._stamps[self._begin : self._end], self._places[self._begin : self._end]


class Strobes:
    """Draws the midline at each `STROBE_PERIOD`."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._last: int | None = None  # number of the last strobe
        stream.log_static(
            entities.STROBES,
            rr.LineStrips3D.from_fields(colors=[colours.dim(colours.LABEL)], radii=[rr.Radius.ui_points(0.6)]),
        )

    def draw(self, stamp: int, midline: np.ndarray) -> None:
        """Draw `midline`, (M, 3) [m] in the world, if it is the first at or after a strobe's time; stamp [ns]."""
        number = stamp // STROBE_PERIOD
        if number != self._last:
            self._last = number
            self._stream.add_row(stamp, entities.STROBES, rr.LineStrips3D, strips=midline[None].astype(np.float32))


def _ages() -> np.ndarray:
    """Ages [s] of the trail's points, (PIECES, POINTS); a piece begins where the previous one ends."""
    first = np.arange(PIECES) * LENGTH / PIECES
    return first[:, None] + np.linspace(0.0, LENGTH / PIECES, POINTS)
