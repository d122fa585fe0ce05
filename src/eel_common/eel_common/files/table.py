# SPDX-License-Identifier: Apache-2.0
"""A table read from a file: numbers by column name, in SI units. Errors name line and column.

A name may end in its unit: time_ms, "t [ms]", x(mm), yawDeg, "Zeit / s".
"""

import math
import re
import warnings
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np

from eel_common.wording import did_you_mean, shown

LARGEST = 1e100  # of a number: squares and products of a few are finite
MISSING = ("", "na", "n/a", "#n/a", "null", "none", "-")  # cells without a value
LISTED = {
    "s": {1.0: "s sec secs second seconds", 1e-3: "ms msec msecs millis millisec millisecond milliseconds",
          1e-6: "us usec usecs micros microsec microsecond microseconds",
          1e-9: "ns nsec nsecs nanos nanosec nanosecond nanoseconds",
          60.0: "min mins minute minutes", 3600.0: "h hr hrs hour hours"},
    "m": {1.0: "m meter meters metre metres",  # codespell:ignore meters
          1e-2: "cm centimeter centimeters centimetre centimetres",
          1e-3: "mm millimeter millimeters millimetre millimetres",
          1e-6: "um micrometer micrometers micrometre micrometres micron microns",
          1e3: "km kilometer kilometers kilometre kilometres", 0.0254: "inch inches", math.nan: "px pixel pixels"},
    "rad": {1.0: "rad rads radian radians", 1e-3: "mrad mrads milliradian milliradians",
            math.pi / 180.0: "deg degs degree degrees °"},
    "m/s": {1.0: "m/s", 1e-2: "cm/s", 1e-3: "mm/s"},
    "rad/m": {1.0: "rad/m 1/m", 1e3: "rad/mm 1/mm"},
    "kg/m": {1.0: "kg/m", 1e-3: "g/m"},
}  # fmt: skip
UNITS = {word: (si, by) for si, words in LISTED.items() for by, each in words.items() for word in each.split()}
NAME = re.compile(rf"(.*?)(?:^|[_./])({'|'.join(map(re.escape, sorted(UNITS, key=len, reverse=True)))})")
BRACKETS = re.compile(r"[\[(]\s*([^\[\]()]*?)\s*[\])]")
LARGEST_ANGLE = 3.2  # rad, of a joint: with a larger angle the file is in degrees
INDEX = re.compile(r"\w*\d")  # in brackets: the number or name of a joint, not a unit


def split_name(name: str) -> tuple[str, str]:
    """A column's name in lower case without its unit, and that unit, or ""."""
    name = name.strip().lstrip("%").replace("μ", "u").replace("µ", "u")
    known = next((each for each in BRACKETS.finditer(name) if each[1].lower() in UNITS), None)
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", f"{name[: known.start()]} {name[known.end() :]}" if known else name)
    plain = re.sub(r"\s*/\s+|\s+/\s*|[\s\[\](){}_]+", "_", name).strip("_").lower()
    if known:
        return plain.rstrip("_./"), known[1].lower()
    found = NAME.fullmatch(plain)
    return (found[1].rstrip("_./"), found[2]) if found and plain not in ("s", "h") else (plain, "")


