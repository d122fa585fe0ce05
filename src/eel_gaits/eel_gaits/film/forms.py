# SPDX-License-Identifier: Apache-2.0
"""The forms of files of tracked points. Each gives points by animal, in the file's unit of length.

    time_s, point, x_mm, y_mm                  a row for each point; all rows of one time are a frame, head first
    time_s, x0_m, y0_m, x1_m, y1_m ...         a row for each frame
    scorer / bodyparts / coords                DeepLabCut (.csv, and .h5 where pandas and PyTables are installed)
    scorer / individuals / bodyparts / coords  the same, of several animals
    track, frame_idx, instance.score, nose.x   SLEAP's analysis .csv

A unit after the last _ of a column counts as the file's. The trackers' points are in pixels, and their time in frames.
"""

import csv
import io
import itertools
import re
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from eel_base.files.input_file import InputFile, Misplaced
from eel_base.wording import one_line, shown

from eel_gaits.sources.tables import LARGEST, MOST_BYTES, MOST_NUMBERS, lines_of

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}  # metres in each; pixels have no length
COORDINATE = re.compile(r"m?([xy])_?([0-9]*)_?(m|cm|mm|px)?")  # x, y_mm, x0_m; mxmm of fishmechr
TIME = re.compile(r"(?:time|t)(?:_(s|ms))?")
LIKELY = 0.6  # likelihood of a DeepLabCut point below which it counts as missing, as there


class Tracks(NamedTuple):
    """Points of one or several animals in N frames."""

    time: np.ndarray  # (N,) s; frame numbers where `frames`
    animals: dict[str, np.ndarray]  # (N, n, 2) of each, NaN where missing
    unit: str  # of length; "" where the file does not tell
    frames: bool  # whether time is a number of frames
    notes: tuple[str, ...]  # what was done, in words


def read_tracks(path: Path) -> Tracks:
    """The points in a .csv or .h5 file. `ValueError` names line, column and value of what does not fit."""
    if path.suffix == ".h5":
        return _of_hdf(path)
    if path.suffix != ".csv":
        raise ValueError("tracked points must be in a .csv or .h5 file")
    rows = _rows(path)
    head = [name.strip() for name in rows[0][1]]
    if head[0] == "scorer":
        return _of_deeplabcut(rows)
    if "frame_idx" in head:
        return _of_sleap(head, rows[1:])
    return _of_columns(head, rows[1:])


def _rows(path: Path) -> list[tuple[int, list[str]]]:
    """Line numbers and cells, without empty lines; each as long as the first."""
    found, count = [], 0
    with InputFile(path, MOST_BYTES) as file, io.TextIOWrapper(file, encoding="utf-8-sig", newline="") as text:
        rows = csv.reader(lines_of(text), strict=True)
        for row in filter(None, rows):
            found.append((rows.line_num, row))
            count += len(row)
            if len(row) != len(found[0][1]):
                rule = f"a row must have {len(found[0][1])} fields, as the header has"
                raise Misplaced(f"line {rows.line_num}", f"{rule}, got {len(row)}")
            if count > MOST_NUMBERS:
                raise ValueError(f"a table must hold at most {MOST_NUMBERS} numbers")
    if len(found) < 2:
        raise ValueError("it has a header and no row" if found else "it is empty")
    return found


def _numbers(head: list[str], rows: list[tuple[int, list[str]]], columns: list[int]) -> np.ndarray:
    """The numbers (rows, columns); NaN for an empty cell, NA or nan."""
    found = np.empty((len(rows), len(columns)))
    for place, (line, row) in enumerate(rows):
        for column, index in enumerate(columns):
            cell = row[index].strip()
            try:
                found[place, column] = np.nan if cell.lower() in ("", "na", "nan") else float(cell)
            except ValueError:
                raise Misplaced(f"line {line}", f"{head[index]} must be a number, got {shown(cell)}") from None
    bad = np.argwhere(np.abs(found) > LARGEST)
    if len(bad):
        line, index = rows[bad[0][0]][0], columns[bad[0][1]]
        raise Misplaced(f"line {line}", f"{head[index]} must be at most {LARGEST:g}, got {rows[bad[0][0]][1][index]}")
    return found


def _of_columns(head: list[str], rows: list[tuple[int, list[str]]]) -> Tracks:
    times = [index for index, name in enumerate(head) if TIME.fullmatch(name)]
    places = {(m[1], m[2]): index for index, name in enumerate(head) if (m := COORDINATE.fullmatch(name))}
    marks = [number for axis, number in places if axis == "x" and ("y", number) in places]
    if len(times) != 1 or not marks or ("" in marks and len(marks) > 1):
        raise ValueError(
            "its columns must be time, x, y (perhaps with a unit: time_s, x_mm), or time, x0, y0, x1, y1 ..., "
            f"or those of DeepLabCut or SLEAP, got {shown(head)}"
        )
    units = {COORDINATE.fullmatch(head[index])[3] or "" for index in places.values()}  # type: ignore[index]
    if len(units) > 1:
        raise ValueError(f"its columns must have one unit of length, got {shown(sorted(units))}")
    marks.sort(key=lambda number: int(number or 0))
    columns = [places[axis, number] for number in marks for axis in "xy"]
    time = _numbers(head, rows, times)[:, 0] * (1e-3 if head[times[0]].endswith("_ms") else 1.0)
    unknown = np.flatnonzero(~np.isfinite(time))
    if len(unknown):
        raise Misplaced(f"line {rows[unknown[0]][0]}", "time is missing")
    values = _numbers(head, rows, columns).reshape(len(rows), len(marks), 2)
    if marks == [""]:
        time, values = _framed(head, rows, time, values[:, 0])
    else:
        _check_rising(time, [line for line, _ in rows])
    return Tracks(time, {"": values}, units.pop(), False, ())


