# SPDX-License-Identifier: Apache-2.0
"""Implausible films: tracked points that do what no body does.

A body does not stretch. So the distance of two neighbours must not follow the beat, as happens if some points are
shifted sideways together. It must not drift either, as happens if a tracker slips along the body. Each distance is
fitted by means over whole beats and the first harmonic of the beat, less what all distances share (a camera that moves
closer). Noise has little of that, and the chords of a bending body change at twice the beat. A temporary slip shows as
frames far outside the distance's robust spread.

Points that are shifted together where the body hardly turns show as an oblique segment between parallel ones.

A body with a mean bend swims in a curve. In this model it turns by 1.07 to 2.5 times its bend per length travelled, on
three bodies at bends of 0.1 to 1.2 rad.
"""

import math
from collections.abc import Iterable

import numpy as np

from eel_gaits.film.film import SPREADS, Film, unseen_segments, usual_of
from eel_gaits.film.kinematics import harmonics
from eel_gaits.sources.order import FOLD

STRETCH, OTHERS, SURE = 0.08, 3.0, 4.0  # RMS change of a distance: relative, by steady ones, by standard errors
STEADY, PARTS = 0.25, 8  # quantile of the distances that count as steady; most parts of a film with a mean each
ASKEW, PARALLEL = 0.25, 0.5  # rad: mean angle of a segment; part of it by which its neighbours may differ
BRIEF, OFTEN = 0.25, 0.05  # allowed change of a distance, and the part of the frames with more
FOLDED = 0.1  # part of the frames in which a point may fold the line
BENT, TURNED, STILL = 0.18, 0.5, 0.1  # rad: mean bend; part of it that the path turns per length; L per beat
WINDOW, PLACES = 0.25, 61  # of the length: window of the body's mean angle; places along the body


def doubts_of(film: Film, period: float, stride: float | None = None) -> list[str]:
    """The implausible features of a `film` with a beat of this `period` [s], in sentences.

    stride: distance per beat, in lengths; without it the mean bend is not checked.
    """
    segments = np.diff(film.points, axis=1)
    angles = np.unwrap(np.arctan2(segments[..., 1], segments[..., 0]), axis=1)
    whole = np.average(angles, axis=1, weights=np.diff(film.arc))
    beats = (film.time - film.time[0]) / period
    number = np.unique(np.floor(beats + 1e-6), return_inverse=True)[1]
    bends = np.array([(angles - whole[:, None])[number == beat].mean(axis=0) for beat in range(number.max() + 1)])
    stretched, odd = _stretched(film, beats)
    found = _folding(film, angles) + stretched + _askew(film, bends, odd)
    return found + (_bent(film, bends, np.unwrap(whole), beats, stride) if stride is not None else [])


def _stretched(film: Film, beats: np.ndarray) -> tuple[list[str], np.ndarray]:
    """The points that are shifted along the body or sideways, and the segments (n - 1,) that show it."""
    part, length = _stretches(film, beats)
    size = np.sqrt(np.mean(part**2, axis=0))
    odd = (size > STRETCH) & (size * length > OTHERS * np.quantile(size * length, STEADY))
    found, place = [], 0
    while place < len(odd):
        end = place + 1
        while odd[place] and end < len(odd) and odd[end] and np.mean(part[:, end - 1] * part[:, end]) < 0.0:
            end += 1
        if odd[place]:
            slipped = f"{_names(film, range(place + 1, end))} slipped along the body"
            who = slipped if end > place + 1 else _moved(film, place)
            way = f"{math.sqrt(8.0) * size[place]:.0%}"  # from end to end of a sine
            pair = _names(film, (place, place + 1), " to ")
            found.append(f"{who}: the distance from {pair} changes by {way}, and bodies do not stretch")
        place = end
    return found, odd


