"""Rows of a recording, given one by one and sent together: a column of ten rows costs little more than one row.

Rows are kept for `tick` seconds of wall time at most (`attend` looks), or until there are `ROWS` of a kind; `send`
brings out what is there, and must be called at the end. Every row has its own time, so the order of calls is free.
"""

import time

import numpy as np
import pyarrow as pa
import rerun as rr

from eel_viz.entities import TIMELINE

ROWS = 256  # of one kind, which are sent without waiting
UNDRAWN = 10  # ticks that arrays which nothing draws may wait


class Outlet:
    """One recording `stream`; `tick` [s of wall time] is how long a row may wait."""

    def __init__(self, stream: rr.RecordingStream, *, tick: float) -> None:
        self._stream, self._tick = stream, tick
        self._rows: dict[tuple, tuple[list[int], list[tuple]]] = {}
        self._sent = time.monotonic()
        self._ticks = 0

    def fixed(self, path: str, archetype: rr.AsComponents) -> None:
        """What is valid at all times."""
        self._stream.log(path, archetype, static=True)

    def once(self, stamp: int, path: str, archetype: rr.AsComponents) -> None:
        """One thing at `stamp` [ns], sent at once: texts, images, what is rare."""
        self._stream.set_time(TIMELINE, duration=np.timedelta64(stamp, "ns"))
        self._stream.log(path, archetype)

    def row(self, stamp: int, path: str, kind: type, **components: np.ndarray) -> None:
        """A row of the archetype `kind` at `stamp` [ns]; the first axis of each component counts its instances."""
        self._gather(stamp, (path, kind, *components), components)

    def scalars(self, stamp: int, path: str, values: np.ndarray) -> None:
        """A row of scalars at `stamp` [ns], (n,)."""
        self._gather(stamp, (path, rr.Scalars, "scalars"), {"scalars": np.asarray(values, dtype=float)})

    def numbers(self, stamp: int, path: str, name: str, values: dict[str, np.ndarray]) -> None:
        """A row of arrays at `stamp` [ns] as components of their own, of an archetype called `name`."""
        self._gather(stamp, (path, name, *values), values)

    def attend(self) -> None:
        """Now and then: send what has waited long enough."""
        if time.monotonic() - self._sent > self._tick:
            self._sent = time.monotonic()
            self._ticks += 1
            for key in self._rows:
                if not isinstance(key[1], str) or self._ticks % UNDRAWN == 0:
                    self._send(key)

    def send(self) -> None:
        """Send all rows."""
        for key in self._rows:
            self._send(key)

    def _gather(self, stamp: int, key: tuple, components: dict[str, np.ndarray]) -> None:
        stamps, rows = self._rows.setdefault(key, ([], []))
        stamps.append(stamp)
        rows.append(tuple(components.values()))
        if len(stamps) >= ROWS:
            self._send(key)

    def _send(self, key: tuple) -> None:
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
    """A list for each row; of plain numbers rerun would make a list for each number."""
    return pa.ListArray.from_arrays(np.cumsum([0, *lengths], dtype=np.int32), np.concatenate(arrays))


def _joined(arrays: tuple[np.ndarray, ...]):
    """One array after the other; strips of different lengths as a list."""
    if len({array.shape[1:] for array in arrays}) == 1:
        return np.concatenate(arrays)
    return [part for array in arrays for part in array]
