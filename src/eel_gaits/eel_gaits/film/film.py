# SPDX-License-Identifier: Apache-2.0
"""A filmed swimmer: tracked points in metres, repaired where that is safe, or refused with a reason.

Empty frames are left out. A point that is missing, unlikely, or has jumped is interpolated between its neighbours, and
later placed by the fitted beat. A frame without an end point, or without a quarter of its points, is left out. Drift
and turns of the swimmer need no repair: the body's bending does not contain them. Points out of order along the body
are refused.
"""

import itertools
import math
import os
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

import numpy as np
from eel_common.files.input_file import reading
from eel_common.quantity import number, positive
from eel_common.wording import shown

from eel_gaits.film.animals import of_one
from eel_gaits.film.forms import LENGTHS, SHORT, Tracks, read_tracks
from eel_gaits.film.kinematics import arc_of
from eel_gaits.sources.order import FOLD, check_order

FEWEST_POINTS, FEWEST_FRAMES = 5, 16
MOST_MISSING = 0.25  # part of a frame's points that may be missing
OFTEN, ENDS = 0.5, 0.2  # least part of the frames with a point; the same for the two ends
JUMP, SPREADS = 0.5, 6.0  # a point has jumped beyond these multiples of a segment's median length and robust spread
CUT, STEPS = 0.25, 10.0  # the body has jumped beyond these multiples of its length and median step
CLOSE = 0.3  # of the median distance between neighbours: closer points are one
LONGEST = 100.0  # m: longest swimmer
LIKELY = 0.6  # least likelihood or score of a tracker's point, as in DeepLabCut; others count as missing


class Film(NamedTuple):
    """Points from head to tail in N frames."""

    name: str  # of the file
    time: np.ndarray  # (N,) s
    points: np.ndarray  # (N, n, 2) m
    notes: tuple[str, ...]  # what was done to the data, in words
    names: tuple[str, ...] = ()  # of the points (n,)
    read: str = ""  # what was guessed of the file's form, in words
    missing: np.ndarray | None = None  # (N, n), whether a point was filled in

    @property
    def arc(self) -> np.ndarray:
        """(n,) m, as of `arc_of`."""
        return arc_of(self.points, self.missing)

    @property
    def length(self) -> float:
        """[m] from the first point to the last, along the body."""
        return float(self.arc[-1])


def read_film(
    path: str | os.PathLike[str],
    *,
    units: str | None = None,
    scale: float | None = None,
    time: str = "",
    rate: float | None = None,
    animal: str | None = None,
    points: Sequence[str] | None = None,
    likely: float | None = None,
) -> Film:
    """The swimmer in a file of tracked points, in a format of `eel_gaits.film.forms`.

    units: of length: m, cm, mm or px; None: the columns' own. scale: metres per unit of the file, for pixels.
    time: the column of times, by name or number, if its name is not recognised. rate: frames per second, if the file
    counts frames. animal: which of several, or names of its tracks with commas between them. points: names of those
    along the body, from head to tail, or patterns such as spine*, whose points come in the file's order; None: all.
    likely: least likelihood or score of a tracker's point, others count as missing; None: 0.6, if it has scores.
    `ValueError` in one line for unsuitable input, and for points out of order along the body.
    """
    path = Path(path)
    with reading(shown(str(path))):
        tracks = read_tracks(path, time)
        metres = _metres(tracks, units, scale)
        if tracks.frames and rate is None:
            raise ValueError("it counts frames: give the rate of the film, frames per second")
        if not tracks.frames and rate is not None:
            raise ValueError("it has times: a rate of the film has no place")
        least = LIKELY if likely is None else number("likely", likely, minimum=0.0, maximum=1.0)
        if likely is not None and not any(np.isfinite(each).any() for each in tracks.scores.values()):
            raise ValueError(f"it has no likelihoods or scores of its points: likely has no place, got {likely:g}")
        seen, low, names, notes = of_one(tracks, animal, least)
        places, out = _chosen(names, points)
        named = [names[place] for place in places]
        seconds = tracks.time / positive("rate", rate, "1/s") if rate is not None else tracks.time
        if np.any(low := low[:, places]):
            what = f"have a likelihood below {least:g} and count as missing"
            out.append(f"{np.sum(low)} of {low.size} points {what}: {_names_of(named, low)}")
        found = _repaired(path.name, seconds, metres * seen[:, places], named, [*notes, *out], tracks.frames)
        if found.length > LONGEST:
            raise ValueError(f"its swimmer is {found.length:.4g} m long: give its units, or a scale")
        _check_whole(found)
        return found._replace(read=tracks.read)


