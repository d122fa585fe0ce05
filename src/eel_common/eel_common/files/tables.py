# SPDX-License-Identifier: Apache-2.0
"""Reads a table of text, or the columns of an .npz archive. Errors name file and line.

The separator (commas, semicolons, tabs, bars or blanks), decimal commas, the encoding and the header are recognised
from the first lines. The header is the last row of names above the numbers. A row of units may stand below it, other
lines above. Rows that begin with # are comments, except spreadsheet errors: #REF!. Ambiguous numbers are refused.
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

from eel_common.files.archive import MOST_NUMBERS, read_archive
from eel_common.files.input_file import InputFile, Misplaced, is_number, number_of, reading
from eel_common.files.table import MISSING, UNITS, Table
from eel_common.wording import shown

SUFFIXES = ".csv", ".tsv", ".txt", ".dat"  # of tables of text, in any case
MOST_BYTES, MOST_LINES, LONGEST_LINE, MOST_COLUMNS = 200_000_000, 5_000_000, 1_000_000, 10_000
FIRST_LINES, FIRST_CHARACTERS = 200, 1_000_000  # from which the form is recognised
DELIMITERS = {";": "semicolons", "\t": "tabs", ",": "commas", "|": "bars", " ": "blanks"}
TRACKER = "scorer", "individuals", "bodyparts", "coords"  # rows of DeepLabCut's header, whose names may be numbers
WITH_COMMA, WITH_POINT = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?"), re.compile(r"[+-]?\d*\.\d+(?:[eE][+-]?\d+)?")
THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
SPREADSHEETS = re.compile(r"#(?:n/a|[a-z]+[/0-9]*[!?])", re.IGNORECASE)  # errors in the cells of their tables
SWAPPED = str.maketrans(",.", ".,")
Row = tuple[list[str], int, int]  # cells up to the last non-empty one; the row's line; its number of cells


def is_table(path: str | os.PathLike[str], *others: str) -> bool:
    """Whether a file's suffix is that of a text table, or one of the `others`."""
    return Path(path).suffix.lower() in (*SUFFIXES, *others)


def read_table(path: str | os.PathLike[str], what: str = "", *, lenient: bool = False) -> Table:
    """The table in a file. `ValueError` in one line, with the line number, if it cannot be read.

    what: begins an error, before the file's name, such as "body file ". lenient: leave out rows of a different length.
    """
    path = Path(path)
    with reading(f"{what}{shown(str(path))}"):
        if path.suffix.lower() == ".npz":
            columns = _flat(read_archive(path))
            return Table(path, list(columns), np.stack(list(columns.values()), axis=1), what=what)
        with InputFile(path, MOST_BYTES) as file:
            return _read(path, file, what, lenient)


