# SPDX-License-Identifier: Apache-2.0
"""Columns of a body from a file: x, half_width, half_height [m] of a .csv with a header line, or of an .npz archive."""

import csv
import zlib
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from eel_base.wording import one_line, shown

COLUMNS = ("x", "half_width", "half_height")


def columns_of(path: Path) -> dict[str, np.ndarray]:
    """Each of `COLUMNS`. `ValueError` in one line that names the file."""
    try:
        if path.exists() and not path.is_file():
            raise ValueError("it is no regular file")
        found = _archive(path) if path.suffix == ".npz" else _table(path)
    except (OSError, ValueError, csv.Error) as error:
        raise ValueError(f"body file {shown(str(path))} cannot be read: {one_line(error)}") from None
    missing = [name for name in COLUMNS if name not in found]
    if missing:
        raise ValueError(
            f"body file {shown(str(path))} must have columns {', '.join(COLUMNS)}; {', '.join(missing)} missing"
        )
    return {name: found[name] for name in COLUMNS}


def _archive(path: Path) -> dict[str, np.ndarray]:
    try:
        with np.load(path) as data:
            return {name: data[name] for name in data.files}
    except (TypeError, ValueError, EOFError, BadZipFile, zlib.error, RuntimeError, KeyError):
        raise ValueError("it is not an .npz archive of section data") from None


def _table(path: Path) -> dict[str, np.ndarray]:
    with path.open(newline="", encoding="utf-8-sig") as file:
        rows = csv.reader(file, strict=True)
        names = [name.strip() for name in next(rows, [])]
        if not names:
            raise ValueError("it is empty")
        table = []
        try:
            for row in filter(None, rows):
                if len(row) != len(names):
                    raise ValueError("its rows are not as long as its header")
                table.append([_number(name, cell) for name, cell in zip(names, row, strict=True)])
        except (ValueError, csv.Error) as error:
            raise ValueError(f"line {rows.line_num}: {error}") from None
    return dict(zip(names, np.array(table, dtype=float).reshape(-1, len(names)).T, strict=True))


def _number(name: str, cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        raise ValueError(f"{name} must be a number, got {shown(cell)}") from None
