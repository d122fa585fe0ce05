# SPDX-License-Identifier: Apache-2.0
"""File formats of tracked points. Each gives points by animal, in the file's unit of length.

    time_s, point, x_mm, y_mm                  a row for each point; all rows of one time are a frame, head first
    time_s, x0_m, y0_m, x1_m, y1_m ...         a row for each frame
    scorer / bodyparts / coords                DeepLabCut (.csv, and .h5 where h5py is installed)
    scorer / individuals / bodyparts / coords  the same, for several animals
    track, frame_idx, instance.score, nose.x   SLEAP's analysis (.csv, and .h5 likewise)

A unit after the last _ of a column's name applies to the file. Trackers give points in pixels, and time in frames.
"""

import itertools
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from eel_common.files.archive import MOST_NUMBERS
from eel_common.files.table import LARGEST, LISTED, UNITS, Table, split_name
from eel_common.files.tables import SUFFIXES, is_table, read_table
from eel_common.files.times import is_time, time_of
from eel_common.wording import shown

from eel_gaits.film.hdf5 import Columns, read_hdf5
from eel_gaits.sources.frames import check_rising, check_steps, frame_starts

LENGTHS = {unit: metres for unit, (si, metres) in UNITS.items() if si == "m"}  # NaN for pixels, which have no length
SHORT = ", ".join(words.split()[0] for words in LISTED["m"].values())  # their names, for messages
COORDINATE = re.compile(  # x, x0, head_x, x_head, each before a unit; mxmm in fishmechr
    rf"m?(?P<axis>[xy])_?(?P<number>[0-9]*)(?P<unit>{'|'.join(LENGTHS)})?|"
    r"(?P<name>.+)[._](?P<last>[xy])|(?P<first>[xy])[._](?P<part>.+)"
)
SCORE = re.compile(r"(?:(?P<before>.+?)[._]?)?(?:likelihood|score|confidence)(?:[._]?(?P<after>.+))?")
FRAMES = "frame", "frames", "image"  # names of a column of frame numbers
TRACK = "track"  # SLEAP's column of names


class Tracks(NamedTuple):
    """Points of one or several animals in N frames."""

    time: np.ndarray  # (N,) s; frame numbers where `frames`
    animals: dict[str, np.ndarray]  # (N, n, 2) of each, NaN where missing
    names: dict[str, list[str]]  # names of its points, in the file's order
    unit: str  # of length; "" if unknown
    frames: bool  # whether time counts frames; then points belong to a tracker's skeleton
    scores: dict[str, np.ndarray]  # (N, n) of each: likelihoods of DeepLabCut, scores of SLEAP; NaN without one
    read: str = ""  # what was guessed of the file's form, in words


def read_tracks(path: Path, time: str = "") -> Tracks:
    """The points in a table of text or an .h5 file. `ValueError` names line, column and value of an error.

    time: the column of times, if its name is not recognised.
    """
    if path.suffix.lower() == ".h5":
        return _counted(time, _of_hdf(path))
    if not is_table(path):
        raise ValueError(f"tracked points must be in a table ({', '.join(SUFFIXES)}) or an .h5 file")
    table = read_table(path)
    rows = {row[0].lower(): list(row[1:]) for row in table.heads}
    if "scorer" in rows:
        return _counted(time, _of_deeplabcut(table, rows))
    return _counted(time, _of_sleap(table)) if "frame_idx" in table.head else _of_columns(table, time)


def _counted(time: str, tracks: Tracks) -> Tracks:
    """A tracker's `tracks`, checked. `ValueError` for a column of times, a frame without number, or repeated names."""
    if time:
        raise ValueError(f"a tracker's file counts frames: a column of times has no place, got {shown(time)}")
    if len(bad := np.flatnonzero(~np.isfinite(tracks.time))):
        raise ValueError(f"each frame must have a number, got {tracks.time[bad[0]]:g} in row {bad[0] + 1}")
    if len(back := np.flatnonzero(np.diff(tracks.time) <= 0.0)):
        raise ValueError(f"its frames must rise, got {tracks.time[back[0] + 1]:g} after {tracks.time[back[0]]:g}")
    for names in tracks.names.values():
        if twice := next((name for name in names if names.count(name) > 1), None):
            raise ValueError(f"a point must stand in the columns once, got {shown(twice)} twice")
    return tracks


