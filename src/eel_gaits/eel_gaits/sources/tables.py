# SPDX-License-Identifier: Apache-2.0
"""Reads columns of numbers from a .csv file with a header line, or an .npz archive. Errors name file and line."""

import csv
import os
import zlib
from pathlib import Path
from typing import NamedTuple
from zipfile import BadZipFile

import numpy as np
from eel_base.wording import one_line, shown

LARGEST = 500_000_000  # bytes of a file


class Table(NamedTuple):
    """Columns of equal length, and for each row its line in the file (or its number from 1, in an archive)."""

    path: Path
    columns: dict[str, np.ndarray]
    lines: np.ndarray  # (rows,)
    word: str  # "line" or "row"

    def error(self, text: str, first: int | None = None, last: int | None = None) -> ValueError:
        """An error about rows `first` to `last` (indices): with the file, their lines and a `text`."""
        place = ""
        if first is not None:
            place = f", {self.word} {self.lines[first]}"
        if last is not None and last != first:
            place = f", {self.word}s {self.lines[first]} to {self.lines[last]}"
        return ValueError(f"{shown(str(self.path))}{place}: {text}")

    def check_finite(self, names: tuple[str, ...]):
        """`ValueError` for the first number of these columns that is not finite."""
        for name in names:
            bad = np.flatnonzero(~np.isfinite(self.columns[name]))
            if len(bad):
                raise self.error(f"{name} must be finite, got {self.columns[name][bad[0]]}", bad[0])


def read_table(path: str | os.PathLike) -> Table:
    """The columns of a .csv or .npz file. `ValueError` in one line, with line and column, for what cannot be read."""
    path = Path(path)
    try:
        if not path.is_file():
            raise ValueError("there is no such file" if not path.exists() else "it is no regular file")
        if path.stat().st_size > LARGEST:
            raise ValueError(f"it must have at most {LARGEST:.0e} bytes, got {path.stat().st_size}")
        if path.suffix == ".npz":
            columns = _flat(read_arrays(path))
            lines, word = np.arange(1, len(next(iter(columns.values()))) + 1), "row"
        else:
            (columns, lines), word = _table(path), "line"
    except (OSError, ValueError, csv.Error) as error:
        raise ValueError(f"{shown(str(path))}: {one_line(error)}") from None
    return Table(path, columns, lines, word)


def read_arrays(path: Path) -> dict[str, np.ndarray]:
    """The arrays of an .npz archive, of any shape. `ValueError` for another file."""
    try:
        with np.load(path) as data:
            return {name: np.asarray(data[name], dtype=float) for name in data.files}
    except (TypeError, ValueError, EOFError, BadZipFile, zlib.error, RuntimeError, KeyError, OSError):
        raise ValueError("it is no .npz archive of arrays of numbers") from None


def _flat(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Arrays as columns. Where some are (N, n), `time` (N,) counts for n rows each, and an (n,) for each instant."""
    if not arrays:
        raise ValueError("it is empty")
    shape = next((each.shape for each in arrays.values() if each.ndim == 2), None)
    found = {}
    for name, array in arrays.items():
        if shape is not None and array.shape == shape[:1] and (name == "time" or shape[0] != shape[1]):
            array = np.repeat(array, shape[1])
        elif shape is not None and array.shape == shape[1:]:
            array = np.tile(array, shape[0])
        found[name] = array.ravel()
    sizes = {name: len(array) for name, array in found.items()}
    if len(set(sizes.values())) > 1:
        told = ", ".join(f"{name} {arrays[name].shape}" for name in arrays)
        raise ValueError(f"its arrays must fit together, (N,) and (N, n), got {told}")
    return found


def _table(path: Path) -> tuple[dict[str, np.ndarray], np.ndarray]:
    with path.open(newline="", encoding="utf-8-sig") as file:
        rows = csv.reader(file, strict=True)
        names = [name.strip() for name in next(rows, [])]
        if not names or not any(names):
            raise ValueError("it is empty")
        if len(set(names)) < len(names):
            raise ValueError(f"line 1: each column must have a name of its own, got {shown(names)}")
        table, lines = [], []
        try:
            for row in filter(None, rows):
                if len(row) != len(names):
                    raise ValueError(f"a row must have {len(names)} fields, as the header has, got {len(row)}")
                table.append([_number(name, cell) for name, cell in zip(names, row, strict=True)])
                lines.append(rows.line_num)
        except (ValueError, csv.Error) as error:
            raise ValueError(f"line {rows.line_num}: {error}") from None
    if not table:
        raise ValueError("it has a header and no row")
    return dict(zip(names, np.array(table).T, strict=True)), np.array(lines)


def _number(name: str, cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        raise ValueError(f"{name} must be a number, got {shown(cell)}") from None
