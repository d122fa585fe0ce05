"""The path of the head: all of it as short pieces, which a view adds up from the start to the cursor, and the last
seconds as a trail that fades into the water.
"""

from collections import deque

import numpy as np
import rerun as rr

from eel_viz import colours, entities
from eel_viz.outlet import Outlet

LENGTH = 3.0  # s of the trail
PIECES, POINTS = 10, 6  # of one brightness each, and points along one


class Track:
    """Path and trail, drawn together."""

    def __init__(self, outlet: Outlet) -> None:
        self._outlet = outlet
        self._recent: deque[tuple[int, np.ndarray]] = deque()
        self._ages = _ages() * 1e9  # ns, (PIECES, POINTS), from the present backwards
        thin = rr.Radius.ui_points(0.8)
        outlet.fixed(entities.TRACK, rr.LineStrips3D.from_fields(colors=[colours.dim(colours.AMBER)], radii=[thin]))
        left = 1.0 - np.arange(PIECES) / PIECES  # of the colour
        shades = np.outer(left, colours.AMBER) + np.outer(1.0 - left, colours.WATER_BACKGROUND)
        radii = [rr.Radius.ui_points(0.5 + 1.1 * share) for share in left]
        outlet.fixed(entities.TRAIL, rr.LineStrips3D.from_fields(colors=shades.astype(np.uint8), radii=radii))

    def draw(self, stamp: int, position: np.ndarray) -> None:
        """Go on to `position`, (3,) [m], at `stamp` [ns]."""
        if self._recent:
            piece = np.stack([self._recent[-1][1], position])
            self._outlet.row(stamp, entities.TRACK, rr.LineStrips3D, strips=piece[None])
        self._recent.append((stamp, np.array(position)))
        while len(self._recent) > 2 and self._recent[1][0] < stamp - LENGTH * 1e9:
            self._recent.popleft()
        stamps = np.array([each for each, _ in self._recent], dtype=float)
        places = np.array([place for _, place in self._recent])
        wanted = stamp - self._ages
        trail = np.stack([np.interp(wanted, stamps, places[:, axis]) for axis in range(3)], axis=-1)
        self._outlet.row(stamp, entities.TRAIL, rr.LineStrips3D, strips=trail.astype(np.float32))


def _ages() -> np.ndarray:
    """Ages [s] of the trail's points; a piece begins where the one before it ends."""
    first = np.arange(PIECES) * LENGTH / PIECES
    return first[:, None] + np.linspace(0.0, LENGTH / PIECES, POINTS)
