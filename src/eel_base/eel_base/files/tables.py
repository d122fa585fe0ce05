# SPDX-License-Identifier: Apache-2.0
"""Reads a table of text, or the columns of an .npz archive. Errors name file and line.

What separates the cells (commas, semicolons, tabs, bars or blanks), whether numbers have decimal commas, the encoding
and the header are told from the first lines. A header is the last row of names above the numbers; a row of units may
stand below it, other lines above. Lines that begin with # are no rows. Numbers that may mean two things are refused.
"""

import array
import codecs
import csv
import io
import itertools
import os
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from eel_base.files.archive import MOST_NUMBERS, read_archive
from eel_base.files.input_file import InputFile, Misplaced, is_number, reading
from eel_base.files.table import MISSING, UNITS, Table
from eel_base.wording import shown

SUFFIXES = ".csv", ".tsv", ".txt", ".dat"  # of tables of text, in any case
MOST_BYTES, MOST_LINES, LONGEST_LINE, MOST_COLUMNS = 200_000_000, 5_000_000, 1_000_000, 10_000
FIRST_LINES, FIRST_CHARACTERS = 200, 1_000_000  # that tell the form
DELIMITERS = {";": "semicolons", "\t": "tabs", ",": "commas", "|": "bars", " ": "blanks"}
TRACKER = ("scorer", "individuals", "bodyparts", "coords")  # rows of DeepLabCut's header, whose names may be numbers
WITH_COMMA, WITH_POINT = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?"), re.compile(r"[+-]?\d*\.\d+(?:[eE][+-]?\d+)?")
THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
SWAPPED = str.maketrans(",.", ".,")
Row = tuple[int, list[str]]  # its line, and its cells


def is_table(path: str | os.PathLike[str], *others: str) -> bool:
    """Whether a file's name ends as a table of text does, or in one of the `others`."""
    return Path(path).suffix.lower() in (*SUFFIXES, *others)


def read_table(path: str | os.PathLike[str], what: str = "", *, lenient: bool = False) -> Table:
    """The table in a file. `ValueError` in one line, with the line, for what cannot be read.

    what: begins an error, before the file's name, such as "body file ". lenient: leave out rows of another length.
    """
    path = Path(path)
    with reading(f"{what}{shown(str(path))}"):
        if path.suffix.lower() == ".npz":
            columns = _flat(read_archive(path))
            return Table(path, list(columns), np.stack(list(columns.values()), axis=1), what=what)
        with InputFile(path, MOST_BYTES) as file:
            return _read(path, file, what, lenient)


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


def _read(path: Path, file: InputFile, what: str, lenient: bool) -> Table:
    encoding = _encoding(file)
    with io.TextIOWrapper(file, encoding=encoding, newline="") as text:
        lines = _lines(text)
        first = _first(lines)
        delimiter, comma = _form(first)
        head = _Head(list(_split(first, delimiter, strict=False)))
        cells, lost = _Cells(head.width, comma), list[int]()
        for line, row in _split(itertools.chain(first, lines), delimiter):
            while len(row) > head.width and not row[-1]:
                row.pop()
            if line < head.start or (row[0].startswith("#") and len(row) != head.width):
                continue
            if len(row) == head.width:
                cells.add(line, row)
            elif lenient:
                lost.append(line)
            else:
                hint = ": numbers with decimal commas, in quotes?" if delimiter == "," and not comma else ""
                rule = f"a row must have {head.width} fields, as the header has, got {len(row)}{hint}"
                raise Misplaced(f"line {line}", rule)
    if not cells.lines and not lost:
        raise ValueError("it has a header and no row")
    notes = [
        *([DELIMITERS[delimiter]] if delimiter != "," else []),
        *(["decimal commas"] if comma else []),
        *([] if encoding.startswith("utf-8") else [encoding]),
        *head.notes,
    ]
    return cells.table(path, head, notes, lost, what)


def _encoding(file: InputFile) -> str:
    beginning = file.read(min(file.size, FIRST_CHARACTERS))
    file.seek(0)
    if beginning.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    try:
        codecs.getincrementaldecoder("utf-8")().decode(beginning)
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8-sig"


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


def _first(lines: Iterator[str]) -> list[str]:
    """The lines that tell the form."""
    found, left = list[str](), FIRST_CHARACTERS
    while len(found) < FIRST_LINES and left > 0 and (line := next(lines, "")):
        found.append(line)
        left -= len(line)
    return found


def _split(lines: Iterable[str], delimiter: str, strict: bool = True) -> Iterator[Row]:
    """The rows that are not empty. `Misplaced` for quotes that are not as they should be, if `strict`."""
    if delimiter == " ":
        lines = (" ".join(re.sub(r"^\s*([#%])\s+", r"\1", line).split()) + "\n" for line in lines)
    rows = csv.reader(lines, delimiter=delimiter, skipinitialspace=True, strict=strict)
    try:
        for row in rows:
            cells = [cell.strip() for cell in row]
            if any(cells):
                yield rows.line_num, cells
    except csv.Error as error:
        if strict:
            raise Misplaced(f"line {rows.line_num}", str(error)) from None


