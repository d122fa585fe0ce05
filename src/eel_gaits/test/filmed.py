# SPDX-License-Identifier: Apache-2.0
"""Films of a swimmer whose beat is known, and files of them in the forms of laboratories and trackers."""

import json
import math
import pickle

import h5py
import numpy as np
from eel_gaits.film.beat import beat_of
from eel_gaits.film.film import read_film
from measured import midline_of, moved, write

from eel_gaits import Law, Term

WAVE = Law(Term(amplitude=(2.0, 3.0, 5.0), knots=(0.0, 0.5, 1.0), wavelength=0.7, period=0.26))
TWICE = WAVE + Law(Term(amplitude=(1.0, 2.0, 3.0), knots=(0.0, 0.5, 1.0), wavelength=0.4, period=0.13))
COUNT = 80
TIMES = 0.02 * np.arange(COUNT)
WHOLE = np.linspace(0.0, 1.0, 20)
ARC = np.linspace(0.0, 1.0, 8)  # of a film with gaps


def swimming(law=WAVE, *, noise=0.0, correlation=0.8, times=TIMES, arc=WHOLE, seed=2):
    """Points (N, n, 2) [m] of a swimmer 1 m long that drifts ahead and turns; errors that last over several frames."""
    draw, error, frames = np.random.default_rng(seed), np.zeros((len(arc), 2)), []
    for time in times:
        error = correlation * error + math.sqrt(1.0 - correlation**2) * noise * draw.normal(size=(len(arc), 2))
        frames.append(moved(midline_of(law, time, arc), time) + error)
    return np.array(frames)


def write_long(path, points, *, times=TIMES, unit="mm", factor=1e3, numbered=True):
    rows = []
    for time, frame in zip(times, points, strict=True):
        for place, point in enumerate(frame):
            cells = ["" if np.isnan(each) else each for each in (factor * point).tolist()]
            rows.append((time, *([place + 1] if numbered else []), *cells))
    suffix = f"_{unit}" if unit else ""
    return write(path, ("time_s", *(["point"] if numbered else []), f"x{suffix}", f"y{suffix}"), rows)


def write_wide(path, points):
    names = [f"{axis}{place}_m" for place in range(points.shape[1]) for axis in "xy"]
    rows = [(time, *frame.ravel().tolist()) for time, frame in zip(TIMES, points, strict=True)]
    return write(path, ("time_s", *names), rows)


def with_scores(points, scores=None):
    """Points (N, n, 2) with a third column of `scores` (N, n), 0.9 by default."""
    scores = np.full(points.shape[:2], 0.9) if scores is None else scores
    return np.concatenate((points, scores[..., None]), axis=2)


def deeplabcut_rows(animals, scores=None):
    """Header lines and rows of DeepLabCut's table of {name: points (N, n, 2)}; without names for one animal ""."""
    columns = [
        (animal, f"part{place}", what)
        for animal, points in animals.items()
        for place in range(points.shape[1])
        for what in ("x", "y", "likelihood")
    ]
    likely = [with_scores(each, scores) for each in animals.values()]
    values = np.concatenate([each.reshape(len(each), -1) for each in likely], axis=1)
    heads = [["scorer", *["net"] * len(columns)]]
    heads += [] if list(animals) == [""] else [["individuals", *(animal for animal, _, _ in columns)]]
    heads += [["bodyparts", *(part for _, part, _ in columns)], ["coords", *(what for _, _, what in columns)]]
    return heads, values


def write_deeplabcut(path, animals, scores=None):
    heads, values = deeplabcut_rows(animals, scores)
    rows = [[frame, *("" if np.isnan(each) else each for each in row)] for frame, row in enumerate(values.tolist())]
    return write(path, heads[0], [*heads[1:], *rows])


def write_sleap(path, animals, parts=None, scores=None):
    """A row for each animal and frame in which it has a point."""
    parts = parts or [f"part{place}" for place in range(next(iter(animals.values())).shape[1])]
    names = [f"{part}.{what}" for part in parts for what in ("x", "y", "score")]
    rows = []
    for frame in range(len(TIMES)):
        for name, points in animals.items():
            cells = ["" if np.isnan(each) else each for each in with_scores(points, scores)[frame].ravel().tolist()]
            if np.isfinite(points[frame]).any():
                rows.append((name, frame, 0.9, *cells))
    return write(path, ("track", "frame_idx", "instance.score", *names), rows)