def _flat(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Arrays as columns. Beside (N, n), `time` (N,) is repeated n times a row, and an (n,) for each row."""
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
    values, marks, lines = array.array("d"), array.array("i"), array.array("q")
    words, lost = dict[str, int](), list[int]()
    encoding = _encoding(file)
    with io.TextIOWrapper(file, encoding=encoding, newline="") as text:
        rest, first = _lines(text), list[str]()
        while len(first) < FIRST_LINES and sum(map(len, first)) < FIRST_CHARACTERS and (each := next(rest, "")):
            first.append(each)
        delimiter, comma = _form(first)
        names, heads, start, notes = _head(list(_split(first, delimiter, strict=False)))
        width = len(names)
        plain = array.array("i", bytes(4 * width))
        for cells, line, size in _split(itertools.chain(first, rest), delimiter):
            fits = len(cells) <= width <= size
            if line < start or (cells[0].startswith("#") and not SPREADSHEETS.fullmatch(cells[0])):
                continue
            if len(values) + width > MOST_NUMBERS:
                raise Misplaced(f"line {line}", f"a table must hold at most {MOST_NUMBERS} numbers")
            if not fits and not lenient:
                rule = f"a row must have {width} fields, as the header has, got {max(len(cells), size)}"
                raise Misplaced(f"line {line}", rule)
            if not fits:
                lost.append(line)
                continue
            cells += [""] * (width - len(cells))
            made = [cell.translate(SWAPPED) for cell in cells] if comma else cells
            lines.append(line)
            try:
                values.extend(list(map(float if "_" not in "".join(made) else number_of, made)))
                marks.extend(plain)
            except ValueError:
                for cell, number in zip(cells, made, strict=True):
                    known = is_number(number)
                    values.append(float(number) if known else np.nan)
                    marks.append(0 if known else words.setdefault(cell, len(words) + 1))
    if not lines:
        raise ValueError(f"it has a header and no row of {width} cells")
    read = [DELIMITERS[delimiter]] if delimiter != "," else []
    read += ["decimal commas"] if comma else []
    read += [] if encoding.startswith("utf-8") else [encoding]
    return Table(
        path,
        names,
        np.frombuffer(values).reshape(-1, width),
        np.frombuffer(marks, dtype=np.int32).reshape(-1, width),
        list(words),
        np.frombuffer(lines, dtype=np.int64),
        heads=heads,
        notes=[*read, *notes],
        lost=lost,
        what=what,
    )


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
    """The lines of an open `text`. Their number and length are bounded."""
    for _ in range(MOST_LINES):
        line = text.readline(LONGEST_LINE)
        if not line:
            return
        if len(line) == LONGEST_LINE:
            raise ValueError(f"a line must be shorter than {LONGEST_LINE} characters")
        yield line
    raise ValueError(f"a table must have fewer than {MOST_LINES} lines")


def _split(lines: Iterable[str], delimiter: str, strict: bool = True) -> Iterator[Row]:
    """The non-empty rows. `Misplaced` for wrong quotes, if `strict`."""
    if delimiter == " ":
        lines = (" ".join(re.sub(r"^\s*([#%])\s+", r"\1", line).split()) + "\n" for line in lines)
    rows = csv.reader(lines, delimiter=delimiter, skipinitialspace=True, strict=strict)
    try:
        for row in rows:
            cells = [cell.strip() for cell in row]
            while cells and not cells[-1]:
                cells.pop()
            if cells:
                yield cells, rows.line_num, len(row)
    except csv.Error as error:
        if strict:
            raise Misplaced(f"line {rows.line_num}", str(error)) from None


def _form(first: list[str]) -> tuple[str, bool]:
    """The separator that yields most numbers, and whether these have decimal commas."""
    score, found = dict[str, tuple[float, float]](), dict[str, list[str]]()
    for delimiter in DELIMITERS:
        rows = list(_split(first, delimiter, strict=False))
        if (usual := _usual(size for _, _, size in rows)) > 1:
            whole = [cells for cells, _, size in rows if size == usual]
            found[delimiter] = [cell for row in whole for cell in row if cell.lower() not in MISSING]
            alike = len(whole) / len(rows)
            score[delimiter] = alike * _part_of_numbers(found[delimiter]), alike
    delimiter = max(score, key=lambda each: score[each], default=",")
    commas = [cell for cell in found.get(delimiter, []) if WITH_COMMA.fullmatch(cell)]
    comma = len(commas) > sum(WITH_POINT.fullmatch(cell) is not None for cell in found.get(delimiter, []))
    if comma and delimiter != ";" and all(map(THOUSANDS.fullmatch, commas)):
        raise ValueError(f"{shown(commas[0])} may have a decimal comma or one of thousands: write it without")
    return delimiter, comma


def _part_of_numbers(cells: Iterable[str]) -> float:
    """The fraction of the non-empty cells that are numbers."""
    filled = [cell for cell in cells if cell.lower() not in MISSING]
    return sum(map(_is_number, filled)) / max(1, len(filled))


def _is_number(cell: str) -> bool:
    """Whether a cell is a number, with a decimal comma or point."""
    return is_number(cell) or WITH_COMMA.fullmatch(cell) is not None


def _counted(cells: Iterable[str]) -> bool:
    """Whether the numbers among the cells are names in sequence, such as 1, 2, 3."""
    numbers = [cell for cell in cells if _is_number(cell)]
    whole = len(numbers) > 1 and all(len(cell) < 6 and cell.isdecimal() for cell in numbers)
    return whole and len(set(numbers)) == len(numbers) == int(max(numbers, key=int)) - int(min(numbers, key=int)) + 1


def _usual(sizes: Iterable[int]) -> int:
    """The most frequent size, the first of equals; 0 without any."""
    return max(Counter(sizes).items(), key=lambda each: each[1], default=(0, 0))[0]


def _head(first: list[Row]) -> tuple[list[str], list[list[str]], int, list[str]]:
    """The names of the columns, all rows of the header, the line after it, and the guesses made.

    A header row has names where the columns have numbers. The first header row may also have a few numbers, or numbers
    in sequence.
    """
    if not first:
        raise ValueError("it is empty")
    usual = _usual(size for _, _, size in first)
    whole = [cells for cells, _, size in first if size == usual]
    columns = list(itertools.zip_longest(*whole[len(whole) // 2 :], fillvalue=""))
    numeric = {place for place, cells in enumerate(columns) if _part_of_numbers(cells) >= 0.5}
    rows, skipped, start = list[list[str]](), list[Row](), 0
    for row in first:
        cells, line, size = row
        there = [cell for place, cell in enumerate(cells) if place in numeric or not numeric]
        there = [cell for cell in there if cell.lower() not in MISSING]
        names = sum(not _is_number(cell) for cell in there)
        mostly = not rows and (2 * names > len(there) or _counted(there))
        loose = numeric and (mostly or cells[0].lower() in TRACKER)
        if size != usual and len(cells) != len(columns):
            skipped += [] if rows else [row]
        elif names and (names == len(there) or loose):
            rows.append([cells[0].lstrip("#% "), *cells[1:]])
            start = line + 1
        elif not cells[0].startswith("#"):
            start = start or line
            break
    if not rows and skipped and len(last := skipped[-1][0]) > 1 and not any(map(_is_number, last)):
        hint = ": decimal commas need another separator" if usual > len(last) else ""
        raise Misplaced(f"line {skipped[-1][1]}", f"{len(last)} names stand above {usual} numbers{hint}")
    notes = [f"{len(skipped)} lines above left out"] if skipped else []
    if not rows:
        return [str(place + 1) for place in range(len(columns))], rows, start, [*notes, "no header"]
    *above, names_row = rows
    width = max(len(names_row), len(columns))
    if width > MOST_COLUMNS:
        raise Misplaced(f"line {start - 1}", f"there must be at most {MOST_COLUMNS} columns, got {width}")
    units = [cell.strip("[]()") for cell in names_row]
    if above and all(unit.lower() in (*UNITS, "") for unit in units):
        both = itertools.zip_longest(above[-1], units, fillvalue="")
        names_row = [f"{name} [{unit}]" if unit else name for name, unit in both]
    return names_row + [""] * (width - len(names_row)), rows, start, notes
