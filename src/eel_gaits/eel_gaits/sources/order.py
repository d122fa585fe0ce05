# SPDX-License-Identifier: Apache-2.0
"""Whether points stand along a body in their order: the line through them must not fold back.

The frames are laid on each other without their rigid motion, and the median of each point gives the mean shape: a beat,
noise, and a bend that comes once do not show in it. A point where the line turns back is out of order or lies beside
the body. A part of a skeleton whose absence would straighten the line lies beside the body too,
such as one eye; a body that bends to one side turns as much without the point.
"""

from collections.abc import Sequence

import numpy as np

FOLD = np.deg2rad(110.0)  # a turn of the mean shape at one point that no body has: half a circle through 3 has 90
BESIDE = np.deg2rad(60.0)  # of turning, that the line loses without a point beside it
SMOOTH = np.deg2rad(30.0)  # the same, of a line that is proposed
SURE = 8.0  # standard errors of a mean that count: a tracker's errors last for several frames
ROUNDS = 4  # of laying the frames on the mean shape
FEWEST = 3  # points of a line that is looked for
LONGEST = 170  # characters of a list of names in an error


def check_order(points: np.ndarray, names: Sequence[str], apart: Sequence[int], parts: bool = False) -> None:
    """`ValueError` where the points (N, n, d) [any unit] with these `names` (n,) do not stand along a body.

    NaN where a point is missing. apart: those that do not lie on another, which alone tell a fold. parts: of a
    skeleton, some of which may lie beside the body. The error names the points, and those that stand along the body, in
    their order.
    """
    laid = _laid_on_each_other(points)
    known = _distinct(laid, apart)
    odd = [known[place] for place in _odd(laid[:, known], BESIDE if parts else np.inf)]
    if not odd:
        return
    seen = np.flatnonzero(np.isfinite(laid).any(axis=(0, 2)))
    lines = [_without_odd(laid, line) for line in (seen.tolist(), seen[_shortest(_median(laid[:, seen]))].tolist())]
    line = max(lines, key=len)  # the file's order, unless that loses a point more
    out = [place for place in seen.tolist() if place not in line]
    text = f"the line through its points folds back at {_listed(names, odd)}"
    if line and out:
        text = f"{_listed(names, out)} lie{'s' if len(out) == 1 else ''} beside the body or out of order"
    such = f', such as "{_listed(names, line)}"' if line else ""
    raise ValueError(f"{text}: give the points along the body in their order{such}")


def laid_on(points: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The points (T, n, d) after the rotation and shift of each frame that bring it closest to the others, (n, d) or
    (T, n, d): Kabsch, Acta Cryst. A32 (1976), doi:10.1107/S0567739476001873. What is NaN in either has no say."""
    both = np.isfinite(points + others).all(axis=2, keepdims=True)
    count = np.maximum(both.sum(axis=1, keepdims=True), 1)
    centre, aim = (np.where(both, each, 0.0).sum(axis=1, keepdims=True) / count for each in (points, others))
    here, other = np.where(both, points - centre, 0.0), np.where(both, others - aim, 0.0)
    left, _, right = np.linalg.svd(here.swapaxes(1, 2) @ other)
    left[..., -1] *= np.where(np.linalg.det(left @ right) < 0.0, -1.0, 1.0)[:, None]
    return np.asarray((points - centre) @ (left @ right) + aim)


def _laid_on_each_other(points: np.ndarray) -> np.ndarray:
    """The points (N, n, d) after the rigid motion of each frame that brings it closest to the median of all."""
    shape = points[np.argmax(np.isfinite(points).all(axis=2).sum(axis=1))]
    for _ in range(ROUNDS - 1):
        shape = _median(laid_on(points, shape))
    return laid_on(points, shape)


def _median(laid: np.ndarray) -> np.ndarray:
    """The median (n, d) over the frames (N, n, d); NaN for a point that is never seen."""
    shape, seen = np.full(laid.shape[1:], np.nan), np.isfinite(laid).any(axis=(0, 2))
    shape[seen] = np.nanmedian(laid[:, seen], axis=0)
    return shape


def _distinct(laid: np.ndarray, apart: Sequence[int]) -> list[int]:
    """Those `apart` of the points (N, n, d) whose step from the one before is not lost in its own scatter."""
    kept = list(apart[:1])
    for place in apart[1:]:
        if _is_sure(laid[:, place] - laid[:, kept[-1]]):
            kept.append(place)
    return kept


def _is_sure(steps: np.ndarray) -> bool:
    """Whether the steps of the frames (N, d) are on the whole more than their scatter, NaN left out."""
    steps = steps[np.isfinite(steps).all(axis=1)]
    if not len(steps):
        return False
    error = np.sqrt(np.sum(np.var(steps, axis=0)) / len(steps))
    return bool(np.linalg.norm(np.median(steps, axis=0)) > SURE * error)


def _turns(line: np.ndarray) -> np.ndarray:
    """Angles [rad] (n - 2,) by which a line through the points (n, d) turns at each but the ends."""
    steps = np.diff(line, axis=0)
    steps = steps / np.maximum(np.linalg.norm(steps, axis=1, keepdims=True), 1e-300)
    return np.asarray(np.arccos(np.clip(np.sum(steps[1:] * steps[:-1], axis=1), -1.0, 1.0)))


def _saved(line: np.ndarray) -> np.ndarray:
    """Turning [rad] (n,) that the line (n, d) loses without each of its points."""
    whole = np.sum(_turns(line))
    return np.array([whole - np.sum(_turns(np.delete(line, place, axis=0))) for place in range(len(line))])


def _odd(laid: np.ndarray, most: float) -> np.ndarray:
    """The points of the lines (N, n, d) at which the mean shape folds back, or turns by `most` [rad] for them alone."""
    if laid.shape[1] < FEWEST:
        return np.empty(0, dtype=int)
    shape = _median(laid)
    odd = _turns(shape) > FOLD
    if len(shape) > FEWEST:
        aside = laid[:, 1:-1] - 0.5 * (laid[:, :-2] + laid[:, 2:])
        odd |= (_saved(shape)[1:-1] > most) & [_is_sure(each) for each in aside.swapaxes(0, 1)]
    return np.flatnonzero(odd) + 1


def _without_odd(laid: np.ndarray, line: list[int]) -> list[int]:
    """The points of a `line` that are left when none is odd; without those that turn it most."""
    while len(_odd(laid[:, line], SMOOTH)):
        line = np.delete(line, np.argmax(_saved(_median(laid[:, line])))).tolist()
    return line if len(line) >= FEWEST else []


def _shortest(shape: np.ndarray) -> list[int]:
    """A short line through all points (n, d): to the nearest left, from the best start, with parts of it reversed."""
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
