# SPDX-License-Identifier: Apache-2.0
"""The forms of files of tracked points. Each gives points by animal, in the file's unit of length.

    time_s, point, x_mm, y_mm                  a row for each point; all rows of one time are a frame, head first
    time_s, x0_m, y0_m, x1_m, y1_m ...         a row for each frame
    scorer / bodyparts / coords                DeepLabCut (.csv, and .h5 where pandas and PyTables are installed)
    scorer / individuals / bodyparts / coords  the same, of several animals
    track, frame_idx, instance.score, nose.x   SLEAP's analysis .csv

A unit after the last _ of a column counts as the file's. The trackers' points are in pixels, and their time in frames.
"""

import itertools
import re
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from eel_base.files.input_file import InputFile, Misplaced
from eel_base.wording import one_line, shown

from eel_gaits.sources.tables import LARGEST, MOST_BYTES, csv_rows

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}  # metres in each; pixels have no length
COORDINATE = re.compile(r"m?([xy])_?([0-9]*)_?(m|cm|mm|px)?")  # x, y_mm, x0_m; mxmm of fishmechr
TIME = re.compile(r"(?:time|t)(?:_(s|ms))?")
LIKELY = 0.6  # likelihood of a DeepLabCut point below which it counts as missing, as there


class Tracks(NamedTuple):
    """Points of one or several animals in N frames."""

    time: np.ndarray  # (N,) s; frame numbers where `frames`
    animals: dict[str, np.ndarray]  # (N, n, 2) of each, NaN where missing
    names: dict[str, list[str]]  # of its points, in the file's order
    unit: str  # of length; "" where the file does not tell
    frames: bool  # whether time is a number of frames, and the points are parts of a tracker's skeleton
    notes: tuple[str, ...]  # what was done, in words


class Cells(NamedTuple):
    """The names of the columns, and the line and the cells of each row."""

    head: list[str]
    rows: list[tuple[int, list[str]]]

    def error(self, row: int, text: str) -> Misplaced:
        """An error in this row."""
        return Misplaced(f"line {self.rows[row][0]}", text)

    def numbers(self, columns: list[int]) -> np.ndarray:
        """The numbers (rows, columns); NaN for an empty cell, NA or nan."""
        found = np.empty((len(self.rows), len(columns)))
        for place, (_, row) in enumerate(self.rows):
            for column, index in enumerate(columns):
                cell = row[index].strip()
                try:
                    value = np.nan if cell.lower() in ("", "na", "nan") else float(cell)
                except ValueError:
                    raise self.error(place, f"{self.head[index]} must be a number, got {shown(cell)}") from None
                if abs(value) > LARGEST:
                    raise self.error(place, f"{self.head[index]} must be at most {LARGEST:g}, got {cell}")
                found[place, column] = value
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
    rows = list(csv_rows(path))
    if len(rows) < 2:
        raise ValueError("it has a header and no row" if rows else "it is empty")
    cells = Cells([name.strip() for name in rows[0][1]], rows[1:])
    if cells.head[0] == "scorer":
        return _of_deeplabcut(cells)
    return _of_sleap(cells) if "frame_idx" in cells.head else _of_columns(cells)


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
    sizes = np.diff(np.append(starts, len(cells.rows)))
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


def _of_deeplabcut(cells: Cells) -> Tracks:
    names = {row[0].strip(): row[1:] for _, row in cells.rows[:3]}
    names = {name: row for name, row in names.items() if name in ("individuals", "bodyparts", "coords")}
    if not {"bodyparts", "coords"} <= set(names):
        raise ValueError("a DeepLabCut file must have the header lines scorer, bodyparts and coords")
    body = cells.rows[len(names) :]
    if not body:
        raise ValueError("it has a header and no row")
    head = ["frame", *(f"{part} {what}" for part, what in zip(names["bodyparts"], names["coords"], strict=True))]
    values = Cells(head, body).numbers(list(range(len(head))))
    animals = names.get("individuals", [""] * (len(head) - 1))
    return _of_parts(values[:, 0], list(zip(animals, names["bodyparts"], names["coords"], strict=True)), values[:, 1:])