def _framed(
    head: list[str], rows: list[tuple[int, list[str]]], time: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Time (N,) and points (N, n, 2) of rows that hold a point each."""
    starts = np.concatenate(([0], np.flatnonzero(np.diff(time)) + 1))
    _check_rising(time[starts], [rows[start][0] for start in starts])
    sizes = np.diff(np.append(starts, len(time)))
    other = np.flatnonzero(sizes != sizes[0])
    if len(other):
        line = rows[starts[other[0]]][0]
        raise Misplaced(f"line {line}", f"a frame of {sizes[other[0]]} points, the first has {sizes[0]}")
    if "point" in head:
        order = _numbers(head, rows, [head.index("point")]).reshape(len(starts), -1)
        if len(np.unique(order[0])) < sizes[0]:
            line = rows[starts[0]][0]
            raise Misplaced(f"line {line}", "a point stands twice in one frame: two animals? Give the rows of one")
        if np.any(order != order[0]):
            frame = int(np.argmax(np.any(order != order[0], axis=1)))
            raise Misplaced(f"line {rows[starts[frame]][0]}", "its points are in another order than in the first frame")
    return time[starts], points.reshape(len(starts), -1, 2)


def _check_rising(time: np.ndarray, lines: list[int] | None = None) -> None:
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if len(back):
        text = f"time must rise, got {time[back[0] + 1]:g} after {time[back[0]]:g}: two animals in one file?"
        raise Misplaced(f"line {lines[back[0] + 1]}", text) if lines else ValueError(text)


def _of_deeplabcut(rows: list[tuple[int, list[str]]]) -> Tracks:
    names = {row[0].strip(): row[1:] for _, row in rows[:4] if row[0].strip() in ("individuals", "bodyparts", "coords")}
    if not {"bodyparts", "coords"} <= set(names):
        raise ValueError("a DeepLabCut file must have the header lines scorer, bodyparts and coords")
    body = rows[1 + len(names) :]
    if not body:
        raise ValueError("it has a header and no row")
    head = ["frame", *(f"{part} {what}" for part, what in zip(names["bodyparts"], names["coords"], strict=True))]
    values = _numbers(head, body, list(range(len(head))))
    animals = names.get("individuals", [""] * (len(head) - 1))
    return _of_parts(values[:, 0], list(zip(animals, names["bodyparts"], names["coords"], strict=True)), values[:, 1:])


def _of_parts(frames: np.ndarray, names: list[tuple[str, str, str]], values: np.ndarray) -> Tracks:
    """Tracks of DeepLabCut's columns, each with the names of (animal, body part, x, y or likelihood)."""
    column = {name: index for index, name in enumerate(names)}
    animals, unlikely = {}, 0
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
        animals[animal] = points
    _check_rising(frames)
    notes = (f"{unlikely} points of a likelihood below {LIKELY} count as missing",) if unlikely else ()
    return Tracks(frames, animals, "px", True, notes)


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


def _of_sleap(head: list[str], rows: list[tuple[int, list[str]]]) -> Tracks:
    parts = [name[:-2] for name in head if name.endswith(".x") and f"{name[:-2]}.y" in head]
    if not parts:
        raise ValueError(f"a SLEAP file must have columns such as nose.x, nose.y, got {shown(head)}")
    frame = _numbers(head, rows, [head.index("frame_idx")])[:, 0]
    points = _numbers(head, rows, [head.index(f"{part}.{axis}") for part in parts for axis in "xy"])
    tracks = [row[head.index("track")].strip() if "track" in head else "" for _, row in rows]
    frames, animals = np.unique(frame), {}
    for track in dict.fromkeys(tracks):
        mine = [place for place, name in enumerate(tracks) if name == track]
        if len(set(frame[mine])) < len(mine):
            twice = next(place for before, place in itertools.pairwise(mine) if frame[place] <= frame[before])
            raise Misplaced(f"line {rows[twice][0]}", "a track has two instances in one frame: two animals? Track them")
        animals[track] = np.full((len(frames), len(parts), 2), np.nan)
        animals[track][np.searchsorted(frames, frame[mine])] = points[mine].reshape(len(mine), len(parts), 2)
    return Tracks(frames, animals, "px", True, ())
