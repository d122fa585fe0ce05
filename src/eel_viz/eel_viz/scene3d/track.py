"""The path of the head: all of it as short pieces, which a view adds up from the start to the cursor, and the last
seconds as a trail that fades into the water.
"""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.outlet import Outlet
from eel_viz.scene3d import colours

LENGTH = 3.0  # s of the trail
PIECES, POINTS = 10, 6  # of one brightness each, and points along one
ROOM = 64  # places, at least, between two moves of what is remembered


class Track:
    """Path and trail, drawn together."""

    def __init__(self, outlet: Outlet) -> None:
        self._outlet = outlet
        self._stamps, self._places = np.empty(0), np.empty((0, 3))  # ns, m: rows `begin` to `end` are the last seconds
        self._begin = self._end = 0
        self._ages = _ages() * 1e9  # ns, (PIECES, POINTS), from the present backwards
        thin = rr.Radius.ui_points(0.8)
        outlet.fixed(entities.TRACK, rr.LineStrips3D.from_fields(colors=[colours.dim(colours.AMBER)], radii=[thin]))
        left = 1.0 - np.arange(PIECES) / PIECES  # of the colour
        shades = np.outer(left, colours.AMBER) + np.outer(1.0 - left, colours.WATER_BACKGROUND)
        radii = [rr.Radius.ui_points(0.5 + 1.1 * share) for share in left]
        outlet.fixed(entities.TRAIL, rr.LineStrips3D.from_fields(colors=shades.astype(np.uint8), radii=radii))

    def draw(self, stamp: int, position: np.ndarray) -> None:
        """Go on to `position`, (3,) [m], at `stamp` [ns]."""
        if self._end > self._begin:
            piece = np.array([self._places[self._end - 1], position])
            self._outlet.row(stamp, entities.TRACK, rr.LineStrips3D, strips=piece[None])
        stamps, places = self._remember(stamp, position)
        wanted, trail = stamp - self._ages, np.empty((PIECES, POINTS, 3), dtype=np.float32)
        for axis in range(3):
            trail[..., axis] = np.interp(wanted, stamps, places[:, axis])
        self._outlet.row(stamp, entities.TRAIL, rr.LineStrips3D, strips=trail)

    def _remember(self, stamp: int, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Stamps [ns] (K,) and places [m] (K, 3) of the last seconds, with the present."""
        if self._end == len(self._stamps):  # make room: for as many again as there are
            kept, count = slice(self._begin, self._end), self._end - self._begin
            stamps, places = np.empty(2 * count + ROOM), np.empty((2 * count + ROOM, 3))
            stamps[:count], places[:count] = self._stamps[kept], self._places[kept]
            self._stamps, self._places, self._begin, self._end = stamps, places, 0, count
        self._stamps[self._end], self._places[self._end] = stamp, position
        self._end += 1
        while self._end - self._begin > 2 and self._stamps[self._begin + 1] < stamp - LENGTH * 1e9:
            self._begin += 1
        return self._stamps[self._begin : self._end], self._places[self._begin : self._end]


def _ages() -> np.ndarray:
    """Ages [s] of the trail's points; a piece begins where the one before it ends."""
    first = np.arange(PIECES) * LENGTH / PIECES
    return first[:, None] + np.linspace(0.0, LENGTH / PIECES, POINTS)