def _stretches(film: Film, beats: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The relative change (N, n - 1) of each distance between neighbours, 0 where it is not significant, and the mean
    distances (n - 1,) [m]."""
    steps = np.linalg.norm(np.diff(film.points, axis=1), axis=2)
    seen = np.ones(steps.shape, dtype=bool)
    if film.missing is not None:
        seen = ~unseen_segments(film.missing)
    count = int(np.clip(beats[-1], 2.0, PARTS))
    parts = np.unique(np.minimum(count * beats // beats[-1], count - 1), return_inverse=True)[1]
    design = np.column_stack((np.eye(parts.max() + 1)[parts], *harmonics(2.0 * math.pi * beats, 1)))
    mean, found = np.ones(steps.shape[1]), np.zeros(steps.shape)
    errors = np.full(steps.shape[1], np.inf)
    for place, here in enumerate(seen.T):
        if np.sum(here) > 2 * design.shape[1]:
            mean[place] = steps[here, place].mean()
            fitted = np.linalg.lstsq(design[here], steps[here, place] / mean[place] - 1.0, rcond=None)[0]
            found[:, place] = design @ fitted
            rest = steps[here, place] / mean[place] - 1.0 - found[here, place]
            kept = np.clip(np.mean(rest[1:] * rest[:-1]) / max(np.mean(rest**2), 1e-300), 0.0, 0.98)
            free = max(len(rest) * (1.0 - kept) / (1.0 + kept), design.shape[1])  # errors last for several frames
            errors[place] = np.std(rest) * math.sqrt((design.shape[1] - 1) / free)
    found -= np.median(found, axis=1, keepdims=True)
    found = np.where(np.sqrt(np.mean(found**2, axis=0)) > SURE * errors, found, 0.0)
    usual, spread = usual_of(np.where(seen, steps, np.nan))
    apart = np.where(seen, steps - usual, 0.0)
    often = np.mean(np.abs(apart) > np.maximum(BRIEF * usual, SPREADS * spread), axis=0) > OFTEN
    return np.where(often, apart / mean, found), mean


def _folding(film: Film, angles: np.ndarray) -> list[str]:
    """The points that fold the line in some frames. angles (N, n - 1) [rad]: of the segments."""
    often = np.sum(np.abs(np.diff(angles, axis=1)) > FOLD, axis=0)
    places = np.flatnonzero(often > FOLDED * len(angles)) + 1
    if not len(places):
        return []
    return [f"{_names(film, places)} fold the line back in {often.max()} of {len(angles)} frames: exchanged?"]


def _askew(film: Film, bends: np.ndarray, known: np.ndarray) -> list[str]:
    """The points that stand aside, from the mean angles `bends` (B, n - 1) [rad] per beat; without segments `known`."""
    aside = bends[:, 1:-1] - 0.5 * (bends[:, 2:] + bends[:, :-2])
    mean, error = np.abs(aside.mean(axis=0)), aside.std(axis=0) / math.sqrt(len(bends))
    odd = (mean > np.maximum(ASKEW, SURE * error)) & ~known[1:-1]
    odd &= np.abs((bends[:, 2:] - bends[:, :-2]).mean(axis=0)) < PARALLEL * mean
    return [
        f"{_moved(film, place + 1)}: the body is askew by {mean[place]:.2f} rad from "
        f"{_names(film, (place + 1, place + 2), ' to ')} alone"
        for place in np.flatnonzero(odd).tolist()
    ]


def _bent(film: Film, bends: np.ndarray, whole: np.ndarray, beats: np.ndarray, stride: float) -> list[str]:
    """Whether the mean bend is large, from `bends` (B, n - 1) [rad], but the body's angle `whole` (N,) hardly turns."""
    ways = np.insert(np.cumsum(bends * np.diff(film.arc), axis=1), 0, 0.0, axis=1)
    starts, width = np.linspace(0.0, (1.0 - WINDOW) * film.length, PLACES), WINDOW * film.length
    angles = (
        np.array([np.interp(starts + width, film.arc, row) - np.interp(starts, film.arc, row) for row in ways]) / width
    )
    ends = sorted((int(np.argmin(angles.mean(axis=0))), int(np.argmax(angles.mean(axis=0)))))
    each = np.diff(angles[:, ends], axis=1)
    size, error = abs(float(each.mean())), float(each.std()) / math.sqrt(len(each))
    design = np.column_stack((np.ones_like(beats), beats, *harmonics(2.0 * math.pi * beats, 1)))
    turn = abs(float(np.linalg.lstsq(design, whole, rcond=None)[0][1]))  # rad in a beat
    least = size * max(stride, STILL)
    if size <= max(BENT, SURE * error) or turn >= TURNED * least:
        return []
    points = [int(np.argmin(np.abs(film.arc - starts[place] - 0.5 * width))) for place in ends]
    return [
        f"the body is bent by {size:.2f} rad in the mean from {_names(film, points, ' to ')}, yet turns by {turn:.2g} "
        f"rad in a beat, where such a bend gives {least:.2g} or more: points moved aside?"
    ]


def _moved(film: Film, place: int) -> str:
    """The sentence that the points before and behind a `place` are shifted against each other."""
    ahead, behind = range(place + 1), range(place + 1, film.points.shape[1])
    return f"{_names(film, behind)} moved as a whole against {_names(film, ahead)}"


def _names(film: Film, places: Iterable[int], between: str = ", ") -> str:
    return between.join(film.names[place] if film.names else str(place + 1) for place in places)
