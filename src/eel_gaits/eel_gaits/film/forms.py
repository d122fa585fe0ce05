# SPDX-License-Identifier: Apache-2.0
"""The forms of files of tracked points. Each gives points by animal, in the file's unit of length.

    time_s, point, x_mm, y_mm                  a row for each point; all rows of one time are a frame, head first
    time_s, x0_m, y0_m, x1_m, y1_m ...         a row for each frame
    scorer / bodyparts / coords                DeepLabCut (.csv, and .h5 where h5py is installed)
    scorer / individuals / bodyparts / coords  the same, of several animals
    track, frame_idx, instance.score, nose.x   SLEAP's analysis (.csv, and .h5 likewise)

A unit after the last _ of a column counts as the file's. The trackers' points are in pixels, and their time in frames.
"""

import array
import itertools
import math
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from eel_base.files.archive import MOST_NUMBERS
from eel_base.files.input_file import Misplaced
from eel_base.wording import shown

from eel_gaits.film.hdf5 import Columns, read_hdf5
from eel_gaits.sources.tables import LARGEST, csv_rows

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}  # metres in each; pixels have no length
COORDINATE = re.compile(r"m?([xy])_?([0-9]*)_?(m|cm|mm|px)?")  # x, y_mm, x0_m; mxmm of fishmechr
TIME = re.compile(r"(?:time|t)(?:_(s|ms))?")
TRACK = "track"  # SLEAP's column of names
LIKELY = 0.6  # likelihood of a DeepLabCut point below which it counts as missing, as there


class Tracks(NamedTuple):
    """Points of one or several animals in N frames."""

    time: np.ndarray  # (N,) s; frame numbers where `frames`
    animals: dict[str, np.ndarray]  # (N, n, 2) of each, NaN where missing
    names: dict[str, list[str]]  # of its points, in the file's order
    unit: str  # of length; "" where the file does not tell
    frames: bool  # whether time is a number of frames, and the points are parts of a tracker's skeleton
    notes: tuple[str, ...]  # what was done, in words


class Cells:
    """The cells of a table as numbers; those of the column `track` as texts, each kept once.

    head: names of the columns. rows: line and cells of each row.
    """

    def __init__(self, head: list[str], rows: Iterable[tuple[int, list[str]]]) -> None:
        self.head, self.tracks = head, list[str]()
        self._lines, values, names = array.array("q"), array.array("d"), dict[str, str]()
        self._bad: dict[int, tuple[int, str]] = {}  # the first cell of a column that is no number, and its row
        track = head.index(TRACK) if TRACK in head else -1
        for line, row in rows:
            for column, cell in enumerate(map(str.strip, row)):
                try:
                    values.append(math.nan if cell.lower() in ("", "na", "nan") else float(cell))
                except ValueError:
                    values.append(math.nan)
                    self._bad.setdefault(column, (len(self._lines), cell))
                if column == track:
                    self.tracks.append(names.setdefault(cell, cell))
            self._lines.append(line)
        self._values = np.frombuffer(values).reshape(len(self._lines), len(head))

    def __len__(self) -> int:
        return len(self._lines)

    def error(self, row: int, text: str) -> Misplaced:
        """An error in this row."""
        return Misplaced(f"line {self._lines[row]}", text)

    def numbers(self, columns: list[int]) -> np.ndarray:
        """The numbers (rows, columns); NaN for an empty cell, NA or nan."""
        for column in columns:
            if column in self._bad:
                row, cell = self._bad[column]
                raise self.error(row, f"{self.head[column]} must be a number, got {shown(cell)}")
        found = self._values[:, columns]
        if len(large := np.argwhere(np.abs(found) > LARGEST)):
            row, place = large[0]
            rule = f"{self.head[columns[place]]} must be at most {LARGEST:g}"
            raise self.error(row, f"{rule}, got {found[row, place]:g}")
        return found

    def check_rising(self, time: np.ndarray, rows: np.ndarray) -> None:
        """`ValueError` where the `time` of these rows does not rise."""
        if fall := _fall_of(time[rows]):
            raise self.error(rows[fall[0]], fall[1])


