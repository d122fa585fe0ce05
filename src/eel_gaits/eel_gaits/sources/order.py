# SPDX-License-Identifier: Apache-2.0
"""Checks that points stand along a body in order: the line through them must not fold back.

The frames are aligned by their rigid motion, and the median of each point gives the mean shape. A beat, noise, and a
single bend do not show in it. A point where the line turns back is out of order or beside the body. A point of a
tracker's skeleton, such as one eye, also counts as beside the body if the line is straighter without it. A body that
bends to one side turns as much without the point.
"""

from collections.abc import Sequence

import numpy as np

FOLD = np.deg2rad(110.0)  # too large a turn of the mean shape at one point: half a circle through 3 points turns by 90
BESIDE = np.deg2rad(60.0)  # loss of turning by which removing a point shows that it is beside
SMOOTH = np.deg2rad(30.0)  # the same, for a proposed line
SURE = 8.0  # standard errors of a significant mean: a tracker's errors last for several frames
ROUNDS = 4  # of aligning the frames with the mean shape
FEWEST = 3  # fewest points of a line
LONGEST = 170  # characters of an error's list of names


def check_order(points: np.ndarray, names: Sequence[str], apart: Sequence[int], parts: bool = False) -> None:
    """`ValueError` if the points (N, n, d) [any unit] with these `names` (n,) do not stand along a body in order.

    NaN marks a missing point. apart: the points that coincide with no other; only these can show a fold. parts: the
    points are of a skeleton, some of which may lie beside the body. The error names the points at fault, and those
    along the body in order.
    """
    laid = _laid_on_each_other(points)
    known = _distinct(laid, apart)
    odd = [known[place] for place in _odd(laid[:, known], BESIDE if parts else np.inf)]
    if not odd:
        return
    seen = np.flatnonzero(np.isfinite(laid).any(axis=(0, 2)))
    lines = [_without_odd(laid, line) for line in (seen.tolist(), seen[_shortest(_median(laid[:, seen]))].tolist())]
    line = max(lines, key=len)  # the file's order, unless it loses more points
    out = [place for place in seen.tolist() if place not in line]
    text = f"the line through its points folds back at {_listed(names, odd)}"
    if line and out:
        text = f"{_listed(names, out)} lie{'s' if len(out) == 1 else ''} beside the body or out of order"
    such = f', such as "{_listed(names, line)}"' if line else ""
    raise ValueError(f"{text}: give the points along the body in their order{such}")