def _form(first: list[str]) -> tuple[str, bool]:
    """What separates the cells: that which gives most numbers; and whether these have decimal commas."""
    found = dict[str, list[str]]()
    score = dict[str, tuple[float, float]]()
    for delimiter in DELIMITERS:
        rows = [row for _, row in _split(first, delimiter, strict=False)]
        if (width := _usual(map(len, rows))) > 1:
            whole = [row for row in rows if len(row) == width]
            cells = [cell for row in whole for cell in row if cell.lower() not in MISSING]
            numbers, alike = sum(map(_is_number, cells)) / max(1, len(cells)), len(whole) / len(rows)
            found[delimiter], score[delimiter] = cells, (numbers * alike, alike)
    delimiter = max(score, key=lambda each: score[each], default=",")
    commas = [cell for cell in found.get(delimiter, []) if WITH_COMMA.fullmatch(cell)]
    comma = len(commas) > sum(WITH_POINT.fullmatch(cell) is not None for cell in found.get(delimiter, []))
    if comma and delimiter != ";" and all(map(THOUSANDS.fullmatch, commas)):
        raise ValueError(f"{shown(commas[0])} may have a decimal comma or one of thousands: write it without")
    return delimiter, comma


def _is_number(cell: str) -> bool:
    """Whether a cell is a number, with a decimal comma or point."""
    return is_number(cell) or WITH_COMMA.fullmatch(cell) is not None


def _usual(sizes: Iterable[int]) -> int:
    """The most frequent of the sizes, the first of several; 0 without any."""
    return max(Counter(sizes).items(), key=lambda each: each[1], default=(0, 0))[0]


class _Head:
    """The header of a table with these first `rows`: `names` (width,), all its rows, and the line after it."""

    def __init__(self, rows: list[Row]) -> None:
        if not rows:
            raise ValueError("it is empty")
        usual = _usual(len(row) for _, row in rows)
        whole = [row for _, row in rows if len(row) == usual]
        later = whole[len(whole) // 2 :]
        self._numeric = {place for place in range(usual) if _mostly_numbers([row[place] for row in later])}
        self.rows, self.notes, self.start, before = list[list[str]](), list[str](), 0, 0
        for line, row in rows:
            fits = usual - 1 <= len(_trimmed(row)) <= usual or len(row) == usual
            if fits and self._is_head(row, first=not self.rows):
                self.rows.append([row[0].lstrip("#% "), *row[1:]])
                self.start = line + 1
            elif fits and not row[0].startswith("#"):
                self.start = self.start or line
                break
            elif not self.rows:
                before += 1
        filled = max(len(_trimmed(row)) for row in later)
        if before and not self.rows and len(last := rows[before - 1][1]) > 1 and not any(map(_is_number, last)):
            rule = f"{len(last)} names stand above {usual} numbers"
            raise Misplaced(f"line {rows[before - 1][0]}", f"{rule}: decimal commas need another separator")
        if before:
            self.notes.append(f"{before} lines above the header left out" if self.rows else f"{before} lines left out")
        if not self.rows:
            self.width, self.names = filled, [str(place + 1) for place in range(filled)]
            self.notes.append("no header")
            return
        *above, names = self.rows
        if above and all(unit.strip("[]()").lower() in (*UNITS, "") for unit in names):
            both = itertools.zip_longest(above[-1], names, fillvalue="")
            names = [f"{name} [{unit.strip('[]()')}]" if unit else name for name, unit in both]
        self.width = max(len(_trimmed(names)), min(filled, len(names)))
        self.names = names[: self.width]
        if self.width > MOST_COLUMNS:
            raise Misplaced(f"line {self.start - 1}", f"there must be at most {MOST_COLUMNS} columns, got {self.width}")

    def _is_head(self, row: list[str], first: bool) -> bool:
        """Whether a row has names where the columns have numbers; of the `first` row one will do."""
        cells = [cell for place, cell in enumerate(row) if place in self._numeric and cell.lower() not in MISSING]
        names = [cell for cell in cells if not _is_number(cell)]
        if first and not self._numeric:
            return not any(map(_is_number, row))
        if first or row[0].lower() in TRACKER or row[0].startswith("#"):
            return bool(names)
        return bool(names) and len(names) == len(cells)


def _mostly_numbers(cells: list[str]) -> bool:
    filled = [cell for cell in cells if cell.lower() not in MISSING]
    return bool(filled) and 2 * sum(map(_is_number, filled)) >= len(filled)


def _trimmed(row: list[str]) -> list[str]:
    """The row without empty cells at its end."""
    return row[: max((place + 1 for place, cell in enumerate(row) if cell), default=0)]


class _Cells:
    """The cells of a table, row by row: numbers, and texts, each kept once."""

    def __init__(self, width: int, comma: bool) -> None:
        self._width, self._comma, self._plain = width, comma, array.array("i", bytes(4 * width))
        self._values, self._marks, self.lines = array.array("d"), array.array("i"), array.array("q")
        self._words = dict[str, int]()

    def add(self, line: int, row: list[str]) -> None:
        """Add a `row`. `ValueError` where the table becomes too large."""
        if len(self._values) + len(row) > MOST_NUMBERS:
            raise Misplaced(f"line {line}", f"a table must hold at most {MOST_NUMBERS} numbers")
        self.lines.append(line)
        made = [cell.translate(SWAPPED) for cell in row] if self._comma else row
        try:
            self._values.extend([float(cell) for cell in made])
            self._marks.extend(self._plain)
        except ValueError:
            for cell, number in zip(row, made, strict=True):
                known = is_number(number)
                self._values.append(float(number) if known else np.nan)
                self._marks.append(0 if known else self._words.setdefault(cell, len(self._words) + 1))

    def table(self, path: Path, head: _Head, notes: list[str], lost: list[int], what: str) -> Table:
        """The table of all rows."""
        values, marks = np.frombuffer(self._values), np.frombuffer(self._marks, dtype=np.int32)
        return Table(
            path,
            head.names,
            values.reshape(-1, self._width),
            marks.reshape(-1, self._width),
            list(self._words),
            np.frombuffer(self.lines, dtype=np.int64),
            heads=head.rows,
            notes=notes,
            lost=lost,
            what=what,
        )