def _fall_of(time: np.ndarray) -> tuple[int, str] | None:
    """The first place at which `time` does not rise, and an error's text."""
    if not len(back := np.flatnonzero(np.diff(time) <= 0.0)):
        return None
    before, after = time[back[0]], time[back[0] + 1]
    return back[0] + 1, f"time must rise, got {after:g} after {before:g}: two animals in one file?"


def read_tracks(path: Path) -> Tracks:
    """The points in a .csv or .h5 file. `ValueError` names line, column and value of what does not fit."""
    if path.suffix == ".h5":
        return _of_hdf(path)
    if path.suffix != ".csv":
        raise ValueError("tracked points must be in a .csv or .h5 file")
    rows = csv_rows(path)
    _, head = next(rows, (0, []))
    if not head:
        raise ValueError("it is empty")
    head = [name.strip() for name in head]
    if head[0] == "scorer":
        return _of_deeplabcut(rows)
    cells = Cells(head, rows)
    if not len(cells):
        raise ValueError("it has a header and no row")
    return _of_sleap(cells) if "frame_idx" in head else _of_columns(cells)


def _of_columns(cells: Cells) -> Tracks:
    head = cells.head
    times = [index for index, name in enumerate(head) if TIME.fullmatch(name)]
    found = {index: m for index, name in enumerate(head) if (m := COORDINATE.fullmatch(name))}
    places = {(m[1], m[2]): index for index, m in found.items()}
    marks = [number for axis, number in places if axis == "x" and ("y", number) in places]
    if len(times) != 1 or not marks or ("" in marks and len(marks) > 1):
        raise ValueError(
            "its columns must be time, x, y (perhaps with a unit: time_s, x_mm), or time, x0, y0, x1, y1 ..., "
            f"or those of DeepLabCut or SLEAP, got {shown(head)}"
        )
    units = {found[index][3] or "" for index in places.values()}
    if len(units) > 1:
        raise ValueError(f"its columns must have one unit of length, got {shown(sorted(units))}")
    marks.sort(key=lambda number: int(number or 0))
    time = cells.numbers(times)[:, 0] * (1e-3 if head[times[0]].endswith("_ms") else 1.0)
    if len(unknown := np.flatnonzero(~np.isfinite(time))):
        raise cells.error(unknown[0], "time is missing")
    points = cells.numbers([places[axis, number] for number in marks for axis in "xy"])
    starts = np.arange(len(time))
    if marks == [""]:
        starts = np.concatenate(([0], np.flatnonzero(np.diff(time)) + 1))
    cells.check_rising(time, starts)
    if marks == [""]:
        marks = _names_in_frames(cells, starts)
    return Tracks(time[starts], {"": points.reshape(len(starts), -1, 2)}, {"": marks}, units.pop(), False, ())


def _names_in_frames(cells: Cells, starts: np.ndarray) -> list[str]:
    """The names of the points, as the column `point` has them, or their numbers.

    `ValueError` where the frames that begin at the rows `starts` do not have the same points in the same order.
    """
    sizes = np.diff(np.append(starts, len(cells)))
    if len(other := np.flatnonzero(sizes != sizes[0])):
        raise cells.error(starts[other[0]], f"a frame of {sizes[other[0]]} points, the first has {sizes[0]}")
    if "point" not in cells.head:
        return [str(place + 1) for place in range(sizes[0])]
    order = cells.numbers([cells.head.index("point")]).reshape(len(starts), -1)
    if len(np.unique(order[0])) < sizes[0]:
        raise cells.error(0, "a point stands twice in one frame: two animals? Give the rows of one")
    if np.any(order != order[0]):
        frame = int(np.argmax(np.any(order != order[0], axis=1)))
        raise cells.error(starts[frame], "its points are in another order than in the first frame")
    return [f"{each:g}" for each in order[0]]