def _of_columns(table: Table, column: str) -> Tracks:
    names = [split_name(name) for name in table.head]
    found = {place: m for place, (name, _) in enumerate(names) if (m := COORDINATE.fullmatch(name))}
    places: dict[tuple[str, str], int] = {}
    twice: dict[str, list[str]] = {}  # columns of one coordinate
    for place, m in found.items():
        mark = m["number"] or m["name"] or m["part"] or ""
        first = places.setdefault((m["axis"] or m["last"] or m["first"], mark), place)
        if first != place:
            twice[mark] = [table.head[first], table.head[place]]
    marks = [mark for axis, mark in places if axis == "x" and ("y", mark) in places]
    marks = [mark for mark in marks if not mark or mark.isdigit()] or marks  # other names may be means or errors
    if not marks or ("" in marks and len(marks) > 1):
        raise ValueError(
            "its columns must be time, x, y (perhaps with a unit: time_s, x_mm), or time, x0, y0, x1, y1 ..., "
            f"or those of DeepLabCut or SLEAP, got {shown(table.head)}"
        )
    if both := next((twice[mark] for mark in marks if mark in twice), None):
        raise ValueError(
            f"a coordinate must stand in one column, got {shown(both)}: two animals? Give the columns of one"
        )
    used = [places[axis, mark] for mark in marks for axis in "xy"]
    units = {table.unit(place) or found[place]["unit"] or "" for place in used}
    if len(units) > 1:
        raise ValueError(f"its columns must have one unit of length, got {shown(sorted(units))}")
    if all(map(str.isdigit, marks)):
        marks.sort(key=int)
    points = table.numbers([places[axis, mark] for mark in marks for axis in "xy"]).reshape(len(table), -1, 2)
    values = np.concatenate((points, _scores(table, marks, used)[..., None]), axis=2)
    frames = [place for place, (name, _) in enumerate(names) if name in FRAMES]
    timed = column or not frames or any(map(is_time, table.head))
    times = time_of(table, column, besides=[*used, *frames]) if timed else None
    time = table.numbers(frames[:1], missing=False)[:, 0] if times is None else times
    if marks == [""] and "point" in table:
        time, values, marks = _by_point(table, time, values[:, 0])
    elif marks == [""]:
        starts = frame_starts(table, time)
        time, values = time[starts], values.reshape(len(starts), -1, 3)
        marks = [str(place + 1) for place in range(values.shape[1])]
    else:
        check_rising(table, time, np.arange(len(time)))
    if times is not None:
        check_steps(table, time, 2)
    scores, read = {"": values[..., 2]}, ", ".join(table.notes)
    return Tracks(time, {"": values[..., :2]}, {"": marks}, units.pop(), times is None, scores, read)


def _scores(table: Table, marks: list[str], used: list[int]) -> np.ndarray:
    """Scores (rows, marks) in the columns not `used`; NaN for a mark without one. Other columns go into the notes."""
    found, told, other = np.full((len(table), len(marks)), np.nan), dict[str, int](), list[str]()
    for place, name in enumerate(table.head):
        if place in used or not (m := SCORE.fullmatch(split_name(name)[0])):
            continue
        mark = m["before"] or m["after"] or ""
        mark = "" if marks == [""] and mark == "point" else mark
        if mark not in marks:
            other.append(name)
        elif (first := told.setdefault(mark, place)) != place:
            raise ValueError(f"a score must stand in one column, got {shown([table.head[first], name])}")
    found[:, [marks.index(mark) for mark in told]] = table.numbers(list(told.values()))
    if other:
        table.notes.append(f"no scores from {shown(other)}, which name no point")
    return found