def _of_parts(frames: np.ndarray, names: list[tuple[str, str, str]], values: np.ndarray) -> Tracks:
    """Tracks of DeepLabCut's columns, each with the names of (animal, body part, x, y or likelihood)."""
    column = {name: index for index, name in enumerate(names)}
    animals, parts_of, unlikely = {}, {}, 0
    for animal in dict.fromkeys(name[0] for name in names):
        parts = list(dict.fromkeys(name[1] for name in names if name[0] == animal))
        points = np.full((len(frames), len(parts), 2), np.nan)
        for place, part in enumerate(parts):
            if not {(animal, part, "x"), (animal, part, "y")} <= set(names):
                raise ValueError(f"body part {shown(part)} must have x and y")
            points[:, place] = values[:, [column[animal, part, "x"], column[animal, part, "y"]]]
            if (index := column.get((animal, part, "likelihood"))) is not None:
                bad = ~(values[:, index] >= LIKELY) & np.isfinite(points[:, place, 0])
                points[bad, place] = np.nan
                unlikely += int(bad.sum())
        animals[animal], parts_of[animal] = points, parts
    if fall := _fall_of(frames):
        raise ValueError(fall[1])
    notes = (f"{unlikely} points of a likelihood below {LIKELY} count as missing",) if unlikely else ()
    return Tracks(frames, animals, parts_of, "px", True, notes)


def _of_hdf(path: Path) -> Tracks:
    try:
        import_module("tables")  # what pandas reads .h5 with
        pandas = import_module("pandas")
    except ImportError:
        raise ValueError(
            "an .h5 file of DeepLabCut needs pandas and PyTables (pip install pandas tables); its .csv needs neither"
        ) from None
    with InputFile(path, MOST_BYTES):
        pass
    try:
        return tracks_of_frame(pandas.read_hdf(path))
    except Exception as error:  # PyTables' own, KeyError, and what its pickles raise
        raise ValueError(f"it cannot be read as HDF5 of DeepLabCut: {one_line(error)}") from None


def tracks_of_frame(frame: Any) -> Tracks:
    """Tracks of DeepLabCut's `pandas.DataFrame`: columns of the levels scorer, (individuals,) bodyparts, coords."""
    levels = list(frame.columns.names)
    if levels[-2:] != ["bodyparts", "coords"]:
        raise ValueError(f"a DeepLabCut table must have columns of scorer, bodyparts and coords, got {shown(levels)}")
    names = [(name[1] if len(name) == 4 else "", name[-2], name[-1]) for name in frame.columns]
    return _of_parts(np.arange(len(frame), dtype=float), names, frame.to_numpy(dtype=float))


def _of_sleap(cells: Cells) -> Tracks:
    head = cells.head
    parts = [name[:-2] for name in head if name.endswith(".x") and f"{name[:-2]}.y" in head]
    if not parts:
        raise ValueError(f"a SLEAP file must have columns such as nose.x, nose.y, got {shown(head)}")
    frame = cells.numbers([head.index("frame_idx")])[:, 0]
    points = cells.numbers([head.index(f"{part}.{axis}") for part in parts for axis in "xy"])
    tracks = [row[head.index("track")].strip() if "track" in head else "" for _, row in cells.rows]
    frames, animals = np.unique(frame), {}
    for track in dict.fromkeys(tracks):
        mine = [place for place, name in enumerate(tracks) if name == track]
        if len(set(frame[mine])) < len(mine):
            twice = next(place for before, place in itertools.pairwise(mine) if frame[place] <= frame[before])
            raise cells.error(twice, "a track has two instances in one frame: two animals? Track them")
        animals[track] = np.full((len(frames), len(parts), 2), np.nan)
        animals[track][np.searchsorted(frames, frame[mine])] = points[mine].reshape(len(mine), len(parts), 2)
    return Tracks(frames, animals, dict.fromkeys(animals, parts), "px", True, ())