def _of_deeplabcut(rows: Iterator[tuple[int, list[str]]]) -> Tracks:
    names: dict[str, list[str]] = {}
    for first in rows:
        if first[1][0].strip() not in ("individuals", "bodyparts", "coords"):
            rows = itertools.chain([first], rows)
            break
        names[first[1][0].strip()] = first[1][1:]
    if not {"bodyparts", "coords"} <= names.keys():
        raise ValueError("a DeepLabCut file must have the header lines scorer, bodyparts and coords")
    head = ["frame", *(f"{part} {what}" for part, what in zip(names["bodyparts"], names["coords"], strict=True))]
    cells = Cells(head, rows)
    if not len(cells):
        raise ValueError("it has a header and no row")
    values = cells.numbers(list(range(len(head))))
    animals = names.get("individuals", [""] * (len(head) - 1))
    return _of_parts(values[:, 0], list(zip(animals, names["bodyparts"], names["coords"], strict=True)), values[:, 1:])


def _of_parts(frames: np.ndarray, names: list[tuple[str, str, str]], values: np.ndarray) -> Tracks:
    """Tracks of DeepLabCut's columns, each with the names of (animal, body part, x, y or likelihood)."""
    column = {name: index for index, name in enumerate(names)}
    animals, unlikely, parts_of = {}, 0, dict[str, list[str]]()
    for animal, part in dict.fromkeys(name[:2] for name in names):
        parts_of.setdefault(animal, []).append(part)
    for animal, parts in parts_of.items():
        points = np.full((len(frames), len(parts), 2), np.nan)
        for place, part in enumerate(parts):
            if not {(animal, part, "x"), (animal, part, "y")} <= column.keys():
                raise ValueError(f"body part {shown(part)} must have x and y")
            points[:, place] = values[:, [column[animal, part, "x"], column[animal, part, "y"]]]
            if (index := column.get((animal, part, "likelihood"))) is not None:
                bad = ~(values[:, index] >= LIKELY) & np.isfinite(points[:, place, 0])
                points[bad, place] = np.nan
                unlikely += int(bad.sum())
        animals[animal] = points
    if fall := _fall_of(frames):
        raise ValueError(fall[1])
    notes = (f"{unlikely} points of a likelihood below {LIKELY} count as missing",) if unlikely else ()
    return Tracks(frames, animals, parts_of, "px", True, notes)


def _of_hdf(path: Path) -> Tracks:
    found = read_hdf5(path)
    for values in [found.values] if isinstance(found, Columns) else found.tracks.values():
        if np.any(np.abs(values) > LARGEST):
            raise ValueError(f"its numbers must be at most {LARGEST:g}")
    if isinstance(found, Columns):
        return _of_parts(found.frames, found.names, found.values)
    frames = np.arange(len(next(iter(found.tracks.values()), [])), dtype=float)
    return Tracks(frames, found.tracks, dict.fromkeys(found.tracks, found.parts), "px", True, ())


def _of_sleap(cells: Cells) -> Tracks:
    head = cells.head
    parts = [name[:-2] for name in head if name.endswith(".x") and f"{name[:-2]}.y" in head]
    if not parts:
        raise ValueError(f"a SLEAP file must have columns such as nose.x, nose.y, got {shown(head)}")
    frame = cells.numbers([head.index("frame_idx")])[:, 0]
    points = cells.numbers([head.index(f"{part}.{axis}") for part in parts for axis in "xy"])
    rows_of: dict[str, list[int]] = {}
    for row, track in enumerate(cells.tracks or [""] * len(cells)):
        rows_of.setdefault(track, []).append(row)
    frames, animals = np.unique(frame), {}
    if 2 * len(rows_of) * len(frames) * len(parts) > MOST_NUMBERS:
        raise ValueError(f"its {len(rows_of)} tracks and {len(frames)} frames make more than {MOST_NUMBERS} numbers")
    for track, mine in rows_of.items():
        if len(set(frame[mine])) < len(mine):
            twice = next(place for before, place in itertools.pairwise(mine) if frame[place] <= frame[before])
            raise cells.error(twice, "a track has two instances in one frame: two animals? Track them")
        animals[track] = np.full((len(frames), len(parts), 2), np.nan)
        animals[track][np.searchsorted(frames, frame[mine])] = points[mine].reshape(len(mine), len(parts), 2)
    return Tracks(frames, animals, dict.fromkeys(animals, parts), "px", True, ())
