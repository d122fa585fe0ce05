# SPDX-License-Identifier: Apache-2.0
"""Reads columns of numbers from a .csv file with a header line, or an .npz archive. Errors name file and line."""

import array
import csv
import io
import os
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from eel_base.files.archive import MOST_NUMBERS, read_archive
from eel_base.files.input_file import InputFile, Misplaced, is_number, reading
from eel_base.wording import shown

MOST_BYTES, MOST_LINES, LONGEST_LINE, MOST_COLUMNS = 200_000_000, 5_000_000, 1_000_000, 10_000  # of a .csv file
LARGEST = 1e100  # of a number: squares and products of a few are finite


class Table(NamedTuple):
    """Columns of equal length, and for each row its line in the file (or its number from 1, in an archive)."""

    path: Path
    columns: dict[str, np.ndarray]
    lines: np.ndarray  # (rows,)
    word: str  # "line" or "row"
    what: str = ""  # begins an error, before the file's name

    def error(self, text: str, first: int | None = None, last: int | None = None) -> ValueError:
        """An error about rows `first` to `last` (indices): with the file, their lines and a `text`."""
        place = ""
        if first is not None:
            place = f", {self.word} {self.lines[first]}"
        if last is not None and last != first:
            place = f", {self.word}s {self.lines[first]} to {self.lines[last]}"
        return ValueError(f"{self.what}{shown(str(self.path))}{place}: {text}")

    def check_finite(self, names: tuple[str, ...], largest: float = LARGEST) -> None:
        """`ValueError` for the first number of these columns that is not finite, or beyond the `largest`."""
        for name in names:
            bad = np.flatnonzero(~(np.abs(self.columns[name]) <= largest))
            if len(bad):
                value = self.columns[name][bad[0]]
                rule = f"at most {largest:g}" if np.isfinite(value) else "finite"
                raise self.error(f"{name} must be {rule}, got {value:g}", bad[0])


def read_table(path: str | os.PathLike[str], what: str = "") -> Table:
    """The columns of a .csv or .npz file. `ValueError` in one line, with line and column, for what cannot be read.

    what: begins an error, before the file's name, such as "body file ".
    """
    path = Path(path)
    with reading(f"{what}{shown(str(path))}"):
        if path.suffix == ".npz":
            columns = _flat(read_archive(path))
            return Table(path, columns, np.arange(1, len(next(iter(columns.values()))) + 1), "row", what)
        return Table(path, *_table(path), "line", what)


def _flat(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Arrays as columns. Where some are (N, n), `time` (N,) counts for n rows each, and an (n,) for each instant."""
    shape = next((each.shape for each in arrays.values() if each.ndim == 2), None)
    if shape is not None and len(arrays) * shape[0] * shape[1] > MOST_NUMBERS:
        raise ValueError(f"a table must hold at most {MOST_NUMBERS} numbers, got {len(arrays)} columns of {shape}")
    found = {}
    for name, each in arrays.items():
        if shape is not None and each.shape == shape[:1] and (name == "time" or shape[0] != shape[1]):
            each = np.repeat(each, shape[1])
        elif shape is not None and each.shape == shape[1:]:
            each = np.tile(each, shape[0])
        found[name] = each.ravel()
    sizes = {name: len(each) for name, each in found.items()}
    if len(set(sizes.values())) > 1:
        shapes = ", ".join(f"{name} {arrays[name].shape}" for name in arrays)
        raise ValueError(f"its arrays must fit together, (N,) and (N, n), got {shapes}")
    return found


def _table(path: Path) -> tuple[dict[str, np.ndarray], np.ndarray]:
    rows = csv_rows(path)
    first, head = next(rows, (0, []))
    names = [name.strip() for name in head]
    if not any(names):
        raise ValueError("it is empty")
    if len(set(names)) < len(names) or len(names) > MOST_COLUMNS:
        rule = f"at most {MOST_COLUMNS} columns, each with a name of its own"
        raise Misplaced(f"line {first}", f"there must be {rule}, got {len(names)}: {shown(names)}")
    numbers, lines = array.array("d"), array.array("q")
    for line, row in rows:
        try:
            numbers.extend(map(float, row))
        except ValueError:
            name, cell = next(each for each in zip(names, row, strict=True) if not is_number(each[1]))
            raise Misplaced(f"line {line}", f"{name} must be a number, got {shown(cell)}") from None
        lines.append(line)
    if not lines:
        raise ValueError("it has a header and no row")
    columns = np.frombuffer(numbers).reshape(-1, len(names)).T
    return dict(zip(names, columns, strict=True)), np.frombuffer(lines, dtype=np.int64)


def csv_rows(path: Path, strict: bool = True) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of each row of a .csv file that is not empty. `ValueError` where it exceeds the bounds.

    strict: all rows must be as long as the first, and quotes as they should be.
    """
    with InputFile(path, MOST_BYTES) as file, io.TextIOWrapper(file, encoding="utf-8-sig", newline="") as text:
        rows = csv.reader(_lines(text), strict=strict)
        width = count = 0
        try:
            for row in filter(None, rows):
                if strict and width and len(row) != width:
                    raise ValueError(f"a row must have {width} fields, as the header has, got {len(row)}")
                count += len(row) if width else 0
                if count > MOST_NUMBERS:
                    raise ValueError(f"a table must hold at most {MOST_NUMBERS} numbers")
                width = width or len(row)
                yield rows.line_num, row
        except (ValueError, csv.Error) as error:
            if rows.line_num == 0 or isinstance(error, UnicodeDecodeError):
                raise
            raise Misplaced(f"line {rows.line_num}", str(error)) from None


def _lines(text: io.TextIOBase) -> Iterator[str]:
    """The lines of an open `text`, as many and as long as a table may have."""
    for _ in range(MOST_LINES):
        line = text.readline(LONGEST_LINE)
        if not line:
            return
        if len(line) == LONGEST_LINE:
            raise ValueError(f"a line must be shorter than {LONGEST_LINE} characters")
        yield line
    raise ValueError(f"a table must have fewer than {MOST_LINES} lines")