def _metres(tracks: Tracks, units: str | None, scale: float | None) -> float:
    """Metres in the file's unit of length."""
    if units is not None and units not in LENGTHS:
        raise ValueError(f"units must be one of {SHORT}, got {shown(units)}")
    if tracks.unit and tracks.unit not in LENGTHS:
        raise ValueError(f"its columns have the unit {shown(tracks.unit)}, which must be one of {SHORT}")
    if units is not None and tracks.unit and not np.isclose(LENGTHS[units], LENGTHS[tracks.unit], equal_nan=True):
        raise ValueError(f"its columns are in {tracks.unit}, the units given are {units}")
    unit = tracks.unit or units
    if scale is not None:
        return number("scale", positive("scale", scale, "m"))
    if unit is None:
        raise ValueError(f"its columns do not tell their unit of length: give units, one of {SHORT}")
    if math.isnan(LENGTHS[unit]):
        raise ValueError("its points are in pixels, which have no length: give the scale, metres in a pixel")
    return LENGTHS[unit]


def _chosen(names: list[str], points: Sequence[str] | None) -> tuple[list[int], list[str]]:
    """The places in the file of the points chosen from these `names`, and a note about those left out."""
    if points is None:
        return list(range(len(names))), []
    if isinstance(points, str):
        raise ValueError(f"points must be a row of names, got {shown(points)}")
    places: list[int] = []
    for point in points:
        found = [names.index(point)] if point in names else []
        found = found or [place for place, name in enumerate(names) if fnmatchcase(name, point)]
        if not found:
            raise ValueError(f"there is no point {shown(point)}, there are: {', '.join(names)}")
        if twice := [names[place] for place in found if place in places]:
            raise ValueError(f"points must be named once, got {twice[0]} twice")
        places += found
    out = [name for place, name in enumerate(names) if place not in places]
    return places, [f"points left out, as they are not among those given: {', '.join(out)}"] if out else []


def _names_of(names: list[str], which: np.ndarray) -> str:
    """The `names` (n,) of the points with any true value in `which` (N, n)."""
    return ", ".join(names[place] for place in np.flatnonzero(which.any(axis=0)))


def _repaired(name: str, time: np.ndarray, points: np.ndarray, names: list[str], notes: list[str], parts: bool) -> Film:
    def keep(frames: np.ndarray, why: str) -> None:
        nonlocal time, points
        if not np.all(frames):
            notes.append(f"{np.sum(~frames)} of {len(frames)} frames left out: {why}")
            time, points = time[frames], points[frames]

    def in_brackets() -> str:
        return f" ({'; '.join(notes)})" if notes else ""

    if not np.any(np.isfinite(points)):
        raise ValueError(f"all its points are missing{in_brackets()}")
    keep(np.any(np.isfinite(points), axis=(1, 2)), "empty")
    there = np.all(np.isfinite(points), axis=2)
    often = np.where(np.isin(np.arange(len(names)), (0, len(names) - 1)), ENDS, OFTEN)
    rare = np.flatnonzero(there.mean(axis=0) < often)
    if len(rare):
        notes.append(f"points left out, missing in most frames: {', '.join(names[each] for each in rare)}")
        points, names = np.delete(points, rare, axis=1), np.delete(names, rare).tolist()
    apart = _apart(points) if len(names) else []
    if out := [name for place, name in enumerate(names) if place not in apart]:
        notes.append(f"points left out, as they lie on the one ahead: {', '.join(out)}")
    if len(apart) < FEWEST_POINTS or len(time) < FEWEST_FRAMES:
        rule = f"{FEWEST_POINTS} points in {FEWEST_FRAMES} frames or more"
        raise ValueError(f"there must be {rule}, got {len(apart)} in {len(time)}{in_brackets()}")
    check_order(points, names, apart, parts)
    points, names = points[:, apart], [names[place] for place in apart]
    points, swapped = _unswapped(points, names)
    notes += swapped
    jumped = _jumps(points)
    points = np.where(jumped[..., None], np.nan, points)
    missing = ~np.all(np.isfinite(points), axis=2)
    if np.any(jumped):
        notes.append(
            f"{np.sum(jumped)} points have jumped along the body and count as missing: {_names_of(names, jumped)}"
        )
    keep(~(missing[:, 0] | missing[:, -1]), "an end of the body is missing")
    part = np.mean(~np.all(np.isfinite(points), axis=2), axis=1)
    keep(part <= MOST_MISSING, "more than a quarter of the points missing")
    if len(time) < FEWEST_FRAMES:
        raise ValueError(f"there must be {FEWEST_FRAMES} frames or more, got {len(time)}{in_brackets()}")
    missing = ~np.all(np.isfinite(points), axis=2)
    if np.any(missing):
        notes.append(f"{np.sum(missing)} of {missing.size} points filled in")
        steps = usual_of(np.linalg.norm(np.diff(points, axis=1), axis=2))[0]
        steps = np.where(np.isfinite(steps), steps, np.nanmedian(steps))  # NaN for neighbours never seen together
        points = filled(points, missing, np.concatenate(([0.0], np.cumsum(steps))))
    return Film(name, time, points, tuple(notes), tuple(names), missing=missing)