def laid_on(points: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The points (T, n, d), each frame rotated and shifted closest to the others, (n, d) or (T, n, d): Kabsch, Acta
    Cryst. A32 (1976), doi:10.1107/S0567739476001873. Points with NaN in either have no influence."""
    both = np.isfinite(points + others).all(axis=2, keepdims=True)
    count = np.maximum(both.sum(axis=1, keepdims=True), 1)
    centre, aim = (np.where(both, each, 0.0).sum(axis=1, keepdims=True) / count for each in (points, others))
    here, other = np.where(both, points - centre, 0.0), np.where(both, others - aim, 0.0)
    left, _, right = np.linalg.svd(here.swapaxes(1, 2) @ other)
    left[..., -1] *= np.where(np.linalg.det(left @ right) < 0.0, -1.0, 1.0)[:, None]
    return np.asarray((points - centre) @ (left @ right) + aim)


def _laid_on_each_other(points: np.ndarray) -> np.ndarray:
    """The points (N, n, d), each frame moved rigidly closest to the median of all."""
    shape = points[np.argmax(np.isfinite(points).all(axis=2).sum(axis=1))]
    for _ in range(ROUNDS - 1):
        shape = _median(laid_on(points, shape))
    return laid_on(points, shape)


def _median(laid: np.ndarray) -> np.ndarray:
    """The median (n, d) over the frames (N, n, d); NaN for a point never seen."""
    shape, seen = np.full(laid.shape[1:], np.nan), np.isfinite(laid).any(axis=(0, 2))
    shape[seen] = np.nanmedian(laid[:, seen], axis=0)
    return shape


def _distinct(laid: np.ndarray, apart: Sequence[int]) -> list[int]:
    """Those `apart` of the points (N, n, d) whose step from the previous one is larger than its scatter."""
    kept = list(apart[:1])
    for place in apart[1:]:
        if _is_sure(laid[:, place] - laid[:, kept[-1]]):
            kept.append(place)
    return kept


def _is_sure(steps: np.ndarray) -> bool:
    """Whether the mean of the steps (N, d) is significant against their scatter. NaN is left out."""
    steps = steps[np.isfinite(steps).all(axis=1)]
    if not len(steps):
        return False
    error = np.sqrt(np.sum(np.var(steps, axis=0)) / len(steps))
    return bool(np.linalg.norm(np.median(steps, axis=0)) > SURE * error)


def _turns(line: np.ndarray) -> np.ndarray:
    """Angles [rad] (n - 2,) by which a line through the points (n, d) turns at each interior point."""
    steps = np.diff(line, axis=0)
    steps = steps / np.maximum(np.linalg.norm(steps, axis=1, keepdims=True), 1e-300)
    return np.asarray(np.arccos(np.clip(np.sum(steps[1:] * steps[:-1], axis=1), -1.0, 1.0)))


def _saved(line: np.ndarray) -> np.ndarray:
    """For each point (n,), the turning [rad] of the line (n, d) that vanishes without it."""
    whole = np.sum(_turns(line))
    return np.array([whole - np.sum(_turns(np.delete(line, place, axis=0))) for place in range(len(line))])


def _odd(laid: np.ndarray, most: float) -> np.ndarray:
    """The points of the lines (N, n, d) where the mean shape folds, or turns by `most` [rad] because of them alone."""
    if laid.shape[1] < FEWEST:
        return np.empty(0, dtype=int)
    shape = _median(laid)
    odd = _turns(shape) > FOLD
    if len(shape) > FEWEST:
        aside = laid[:, 1:-1] - 0.5 * (laid[:, :-2] + laid[:, 2:])
        odd |= (_saved(shape)[1:-1] > most) & [_is_sure(each) for each in aside.swapaxes(0, 1)]
    return np.flatnonzero(odd) + 1


def _without_odd(laid: np.ndarray, line: list[int]) -> list[int]:
    """The points of a `line` left after removing, one by one, those that turn it most, until none is odd."""
    while len(_odd(laid[:, line], SMOOTH)):
        line = np.delete(line, np.argmax(_saved(_median(laid[:, line])))).tolist()
    return line if len(line) >= FEWEST else []


def _shortest(shape: np.ndarray) -> list[int]:
    """A short line through all points (n, d): nearest neighbours from the best start, improved by reversing parts."""
    apart = np.linalg.norm(shape[:, None] - shape, axis=2)

    def length(line: list[int]) -> float:
        return float(np.sum(apart[line[:-1], line[1:]]))

    lines = []
    for start in range(len(shape)):
        line, left = [start], set(range(len(shape))) - {start}
        while left:
            line.append(min(left, key=lambda place: apart[line[-1], place]))
            left.remove(line[-1])
        lines.append(line)
    line, better = min(lines, key=length), True
    while better:
        turned = [line[:i] + line[i:j][::-1] + line[j:] for i in range(len(line)) for j in range(i + 2, len(line) + 1)]
        best = min(turned, key=length, default=line)
        better = length(best) < length(line) * (1.0 - 1e-9)
        line = best if better else line
    return line if line[0] < line[-1] else line[::-1]


def _listed(names: Sequence[str], places: Sequence[int]) -> str:
    text = ", ".join(names[place] for place in places)
    return text if len(text) <= LONGEST else f"{text[:LONGEST].rpartition(',')[0]} ..."