class Table:
    """Columns of equal length, named by `head` (columns,), and the place of each row in the file.

    values (rows, columns): NaN where a cell is no number. marks (rows, columns): 0 for a number, else 1 + the index of
    the cell's text in `words`. lines (rows,): line in the file; None: rows count from 1. heads: all rows of the header.
    notes: guesses made while reading, in words. lost: lines of rows that were left out. what: begins an error, before
    the file's name.
    """

    def __init__(
        self,
        path: Path,
        head: Sequence[str],
        values: np.ndarray,
        marks: np.ndarray | None = None,
        words: Sequence[str] = (),
        lines: np.ndarray | None = None,
        heads: Sequence[Sequence[str]] = (),
        notes: Sequence[str] = (),
        lost: Sequence[int] = (),
        what: str = "",
    ) -> None:
        self.path, self.head, self.heads, self.notes = path, list(head), heads, list(notes)
        self.lost, self._what = lost, what
        self._values, self._words = values, ["", *words]
        self._marks = np.broadcast_to(np.int32(0), values.shape) if marks is None else marks
        self._empty = np.array([False, *(word.lower() in MISSING for word in words)])
        self.word = "row" if lines is None else "line"
        self.lines = np.arange(1, len(values) + 1) if lines is None else lines

    def __len__(self) -> int:
        return len(self._values)

    def __contains__(self, name: str) -> bool:
        return bool(self.places(name))

    def error(self, text: str, first: int | None = None, last: int | None = None) -> ValueError:
        """An error about rows `first` to `last` (indices). It names the file and their lines before `text`."""
        place = "" if first is None else f", {self.word} {self.lines[first]}"
        if first is not None and last is not None and last != first:
            place = f", {self.word}s {self.lines[first]} to {self.lines[last]}"
        return ValueError(f"{self._what}{shown(str(self.path))}{place}: {text}")

    def tell(self) -> None:
        """Warn of the guesses, if any."""
        if self.notes:
            warnings.warn(f"{self._what}{shown(str(self.path))} is read with {', '.join(self.notes)}", stacklevel=3)

    # -- columns

    def places(self, name: str) -> list[int]:
        """Indices of the columns of this `name`: an exact match, or else one without unit and case."""
        exact = [place for place, each in enumerate(self.head) if each == name]
        return exact or [place for place, each in enumerate(self.head) if split_name(each)[0] == name.lower()]

    def chosen(self, text: str, what: str) -> list[int]:
        """Indices of the columns named by a `text`: numbers from 1 ("8-13,15"), names, or patterns ("*Fbck*").

        `ValueError` if it names none, or one twice. what: begins the error.
        """
        found: list[int] = []
        for part in map(str.strip, text.split(",")):
            span = re.fullmatch(r"(\d+)(?:-(\d+))?", part)
            named = self.places(part) or [at for at, name in enumerate(self.head) if fnmatchcase(name, part)]
            if span and span[2] and self.places(span[1]) and self.places(span[2]):  # numbers that are names
                ends = int(span[1]), int(span[2])
                numbers = [(int(name), at) for at, name in enumerate(self.head) if name.isdecimal()]
                named = [at for number, at in sorted(numbers) if ends[0] <= number <= ends[1]]
            elif span and not named:
                named = list(range(int(span[1]) - 1, min(int(span[2] or span[1]), len(self.head) + 1)))
            if not named or min(named) < 0 or max(named) >= len(self.head) or set(named) & set(found):
                hint = did_you_mean(part, self.head)
                rule = f"{what} must name columns among the {len(self.head)} of the file, each once"
                raise self.error(f"{rule}, got {shown(part)}{hint}; there are {shown(self.head)}")
            found += named
        return found

    def label(self, place: int) -> str:
        """The name of a column, for messages."""
        return f"column {self.head[place]}" if self.head[place].isdigit() else self.head[place] or f"column {place + 1}"

    def unit(self, place: int) -> str:
        """The unit in a column's name, or "". `ValueError` for an unknown one in brackets."""
        unit, name = split_name(self.head[place])[1], self.head[place]
        others = [each for each in BRACKETS.findall(name) if each and not INDEX.fullmatch(each)]
        if others and (not unit or not any(unit in split_name(f"[{each}]") for each in others)):
            raise self.error(f"{self.label(place)} must have a known unit in brackets, got {shown(others[-1])}")
        return unit

    def numbers(
        self, columns: Sequence[int], unit: str = "", *, missing: bool = True, largest: float = LARGEST
    ) -> np.ndarray:
        """The numbers (rows, columns) in this SI `unit`; "": as in the file. missing: NaN for an empty cell.

        `ValueError` names the first cell that is no number, is not finite (unless `missing`), or exceeds `largest`.
        """
        factors = [self.factor(place, unit) for place in columns]
        found, marks = self._values[:, list(columns)] * factors, self._marks[:, list(columns)]
        bad = (marks > 0) & ~(missing & self._empty[marks])
        if len(where := np.argwhere(bad)):
            row, place = where[0]
            got = shown(self._words[marks[row, place]])
            raise self.error(f"{self.label(columns[place])} must be a number, got {got}", row)
        if len(where := np.argwhere(~(np.abs(found) <= largest) & ~(missing & np.isnan(found)))):
            row, place = where[0]
            rule = f"at most {largest:g}" if np.isfinite(found[row, place]) else "finite"
            raise self.error(f"{self.label(columns[place])} must be {rule}, got {found[row, place]:g}", row)
        return found

    def column(self, name: str, unit: str = "", largest: float = LARGEST) -> np.ndarray:
        """The numbers (rows,) of the one column of this `name`, in this SI `unit`. Errors as in `numbers`."""
        if len(places := self.places(name)) != 1:
            raise self.error(f"there must be one column {name}, got {len(places)} in {shown(self.head)}")
        return np.asarray(self.numbers(places, unit, missing=False, largest=largest)[:, 0])

    def texts(self, place: int) -> list[str]:
        """The cells (rows,) of a column as texts."""
        cells = zip(self._marks[:, place].tolist(), self._values[:, place].tolist(), strict=True)
        return [self._words[mark] if mark else f"{value:.12g}" for mark, value in cells]

    def raw(self, place: int) -> np.ndarray:
        """The finite numbers (rows,) of a column as they stand in the file; NaN for any other cell."""
        return np.where(np.isfinite(self._values[:, place]), self._values[:, place], np.nan)

    def filled(self, place: int) -> np.ndarray:
        """Which cells (rows,) of a column have a value."""
        marks = self._marks[:, place]
        return np.asarray(np.where(marks == 0, np.isfinite(self._values[:, place]), ~self._empty[marks]))

    def has_numbers(self, place: int) -> bool:
        """Whether most cells of a column that have a value are numbers."""
        return bool(2 * np.sum(np.isfinite(self._values[:, place])) > np.sum(self.filled(place)))

    def check_units(self, columns: Sequence[int]) -> None:
        """`ValueError` if some of the `columns` have a unit in their names and others have none."""
        bare = [place for place in columns if not self.unit(place)]
        if 0 < len(bare) < len(columns):
            other = next(place for place in columns if place not in bare)
            rule = f"must have a unit in its name, as {self.label(other)} has, or none of them"
            raise self.error(f"{self.label(bare[0])} {rule}")

    def factor(self, place: int, unit: str) -> float:
        """The factor from a column's unit to this SI `unit`; 1 if its name has no unit."""
        if not unit or not (given := self.unit(place)):
            return 1.0
        dimension, factor = UNITS[given]
        if dimension != unit or math.isnan(factor):
            raise self.error(f"{self.label(place)} must be in {unit}, or units of it, got {given}")
        return factor