def _apart(points: np.ndarray) -> list[int]:
    """The places without points that coincide with the one ahead: a segment between them has no direction."""
    usual = usual_of(usual_of(np.linalg.norm(np.diff(points, axis=1), axis=2))[0][:, None])[0]
    kept = [0]
    for place in range(1, points.shape[1]):
        if not usual_of(np.linalg.norm(points[:, [place]] - points[:, [kept[-1]]], axis=2))[0] <= CLOSE * usual:
            kept.append(place)
    return kept


def _unswapped(points: np.ndarray, names: list[str]) -> tuple[np.ndarray, list[str]]:
    """The points, with pairs exchanged where that makes all distances of a frame usual and removes its folds; and notes
    of the exchanges."""
    steps = np.linalg.norm(np.diff(points, axis=1), axis=2)
    usual, spread = usual_of(steps)
    frames, notes = np.flatnonzero(_off(steps, usual, spread).any(axis=1) & _folded(points)), []
    for one, other in itertools.combinations(range(points.shape[1]), 2) if len(frames) else ():
        tried = points[frames]
        tried[:, [one, other]] = tried[:, [other, one]]
        good = ~_off(np.linalg.norm(np.diff(tried, axis=1), axis=2), usual, spread).any(axis=1) & ~_folded(tried)
        if np.any(good):
            notes.append(f"{names[one]} and {names[other]} were exchanged in {np.sum(good)} frames: put back")
            points = points.copy()
            points[frames[good]] = tried[good]
            frames = frames[~good]
    return points, notes


def _folded(points: np.ndarray) -> np.ndarray:
    """The frames (N,) in which the line through the points (N, n, 2) folds back at a point."""
    steps = np.diff(points, axis=1)
    along = np.sum(steps[:, 1:] * steps[:, :-1], axis=2)
    with np.errstate(invalid="ignore"):
        turned = along < math.cos(FOLD) * np.prod(
            [np.linalg.norm(each, axis=2) for each in (steps[:, 1:], steps[:, :-1])], axis=0
        )
    return np.asarray(turned.any(axis=1))


def unseen_segments(missing: np.ndarray) -> np.ndarray:
    """The segments (N, n - 1) with an end that is `missing` (N, n)."""
    return np.asarray(missing[:, 1:] | missing[:, :-1])


def usual_of(steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The median (n - 1,) of distances (N, n - 1), and their robust spread; NaN for distances never seen."""
    found, known = np.full((2, steps.shape[1]), np.nan), np.isfinite(steps).any(axis=0)
    found[0, known] = np.nanmedian(steps[:, known], axis=0)
    found[1, known] = 1.4826 * np.nanmedian(np.abs(steps - found[0])[:, known], axis=0)
    return found[0], found[1]


def _off(steps: np.ndarray, usual: np.ndarray, spread: np.ndarray) -> np.ndarray:
    """The distances (N, n - 1) that are far from the usual (n - 1,). Unknown distances are not."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.abs(steps - usual) > np.maximum(JUMP * usual, SPREADS * spread))


def _jumps(points: np.ndarray) -> np.ndarray:
    """(N, n): whether both distances of a point to its neighbours, or an end's only one, are far from the usual."""
    steps = np.linalg.norm(np.diff(points, axis=1), axis=2)
    off, found = _off(steps, *usual_of(steps)), np.zeros(points.shape[:2], dtype=bool)
    found[:, 1:-1] = off[:, 1:] & off[:, :-1]
    found[:, 0] = off[:, 0] & ~found[:, 1]
    found[:, -1] = off[:, -1] & ~found[:, -2]
    return found


def filled(points: np.ndarray, missing: np.ndarray, arc: np.ndarray, shape: np.ndarray | float = 0.0) -> np.ndarray:
    """The points (N, n, 2), with those `missing` (N, n) placed by a `shape` (N, n, 2), moved along with neighbours.

    arc: of the points (n,). The ends must not be missing.
    """
    place = np.arange(len(arc))
    ahead = np.maximum.accumulate(np.where(missing, 0, place), axis=1)
    behind = np.minimum.accumulate(np.where(missing, len(arc), place)[:, ::-1], axis=1)[:, ::-1]
    part = (arc - arc[ahead]) / np.where(missing, arc[behind] - arc[ahead], 1.0)
    off, frame = points - shape, np.arange(len(points))[:, None]
    between = (1.0 - part)[..., None] * off[frame, ahead] + part[..., None] * off[frame, behind]
    return np.where(missing[..., None], shape + between, points)


def _check_whole(film: Film) -> None:
    """`ValueError` if the whole body jumps between two frames: a cut, or another animal."""
    centre = film.points.mean(axis=1)
    steps = np.linalg.norm(np.diff(centre, axis=0), axis=1)
    pace = steps / np.diff(film.time)
    far = (steps > CUT * film.length) & (pace > STEPS * np.median(pace))
    if np.any(far):
        place = int(np.argmax(far))
        raise ValueError(
            f"the swimmer jumps by {steps[place]:.3g} m between {film.time[place]:g} s and {film.time[place + 1]:g} s: "
            "another animal, or a cut of the film? Give one side of it"
        )
