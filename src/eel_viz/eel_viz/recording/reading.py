# SPDX-License-Identifier: Apache-2.0
"""Reads a recording back into arrays.

    columns = read("out/falling.rrd", entities.WRENCH_NUMBERS)
    columns.time                    # (T,) s
    columns["torque_3"]             # (T, 51) N m

Names of components are those after the colon in Rerun (`Scalars:scalars` is `scalars`). The format has no checksums:
damage may change numbers, or end the process inside Rerun.
"""

import os
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_common.files.input_file import reading
from eel_common.wording import shown

from eel_viz.entities import TIMELINE
from eel_viz.recording.rrd_frames import HEADER_SIZE, complete_file


@dataclass(frozen=True, kw_only=True)
class Columns:
    """The rows of one entity: all `stamps` (T,) [ns], and the values of each component with their stamps [ns]."""

    stamps: np.ndarray
    values: dict[str, list[Any]]
    stamps_of: dict[str, np.ndarray]

    @property
    def time(self) -> np.ndarray:
        """Simulation time of all rows, (T,) [s]."""
        return self.stamps / 1e9

    def __getitem__(self, name: str) -> Any:
        """All values of a component, one row per stamp that has it. Rows of different shapes are a list of arrays."""
        rows = [np.asarray(row) for row in self.values[name]]
        return np.stack(rows) if len({row.shape for row in rows}) == 1 else rows


def read(path: str | os.PathLike[str], entity: str, *, static: bool = False) -> Columns:
    """All rows of `entity`, ordered by time. static: the row that holds at all times.

    `ValueError` if there are none, or if the file is no recording.
    """
    from rerun.chunk import RrdReader

    found: dict[str, list[tuple[int, object]]] = {}
    stamps: set[int] = set()
    with reading(f"recording {shown(str(path))}"), complete_file(path) as readable, warnings.catch_warnings():
        empty = readable.stat().st_size <= HEADER_SIZE
        warnings.filterwarnings("ignore", message="RRD file has no footer")  # the file is still being written
        chunks = [] if empty else list(RrdReader(str(readable)).stream().filter(content=entity))
    for chunk in chunks:
        if chunk.is_static != static or str(chunk.entity_path).strip("/") != entity.strip("/"):
            continue
        batch = chunk.to_record_batch()
        at = [0] * chunk.num_rows if static else batch.column(TIMELINE).cast("int64").to_pylist()
        for name in batch.schema.names:
            if name.startswith("rerun.") or (":" not in name and not static):  # a row's number, or its time
                continue
            for stamp, row in zip(at, batch.column(name).to_pylist(), strict=True):
                if row is not None:
                    found.setdefault(name.rpartition(":")[2], []).append((stamp, row))
                    stamps.add(stamp)
    if not stamps:
        raise ValueError(f"recording {shown(str(path))} has nothing at {shown(entity)}")
    ordered = {name: sorted(rows, key=lambda row: row[0]) for name, rows in found.items()}
    return Columns(
        stamps=np.array(sorted(stamps), dtype=np.int64),
        values={name: [row for _, row in rows] for name, rows in ordered.items()},
        stamps_of={name: np.array([stamp for stamp, _ in rows], dtype=np.int64) for name, rows in ordered.items()},
    )
