# SPDX-License-Identifier: Apache-2.0
"""A plot of profiles against the abscissa X: curves, their envelope in the last seconds, and axes with ticks.

Rerun only plots against time. So the plot consists of lines in a two-dimensional view, whose axes share one scale and
whose y points down: drawn x = WIDTH * X / length, drawn y = -value / (2 limit). The limit is a round number that fits
the last seconds, and the ticks follow it.
"""

from collections import deque
from typing import Any

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.limit import RECENT, Limit
from eel_viz.messages import same
from eel_viz.scene3d import colours
from eel_viz.scene3d.colours import Colour
from eel_viz.scene3d.lettering import flat_texts

WIDTH = 5.2
LETTERS = 0.092  # height of a capital
IN_FRONT = 40.0  # draw order of letters: before the curves (30), their envelope (20) and the frame (10)
SLOT = 500_000_000  # ns: the envelope drops old values in such steps
ENVELOPE_PERIOD = 500_000_000  # ns
BOUNDS_X = (-0.62, WIDTH + 0.18)
BOUNDS_Y = (-0.79, 0.79)


class ProfilePlot:
    """Draws up to three profiles into the entities below `root` of a recording.

    names: of the curves (C1, C2, C3), from back to front. unit: of the values. limit: initial value at the upper edge;
    0: fits the last values. palette: colours of the curves. widths: of the curves [pixels].
    envelope_period: between its drawings [ns]; None: it is not drawn.
    """

    def __init__(
        self,
        stream: BatchedStream,
        root: str,
        *,
        names: tuple[str, ...],
        unit: str,
        limit: float,
        palette: tuple[Colour, ...] = colours.AXIS,
        widths: tuple[float, ...] = (1.4,),
        envelope_period: int | None = ENVELOPE_PERIOD,
    ) -> None:
        self._stream, self._root, self._names, self._unit = stream, root, names, unit
        self._limit = Limit(limit)
        self._palette, self._widths, self._envelope_period = palette, widths, envelope_period
        self._ticks: tuple[float, float] | None = None
        self._x: np.ndarray | None = None
        self._slots: deque[tuple[int, np.ndarray, np.ndarray]] = deque()  # number, least and greatest values
        self._draw_frame()

    @property
    def limit(self) -> float:
        """The value at the upper edge."""
        return self._limit.value

    def add(self, stamp: int, x: np.ndarray, values: np.ndarray) -> None:
        """Add `values`, (M, n) at stations `x` (M,) [m], at `stamp` [ns], and draw what is due."""
        self.include(stamp, x, values)
        if self._stream.drawing_due(self._root, stamp):
            self.draw(stamp, x, values)
        if self._envelope_period is not None and self._stream.due(self._root, stamp, self._envelope_period):
            self.draw_envelope(stamp)

    def include(self, stamp: int, x: np.ndarray, values: np.ndarray) -> None:
        """Extend the envelope and the limit by `values`, (M, n) at stations `x` (M,) [m], at `stamp` [ns]."""
        if self._x is None or not same(self._x, x):
            self._x = x
            self._slots.clear()
        slot = stamp // SLOT
        if not self._slots or self._slots[-1][0] != slot:
            self._slots.append((slot, np.array(values), np.array(values)))
        _, low, high = self._slots[-1]
        np.minimum(low, values, out=low)
        np.maximum(high, values, out=high)
        while self._slots[0][0] <= slot - RECENT // SLOT:
            self._slots.popleft()
        self._limit.recent.include(stamp, float(np.max(np.abs(values))))

    def draw(self, stamp: int, x: np.ndarray, values: np.ndarray) -> None:
        """Draw the curves of `values`, (M, n) at stations `x` (M,) [m], at `stamp` [ns]."""
        length = float(x[-1])
        if self._ticks != (self.limit, length):
            self._ticks = (self.limit, length)
            self._draw_ticks(stamp, length)
        self._stream.add_row(stamp, f"{self._root}/{entities.CURVES}", rr.LineStrips2D, strips=self._drawn(x, values))

    def draw_envelope(self, stamp: int) -> None:
        """Draw the least and the greatest value of the last seconds at each station, behind the curves."""
        if self._x is not None:
            _, lows, highs = zip(*self._slots, strict=True)
            extremes = np.minimum.reduce(lows), np.maximum.reduce(highs)
            strips = np.concatenate([self._drawn(self._x, each) for each in extremes])
            self._stream.add_row(stamp, f"{self._root}/{entities.ENVELOPE}", rr.LineStrips2D, strips=strips)

    def _drawn(self, x: np.ndarray, values: np.ndarray) -> np.ndarray:
        strips = np.empty((values.shape[1], len(x), 2), dtype=np.float32)
        strips[:, :, 0] = WIDTH * x / x[-1]
        strips[:, :, 1] = values.T / (-2.0 * self.limit)
        return strips

    def _draw_frame(self) -> None:
        palette = self._palette[: len(self._names)]
        grid = [[(0, y), (WIDTH, y)] for y in (-0.5, -0.25, 0.0, 0.25, 0.5)]
        grid += [[(WIDTH * k / 5, -0.5), (WIDTH * k / 5, 0.5)] for k in range(6)]
        shades = [colours.TICK] * len(grid)
        shades[2] = colours.FRAME
        log = self._stream.log_static
        thick: Any = [rr.Radius.ui_points(width) for width in self._widths]
        log(
            f"{self._root}/{entities.FRAME}",
            rr.LineStrips2D(grid, colors=shades, radii=rr.Radius.ui_points(0.6), draw_order=10.0),
        )
        log(
            f"{self._root}/{entities.CURVES}",
            rr.LineStrips2D.from_fields(colors=palette, radii=thick, draw_order=30.0),
        )
        behind = [colours.dim(colour) for colour in palette]
        log(
            f"{self._root}/{entities.ENVELOPE}",
            rr.LineStrips2D.from_fields(colors=behind * 2, radii=rr.Radius.ui_points(0.7), draw_order=20.0),
        )
        widths = [0.20 + 0.088 * len(name) for name in self._names]
        keys = [(start, -0.64) for start in np.cumsum([0.0, *widths[:-1]])]
        texts = flat_texts(keys, self._names, LETTERS, palette, align=0.0, draw_order=IN_FRONT)
        log(f"{self._root}/{entities.KEY}", texts)

    def _draw_ticks(self, stamp: int, length: float) -> None:
        places = [(-0.30, -y) for y in (0.5, 0.0, -0.5)]
        texts = [f"{y * self.limit:+.3g}" if y else "0" for y in (1.0, 0.0, -1.0)]
        places += [(WIDTH * k / 5, 0.64) for k in range(6)]
        texts += [f"{length * k / 5:.3g}" for k in range(6)]
        places.append((WIDTH * 0.87, -0.64))
        texts.append(f"[{self._unit}] over X [m]")
        ticks = flat_texts(places, texts, LETTERS, draw_order=IN_FRONT)
        self._stream.log(stamp, f"{self._root}/{entities.TICKS}", ticks)
