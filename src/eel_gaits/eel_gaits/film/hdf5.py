# SPDX-License-Identifier: Apache-2.0
"""Tracked points in HDF5: DeepLabCut's tables, as pandas writes them by PyTables, and SLEAP's analysis files.

A pandas table holds its numbers in blocks, which are plain data sets. In the `fixed` format the column names are plain
too: levels, and for each column an index into each level. In the `table` format they are a pickled list in an
attribute, which is read as text and never unpickled.
"""

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from eel_common.files.archive import MOST_NUMBERS
from eel_common.files.hdf5 import MOST_NAMES, attribute_text, members, names_in, numbers_of, opened_hdf5, texts_of
from eel_common.files.tables import MOST_BYTES
from eel_common.wording import shown

LEVELS = 3, 4  # levels of the column names: scorer, perhaps individuals, bodyparts, coords
MATLAB = "track", "xy", "node", "frame"  # axes of SLEAP's points, if the file does not name them
EXPORT = "export it as .csv"


class Columns(NamedTuple):
    """DeepLabCut's table: frames (N,), names (animal, body part, x, y or likelihood) of the columns, values (N, n)."""

    frames: np.ndarray
    names: list[tuple[str, str, str]]
    values: np.ndarray


class Skeletons(NamedTuple):
    """SLEAP's points (N, n, 2) and scores (N, n) by the names of tracks, and the names of the points (n,)."""

    tracks: dict[str, np.ndarray]
    scores: dict[str, np.ndarray]
    parts: list[str]


def read_hdf5(path: Path) -> Columns | Skeletons:
    """The contents of the .h5 file. `ValueError` for anything else, and for parts that need unpickling."""
    with opened_hdf5(path, MOST_BYTES) as file:
        found = members(file)
        if {"tracks", "node_names"} <= set(found):
            return _of_sleap(found)
        for group in found.values():
            kind = attribute_text(group, "pandas_type")
            if kind == b"frame_table":
                return _of_columns(*_of_table(members(group).get("table")))
            if kind == b"frame":
                return _of_columns(*_of_blocks(group))
        rule = "it must hold a table of DeepLabCut (pandas_type), or tracks and node_names of SLEAP"
        raise ValueError(f"{rule}, got {shown(sorted(found))}")


def _of_sleap(found: dict[str, Any]) -> Skeletons:
    parts, points = texts_of(found["node_names"]), numbers_of(found["tracks"]).astype(float)
    said = attribute_text(found["tracks"], "dims")
    axes = [str(each) for each in json.loads(said)] if said else list(MATLAB)
    order = [next((place for place, name in enumerate(axes) if word in name), -1) for word in MATLAB]
    if points.ndim != 4 or sorted(order) != [0, 1, 2, 3]:
        raise ValueError(f"tracks must have the axes {', '.join(MATLAB)}, got {shown(axes)} of shape {points.shape}")
    points = points.transpose(order)  # (tracks, 2, n, N)
    if points.shape[1] != 2 or points.shape[2] != len(parts):
        raise ValueError(f"tracks must be of x and y of {len(parts)} nodes, got the shape {points.shape}")
    names = texts_of(found["track_names"]) if "track_names" in found else []
    names = names or [""] * min(1, len(points))  # without tracking there is one unnamed track
    if len(names) != len(points) or len(set(names)) < len(names):
        raise ValueError(f"each track must have a name of its own, got {len(points)} tracks and {shown(names)}")
    tracks = {name: each.transpose(2, 1, 0) for name, each in zip(names, points, strict=True)}
    if "point_scores" not in found:
        return Skeletons(tracks, {}, parts)
    scores, xy = numbers_of(found["point_scores"]).astype(float), order[1]
    if scores.ndim == 3:
        scores = scores.transpose([place - (place > xy) for place in order if place != xy])  # (tracks, n, N)
    if scores.shape != points[:, 0].shape:
        raise ValueError(f"point_scores must be one of each point, got the shape {scores.shape}")
    return Skeletons(tracks, {name: each.T for name, each in zip(names, scores, strict=True)}, parts)


def _of_table(table: Any) -> tuple[np.ndarray, list[tuple[str, ...]], np.ndarray]:
    if table is None or not table.dtype.names:
        raise ValueError(f"its table is missing: {EXPORT}")
    rows, names, blocks = numbers_of(table), list[tuple[str, ...]](), list[np.ndarray]()
    for field in table.dtype.names:
        if field.startswith("values_block_"):
            names += names_in(attribute_text(table, f"{field}_kind"))
            blocks.append(rows[field].reshape(len(rows), -1))
    return _frames(rows["index"] if "index" in table.dtype.names else None, len(rows)), names, _side_by_side(blocks)


def _of_blocks(group: Any) -> tuple[np.ndarray, list[tuple[str, ...]], np.ndarray]:
    found, names, blocks = members(group), list[tuple[str, ...]](), list[np.ndarray]()
    while f"block{len(blocks)}_values" in found:
        block = f"block{len(blocks)}"
        levels = [place for place in range(max(LEVELS) + 1) if f"{block}_items_level{place}" in found]
        texts = [texts_of(found[f"{block}_items_level{place}"]) for place in levels]
        marks = [numbers_of(found[f"{block}_items_label{place}"], MOST_NAMES).tolist() for place in levels]
        if any(not 0 <= mark < len(text) for text, row in zip(texts, marks, strict=True) for mark in row):
            raise ValueError(f"the names of its columns are damaged: {EXPORT}")
        names += [tuple(text[mark] for text, mark in zip(texts, row, strict=True)) for row in zip(*marks, strict=True)]
        values = numbers_of(found[f"{block}_values"])
        blocks.append(values if found[f"{block}_values"].attrs.get("transposed", False) else values.T)
    values = _side_by_side(blocks)
    index = numbers_of(found["axis1"]) if "axis1" in found and found["axis1"].dtype.kind in "iu" else None
    return _frames(index, len(values)), names, values


def _frames(index: np.ndarray | None, count: int) -> np.ndarray:
    """The frame numbers (N,): the index, if it holds numbers."""
    return np.arange(count, dtype=float) if index is None or index.shape != (count,) else index.astype(float)


def _side_by_side(blocks: list[np.ndarray]) -> np.ndarray:
    if not blocks or any(each.ndim != 2 or len(each) != len(blocks[0]) for each in blocks):
        raise ValueError(f"it holds no block of numbers, or those of several tables: {EXPORT}")
    if sum(each.size for each in blocks) > MOST_NUMBERS:
        raise ValueError(f"a table must hold at most {MOST_NUMBERS} numbers")
    return np.concatenate(blocks, axis=1).astype(float)


def _of_columns(frames: np.ndarray, names: list[tuple[str, ...]], values: np.ndarray) -> Columns:
    """The columns, checked. `ValueError` unless each has a name of DeepLabCut's levels."""
    if len(names) != values.shape[1] or any(len(name) not in LEVELS for name in names):
        rule = "a DeepLabCut table must have columns of scorer, (individuals,) bodyparts and coords"
        raise ValueError(f"{rule}, got {shown(names[:3])}: {EXPORT}")
    return Columns(frames, [(name[1] if len(name) == 4 else "", name[-2], name[-1]) for name in names], values)