def _by_point(table: Table, time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Instants (N,), the `values` x, y, score (rows, 3) of points as (N, n, 3), NaN for missing rows, and the points'
    names in the order of the fullest frame.

    `ValueError` if the time of a point does not rise.
    """
    names, last = table.texts(table.places("point")[0]), dict[str, int]()
    for row, name in enumerate(names):
        before = last.get(name, row)
        if time[row] < time[before]:
            got = f"got {time[row]:g} s after {time[before]:g} s"
            raise table.error(f"the time of a point must rise, {got}: two animals in one file?", before, row)
        if before < row and time[row] == time[before]:
            raise table.error("a point stands twice in one frame: two animals? Give the rows of one", before, row)
        last[name] = row
    instants, frame = np.unique(time, return_inverse=True)
    order = [names[row] for row in np.flatnonzero(frame == np.argmax(np.bincount(frame)))]
    if len(order) < len(last):
        raise table.error(f"no frame has all its points: {shown(list(last))}")
    if 2 * len(instants) * len(order) > MOST_NUMBERS:
        raise ValueError(f"its {len(order)} points and {len(instants)} frames make more than {MOST_NUMBERS} numbers")
    place = {name: index for index, name in enumerate(order)}
    found = np.full((len(instants), len(order), 3), np.nan)
    found[frame, [place[name] for name in names]] = values
    return instants, found, order


def _of_deeplabcut(table: Table, rows: dict[str, list[str]]) -> Tracks:
    if not {"bodyparts", "coords"} <= rows.keys():
        raise ValueError("a DeepLabCut file must have the header lines scorer, bodyparts and coords")
    frames, values = table.numbers([0], missing=False)[:, 0], table.numbers(range(1, len(table.head)))
    animals = rows.get("individuals", [""] * len(rows["coords"]))
    names = list(zip(animals, rows["bodyparts"], rows["coords"], strict=True))[: values.shape[1]]
    return _of_parts(frames, names, values)._replace(read=", ".join(table.notes))


def _of_parts(frames: np.ndarray, names: list[tuple[str, str, str]], values: np.ndarray) -> Tracks:
    """Tracks from DeepLabCut's columns, whose `names` are (animal, body part, x, y or likelihood)."""
    column = {name: index for index, name in enumerate(names)}
    if len(column) < len(names):
        twice = next(name for index, name in enumerate(names) if column[name] != index)
        raise ValueError(f"a coordinate must stand in one column, got {shown('/'.join(filter(None, twice)))} twice")
    animals, scores, parts_of = {}, {}, dict[str, list[str]]()
    for animal, part in dict.fromkeys(name[:2] for name in names):
        parts_of.setdefault(animal, []).append(part)
    for animal, parts in parts_of.items():
        points = np.full((len(frames), len(parts), 2), np.nan)
        scores[animal] = np.full((len(frames), len(parts)), np.nan)
        for place, part in enumerate(parts):
            if not {(animal, part, "x"), (animal, part, "y")} <= column.keys():
                raise ValueError(f"body part {shown(part)} must have x and y")
            points[:, place] = values[:, [column[animal, part, "x"], column[animal, part, "y"]]]
            if (index := column.get((animal, part, "likelihood"))) is not None:
                scores[animal][:, place] = values[:, index]
        animals[animal] = points
    return Tracks(frames, animals, parts_of, "px", True, scores)


def _of_hdf(path: Path) -> Tracks:
    found = read_hdf5(path)
    for values in [found.values] if isinstance(found, Columns) else found.tracks.values():
        if np.any(np.abs(values) > LARGEST):
            raise ValueError(f"its numbers must be at most {LARGEST:g}")
    if isinstance(found, Columns):
        return _of_parts(found.frames, found.names, found.values)
    frames = np.arange(len(next(iter(found.tracks.values()), [])), dtype=float)
    return Tracks(frames, found.tracks, dict.fromkeys(found.tracks, found.parts), "px", True, found.scores)


def _of_sleap(table: Table) -> Tracks:
    head = table.head
    parts = [name[:-2] for name in head if name.endswith(".x") and f"{name[:-2]}.y" in head]
    if not parts:
        raise ValueError(f"a SLEAP file must have columns such as nose.x, nose.y, got {shown(head)}")
    frame = table.numbers([head.index("frame_idx")], missing=False)[:, 0]
    points = table.numbers([head.index(f"{part}.{axis}") for part in parts for axis in "xy"])
    told = [place for place, part in enumerate(parts) if f"{part}.score" in head]
    score = table.numbers([head.index(f"{parts[place]}.score") for place in told])
    rows_of: dict[str, list[int]] = {}
    tracks = table.texts(head.index(TRACK)) if TRACK in head else [""] * len(table)
    for row, track in enumerate(tracks):
        rows_of.setdefault(track, []).append(row)
    frames, animals, scores = np.unique(frame), {}, {}
    if 2 * len(rows_of) * len(frames) * len(parts) > MOST_NUMBERS:
        raise ValueError(f"its {len(rows_of)} tracks and {len(frames)} frames make more than {MOST_NUMBERS} numbers")
    for track, mine in rows_of.items():
        if len(set(frame[mine])) < len(mine):
            twice = next(place for before, place in itertools.pairwise(mine) if frame[place] <= frame[before])
            raise table.error("a track has two instances in one frame: two animals? Track them", twice)
        here = np.searchsorted(frames, frame[mine])
        animals[track] = np.full((len(frames), len(parts), 2), np.nan)
        animals[track][here] = points[mine].reshape(len(mine), len(parts), 2)
        scores[track] = np.full((len(frames), len(parts)), np.nan)
        scores[track][here[:, None], told] = score[mine]
    return Tracks(frames, animals, dict.fromkeys(animals, parts), "px", True, scores, ", ".join(table.notes))
