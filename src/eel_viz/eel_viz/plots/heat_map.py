# SPDX-License-Identifier: Apache-2.0
"""A heat map of one profile over abscissa and time: the last seconds, with the present at the right, the head on top.

It is a rolling image of palette indices (one byte each) with one column per `STEP` seconds, axes and a colour bar. A
new limit of the colours applies to all columns.
"""

from itertools import pairwise

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.limit import Limit
from eel_viz.scene3d import colours
from eel_viz.scene3d.lettering import flat_texts

COLUMNS = 200
ROWS = 41
STEP = 0.04  # s; the map is 8 s long
PERIOD = 200_000_000  # ns: of the image
NO_DATA = 0
LABELS = "labels"
LETTERS = 3.6  # height of a capital
BOUNDS_X = (-26.0, COLUMNS + 24.0)
BOUNDS_Y = (-3.0, ROWS + 9.0)


class HeatMap:
    """Keeps the columns and logs the image below `root`; `limit` is the value of the deepest colour of the `palette`.

    palette: uint8 (256, 3), from the bar's lower end to its upper.
    """

    LEAST = -1.0  # the bar's lower end, relative to the limit

    def __init__(
        self,
        stream: BatchedStream,
        *,
        limit: Limit,
        root: str = entities.HEAT_MAP,
        palette: np.ndarray = colours.DIVERGING,
    ) -> None:
        self._stream, self._limit, self._root, self._palette = stream, limit, root, palette
        self._values = np.full((ROWS, COLUMNS), np.nan, dtype=np.float32)
        self._last: int | None = None
        meanings = [rr.AnnotationInfo(id=NO_DATA, color=(24, 27, 31))]
        meanings += [rr.AnnotationInfo(id=k, color=tuple(int(c) for c in palette[k])) for k in range(1, 256)]
        stream.log_static(root, rr.AnnotationContext(meanings))
        self._length = 0.0  # m
        self._labelled: tuple[float, float] | None = None
        self._draw_bar()

    def add(self, stamp: int, x: np.ndarray, values: np.ndarray) -> None:
        """Add `values` (M,) at stations `x` (M,) [m] and `stamp` [ns], and draw the image if it is due."""
        self.include(stamp, x, values)
        if self._stream.due(self._root, stamp, PERIOD):
            self.draw(stamp)

    def include(self, stamp: int, x: np.ndarray, values: np.ndarray) -> None:
        """Put `values` (M,) at stations `x` (M,) [m] into the column of `stamp` [ns]."""
        column = int((stamp + 1000) // int(STEP * 1e9))
        if self._last is not None and column <= self._last:
            return
        self._length = float(x[-1])
        shift = COLUMNS if self._last is None else min(column - self._last, COLUMNS)
        self._values[:, :-shift] = self._values[:, shift:].copy()
        rows = self._rows(x, values)
        self._values[:, -shift:] = np.nan if self._last is None else rows[:, None]
        self._values[:, -1] = rows
        self._last = column

    def draw(self, stamp: int) -> None:
        """Log the image at `stamp` [ns], and the labels when they change."""
        labelled = (self._length, self._limit.value)
        if labelled != self._labelled:
            self._labelled = labelled
            self._draw_labels(stamp, *labelled)
        known = np.isfinite(self._values)
        pixels = np.maximum(self._indices(np.where(known, self._values, 0.0), self._limit.value), 1)
        image = np.where(known, pixels, NO_DATA).astype(np.uint8)
        self._stream.log(stamp, f"{self._root}/{entities.IMAGE}", rr.SegmentationImage(image, draw_order=0.0))

    def _draw_bar(self) -> None:
        bar = np.linspace(0, ROWS, 65)
        left, right = COLUMNS + 4.0, COLUMNS + 8.0
        steps = [[((left + right) / 2, y0), ((left + right) / 2, y1)] for y0, y1 in pairwise(bar)]
        shades = self._palette[self._indices(np.linspace(1.0, self.LEAST, 64), 1.0)]
        self._stream.log_static(
            f"{self._root}/{entities.FRAME}/bar",
            rr.LineStrips2D(steps, colors=shades, radii=(right - left) / 2),
        )

    def _draw_labels(self, stamp: int, length: float, limit: float) -> None:
        right = COLUMNS + 8.0
        places = [(x, y) for x in (-13.0, right + 8.0) for y in (2.5, ROWS / 2, ROWS - 2.5)]
        texts = self._texts(length, limit)
        span = COLUMNS * STEP
        places += [(COLUMNS * k / 4, ROWS + 4.5) for k in range(5)]
        texts += [f"-{span * (1 - k / 4):g} s" for k in range(4)] + ["now"]
        self._stream.log(stamp, f"{self._root}/{entities.FRAME}/{LABELS}", flat_texts(places, texts, LETTERS))

    def _indices(self, values: np.ndarray, limit: float) -> np.ndarray:
        """Entries of the palette for `values`, uint8, of the same shape."""
        return colours.diverging_index(values, limit)

    def _rows(self, x: np.ndarray, values: np.ndarray) -> np.ndarray:
        """The column (ROWS,) of `values` (M,) at `x` (M,)."""
        return np.asarray(np.interp(np.linspace(0.0, x[-1], ROWS), x, values))

    def _texts(self, length: float, limit: float) -> list[str]:
        """The words at the left and at the bar, from the top."""
        return ["head 0", f"X {length / 2:.3g} m", f"tail {length:.3g}", f"+{limit:g}", "0", f"-{limit:g}"]