def with_eyes_and_fins(points, arc, reach=1.0):
    """Parts of a skeleton {name: (N, 2)} of a swimmer's points (N, n, 2): with eyes and fin tips beside its body, which
    is `reach` long."""
    along = dict(
        zip(["snout", *(f"p{each}" for each in range(1, len(arc) - 1)), "tail"], points.swapaxes(0, 1), strict=True)
    )
    aside = {}
    for name, place, width in (("eye", 1, 0.08), ("fin", len(arc) // 2, 0.12)):
        step = points[:, place + 1] - points[:, place - 1]
        side = reach * width * np.stack((-step[:, 1], step[:, 0]), axis=1) / np.linalg.norm(step, axis=1)[:, None]
        aside |= {f"left_{name}": points[:, place] + side, f"right_{name}": points[:, place] - side}
    return along | aside


def write_deeplabcut_h5(path, animals, form, scores=None):
    """DeepLabCut's table as pandas writes it by PyTables: form "table" or "blocks" ("fixed")."""
    heads, values = deeplabcut_rows(animals, scores)
    names = list(zip(*(row[1:] for row in heads), strict=True))
    with h5py.File(path, "w") as file:
        group = file.create_group("df_with_missing")
        group.attrs["pandas_type"] = np.bytes_({"table": "frame_table", "blocks": "frame"}[form])
        if form == "table":
            kind = np.dtype([("index", "<i8"), ("values_block_0", "<f8", (values.shape[1],))])
            rows = np.zeros(len(values), kind)
            rows["index"], rows["values_block_0"] = np.arange(len(values)), values
            table = group.create_dataset("table", data=rows, chunks=(50,), maxshape=(None,))
            for name, listed in (("values_block_0_kind", names), ("values_block_0_meta", None)):
                table.attrs[name] = np.bytes_(pickle.dumps(listed, 0))  # PyTables knows no other protocol
            info = {1: {"names": [row[0] for row in heads], "type": "MultiIndex"}}
            group.attrs["info"] = np.bytes_(pickle.dumps(info, 0))
            return path
        group.create_dataset("block0_values", data=values).attrs["transposed"] = np.uint8(1)
        group["axis1"] = np.arange(len(values))
        for place, row in enumerate(heads):
            level, mark = np.unique(np.array(row[1:], dtype="S"), return_inverse=True)
            group[f"block0_items_level{place}"], group[f"block0_items_label{place}"] = level, mark.astype(np.int8)
    return path


def write_sleap_h5(path, animals, parts, dims=None, scores=None):
    """SLEAP's analysis file: axes track, xy, node, frame, or other `dims`, which it then names."""
    axes = ("track", "xy", "node", "frame")
    points = np.stack([each.transpose(2, 1, 0) for each in animals.values()])
    with h5py.File(path, "w") as file:
        points = points.transpose([axes.index(name) for name in dims or axes])
        tracks = file.create_dataset("tracks", data=points, compression="gzip", compression_opts=9)
        if dims:
            tracks.attrs["dims"] = json.dumps(dims)
        if scores is not None:
            order = [("track", "node", "frame").index(name) for name in dims or axes if name != "xy"]
            file["point_scores"] = np.stack([scores.T] * len(animals)).transpose(order)
        file["node_names"], file["track_names"] = np.array(parts, dtype="S"), np.array(list(animals), dtype="S")
        file["labels_path"] = "fish.slp"
    return path


def hidden(kind, draw):
    """(N, n), which points of a film of 8 are not seen."""
    found, long = np.zeros((COUNT, len(ARC)), dtype=bool), int(0.4 * COUNT)
    place, start = draw.integers(1, len(ARC) - 2), draw.integers(0, COUNT - long)
    if kind == "scattered":
        found[:, 1:-1] = draw.random((COUNT, len(ARC) - 2)) < 0.15
    elif kind == "two in a row, often":
        found[draw.choice(COUNT, long, replace=False), place : place + 2] = True
    elif kind == "one for long":
        found[start : start + long, place] = True
    elif kind == "bursts":
        for first in draw.integers(0, COUNT - 6, 5):
            found[first : first + 6, place : place + 2] = True
        found[start : start + 4] = True
    return found


def beat_without(path, points, lost):
    """The beat of a film without the points that are `lost` (N, n)."""
    gone = np.where(lost[..., None], np.nan, 1e3 * points)
    return beat_of(read_film(write_sleap(path, {"": gone}), units="px", scale=1e-3, rate=50.0))
