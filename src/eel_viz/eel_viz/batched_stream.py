# SPDX-License-Identifier: Apache-2.0
"""A Rerun stream that sends rows in batches: ten rows sent together cost little more than one.

Rows wait for at most a tick of wall time (`send_due`), or until there are `MAXIMUM_ROWS` of a kind. `flush` sends all
rows, and must be called at the end. Every row has its own time, so the order of calls does not matter.
"""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyarrow as pa
import rerun as rr
from numpy.typing import ArrayLike

from eel_viz.entities import TIMELINE

MAXIMUM_ROWS = 256  # of one kind; then they are sent
ARRAY_TICKS = 10  # longest wait of arrays [ticks]: no view draws them
ROUNDING = 1000  # ns: a stamp this close before a slot of time counts as in it


@dataclass(frozen=True, kw_only=True)
class Rates:
    """How often numbers and drawings are logged [Hz of simulation time]; 0: with every message.

    `tick` [s of wall time]: longest wait of rows for a batch.
    """

    numbers: float = 0.0
    drawings: float = 25.0
    tick: float = 0.2


class BatchedStream:
    """Batches rows for the recording `stream`, and decides what is due: once per slot of simulation time.

    Attribute drawing_period: slot of drawings [ns].
    """

    def __init__(self, stream: rr.RecordingStream, rates: Rates) -> None:
        self._stream, self._tick = stream, rates.tick
        self._number_period, self.drawing_period = (
            round(1e9 / rate) if rate else 0 for rate in (rates.numbers, rates.drawings)
        )
        self._slots: dict[str, int] = {}  # the last slot in which each item was due
        self._rows: dict[tuple[Any, ...], tuple[list[int], list[tuple[np.ndarray, ...]]]] = {}
        self._sent = time.monotonic()
        self._ticks = 0

    def due(self, what: str, stamp: int, period: int) -> bool:
        """Whether `stamp` [ns] is in another slot of `period` [ns] than the last time `what` was due; 0: always."""
        if period:
            slot = (stamp + ROUNDING) // period
            if self._slots.get(what) == slot:
                return False
            self._slots[what] = slot
        return True

    def number_due(self, what: str, stamp: int) -> bool:
        """Whether the numbers `what` are due at `stamp` [ns]."""
        return self.due(f"numbers of {what}", stamp, self._number_period)

    def drawing_due(self, what: str, stamp: int) -> bool:
        """Whether the drawing of `what` is due at `stamp` [ns]."""
        return self.due(f"drawing of {what}", stamp, self.drawing_period)

    def log_static(self, path: str, archetype: rr.AsComponents) -> None:
        """Log data that hold at all times."""
        self._stream.log(path, archetype, static=True)

    def log(self, stamp: int, path: str, archetype: rr.AsComponents) -> None:
        """Log at `stamp` [ns], sent at once: for texts, images and rare data."""
        self._stream.set_time(TIMELINE, duration=np.timedelta64(stamp, "ns"))
        self._stream.log(path, archetype)

    def log_text(self, stamp: int, path: str, markdown: str) -> None:
        """Log a text at `stamp` [ns], sent at once."""
        self.log(stamp, path, rr.TextDocument(markdown, media_type="text/markdown"))

    def log_series_style(self, path: str, names: Any, colours: Any = None) -> None:
        """Log the names, and the colours if given, of the curves at `path`, for all times."""
        self.log_static(path, rr.SeriesLines(names=names, colors=colours, widths=[1.5] * len(names)))

    def log_line_style(self, path: str, colour: Any, width: ArrayLike) -> None:
        """Log colour (or colours) and width (or widths) [pixels] of the lines at `path`, for all times."""
        widths: Any = [rr.Radius.ui_points(each) for each in np.atleast_1d(width)]
        shades = [colour] if isinstance(colour, tuple) else colour
        self.log_static(path, rr.LineStrips3D.from_fields(colors=shades, radii=widths))

    def add_lines(self, stamp: int, path: str, strips: np.ndarray) -> None:
        """Add a row of lines `strips` (n, points, 3) [m] at `stamp` [ns], in single precision."""
        self.add_row(stamp, path, rr.LineStrips3D, strips=strips.astype(np.float32))

    def add_pose(self, stamp: int, path: str, position: np.ndarray, orientation: np.ndarray) -> None:
        """Add a row with the frame at `position` (3,) [m], `orientation` (4,), at `stamp` [ns]."""
        self.add_row(stamp, path, rr.Transform3D, translation=position[None], quaternion=orientation[None])

    def add_row(self, stamp: int, path: str, kind: Any, **components: np.ndarray) -> None:
        """Add a row of the archetype `kind` at `stamp` [ns]; the first axis of each component counts its instances."""
        self._add(stamp, (path, kind, *components), components)

    def add_scalars(self, stamp: int, path: str, values: ArrayLike) -> None:
        """Add a row of scalars (n,) at `stamp` [ns]."""
        self._add(stamp, (path, rr.Scalars, "scalars"), {"scalars": np.asarray(values, dtype=float)})

    def add_arrays(self, stamp: int, path: str, name: str, values: dict[str, np.ndarray]) -> None:
        """Add a row of arrays at `stamp` [ns]: components of an archetype called `name`."""
        self._add(stamp, (path, name, *values), values)

    def send_due(self) -> None:
        """Send the rows that have waited for a tick."""
        if time.monotonic() - self._sent > self._tick:
            self._sent = time.monotonic()
            self._ticks += 1
            for key in self._rows:
                if not isinstance(key[1], str) or self._ticks % ARRAY_TICKS == 0:
                    self._send(key)

    def flush(self) -> None:
        """Send all rows."""
        for key in self._rows:
            self._send(key)

    def _add(self, stamp: int, key: tuple[Any, ...], components: dict[str, np.ndarray]) -> None:
        stamps, rows = self._rows.setdefault(key, ([], []))
        stamps.append(stamp)
        rows.append(tuple(components.values()))
        if len(stamps) >= MAXIMUM_ROWS:
            self._send(key)

    def _send(self, key: tuple[Any, ...]) -> None:
        stamps, rows = self._rows[key]
        if not stamps:
            return
        path, kind, *names = key
        gathered = dict(zip(names, zip(*rows, strict=True), strict=True))
        lengths = {name: [len(array) for array in arrays] for name, arrays in gathered.items()}
        if isinstance(kind, str):
            lists = {name: _listed(arrays, lengths[name]) for name, arrays in gathered.items()}
            parts = list(rr.DynamicArchetype.columns(kind, components=lists))
        else:
            columns = kind.columns(**{name: _joined(arrays) for name, arrays in gathered.items()})
            parts = [each.partition(lengths[each.descriptor.component.rpartition(":")[2]]) for each in columns]
        times = rr.TimeColumn(TIMELINE, duration=np.array(stamps, dtype="timedelta64[ns]"))
        rr.send_columns(path, [times], parts, recording=self._stream)
        stamps.clear()
        rows.clear()


def _listed(arrays: tuple[np.ndarray, ...], lengths: list[int]) -> pa.ListArray:
    """One list per row. From plain numbers Rerun would make one list per number."""
    return pa.ListArray.from_arrays(np.cumsum([0, *lengths], dtype=np.int32), np.concatenate(arrays))


def _joined(arrays: tuple[np.ndarray, ...]) -> np.ndarray | list[np.ndarray]:
    """The arrays concatenated; strips of different lengths as a list."""
    if len({array.shape[1:] for array in arrays}) == 1:
        return np.concatenate(arrays)
    return [part for array in arrays for part in array]
