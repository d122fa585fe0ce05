# SPDX-License-Identifier: Apache-2.0
"""Rows in time that represent a function: close together where it needs them, and far apart where it rests.

Intervals between rows are halved until interpolation agrees with the function at their middle and at all looks (which
are never rows), and until halving changes no acceleration. An interval is at most twice as long as the next one.
Derivatives are those of the polynomial of degree 6 through seven rows.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from eel_gaits.sources.sampled_law import quintic

FEWEST, LONGEST = 16, 0.25  # number and length [s] of the first intervals
MOST_ROWS = 20_000
STENCIL = 7  # rows for a derivative
SMOOTH = 7e-4  # part of the greatest acceleration: change after halving an interval
GROWTH = 1.5  # growth of an acceleration after halving that shows a jump of the rate, which doubles it
ALIKE = 1.001  # ratio of lengths that differ by round-off


class Rows(NamedTuple):
    """N rows at the times `time` (N,) [s]."""

    time: np.ndarray
    values: np.ndarray  # (N, 2, 3, n): for pitch and yaw, curvature [rad/m], rate and acceleration
    missed: float  # greatest difference from the looks, relative to the greatest curvature
    jump: float | None = None  # s, where the rate seems to jump


def refined(
    evaluated: Callable[[np.ndarray], np.ndarray],
    duration: float,
    looks: np.ndarray,
    seen: np.ndarray,
    tolerance: float,
    closest: float,
) -> Rows:
    """The rows of a function up to `duration` [s], with the values `seen` (M, 2, n) [rad/m] at the `looks` (M,) [s].

    evaluated(instants (N,) [s]): curvature (N, 2, 1, n), or with derivatives (N, 2, 3, n). closest: [s], least distance
    of rows. `ValueError` if rows at that distance, or too many rows, do not represent the function.
    """
    time = np.linspace(0.0, duration, 1 + max(FEWEST, math.ceil(duration / LONGEST)))
    closest = min(closest, time[1] / STENCIL**2)
    values = evaluated(time)
    rows, wanted, jump = with_derivatives(time, values), np.ones(len(time) - 1, dtype=bool), None
    while True:
        scale = max(np.max(np.abs(values[:, :, 0])), np.max(np.abs(seen)))
        apart, step = _missed(time, rows, looks, seen), np.diff(time)
        wanted |= apart > tolerance * scale
        many = len(time) + np.count_nonzero(wanted) > MOST_ROWS
        if not np.any(wanted) or (many and np.max(apart) <= tolerance * scale):
            return Rows(time, rows, np.max(apart) / scale if scale else 0.0, jump)
        middle = 0.5 * (time[1:] + time[:-1])[wanted]
        between = evaluated(middle)
        apart = np.maximum(apart, _missed(time, rows, middle, between[:, :, 0]))
        failing = apart > tolerance * scale
        worst = np.argmax(np.where(failing & (many | (step <= 2.0 * closest)), apart, 0.0))
        if failing[worst] and (many or step[worst] <= 2.0 * closest):
            raise ValueError(
                f"the curvature's function must be smooth in time: rows {step[worst]:.2g} s apart miss it by "
                f"{apart[worst] / scale:.2g} of its greatest value at t = {time[worst] + 0.5 * step[worst]:.6g} s; the "
                f"tolerance is {tolerance:g}{f', and {MOST_ROWS} rows are the most' if many else ''}"
            )
        before, coarse, order = time, rows, np.argsort(np.concatenate((time, middle)))
        time, values = (np.concatenate(both)[order] for both in ((time, middle), (values, between)))
        rows = with_derivatives(time, values)
        kept, size = np.searchsorted(time, before), _size(rows)
        changing = wanted & (_greater(_size(rows[kept] - coarse)) > SMOOTH * np.max(size))
        growing = np.maximum.reduceat(_greater(size), kept[:-1]) > GROWTH * _greater(_size(coarse))
        if jump is None and np.any(jumping := changing & growing & (step <= 2.0 * closest)):
            jump = float(before[np.argmax(jumping)])
        old = np.repeat(np.arange(len(step)), 1 + wanted)  # index of the interval before halving
        step = np.diff(time)
        wanted = _graded((failing | changing)[old] & (step > closest), step)


def with_derivatives(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Rows (N, 2, 3, n) of curvature, rate and acceleration from the curvature (N, 2, 1, n) at `time` (N,) [s]. Rows
    that have derivatives are returned unchanged."""
    if values.shape[2] == 3:
        return values
    first = np.clip(np.arange(len(time)) - STENCIL // 2, 0, len(time) - STENCIL)
    off = time[first[:, None] + np.arange(STENCIL)] - time[:, None]
    reach = np.max(np.abs(off), axis=1)[:, None]
    powers = (off / reach)[:, None, :] ** np.arange(STENCIL)[:, None]
    weights = np.linalg.solve(powers, np.eye(STENCIL)[:, 1:3]) * [1.0, 2.0]  # for rate and acceleration
    weights /= reach[:, :, None] ** [1.0, 2.0]
    rows = np.zeros((*values.shape[:2], 3, values.shape[3]))
    rows[:, :, 0] = values[:, :, 0]
    for place in range(STENCIL):
        rows[:, :, 1:] += weights[:, None, place, :, None] * values[first + place]
    return rows


def _missed(time: np.ndarray, rows: np.ndarray, looks: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """The greatest error [rad/m] of interpolation between rows against the looks, in each interval."""
    home = np.clip(np.searchsorted(time, looks, side="right") - 1, 0, len(time) - 2)
    step, since = (each[:, None, None] for each in (np.diff(time)[home], looks - time[home]))
    start, end = (rows[place].transpose(2, 0, 1, 3) for place in (home, home + 1))
    apart = np.max(np.abs(quintic(start, end, step, since / step)[0] - seen), axis=(1, 2))
    greatest = np.zeros(len(time) - 1)
    np.maximum.at(greatest, home, apart)
    return greatest


def _size(rows: np.ndarray) -> np.ndarray:
    """Root mean square (N,) [rad/m/s^2] of the accelerations over axes and points."""
    return np.asarray(np.sqrt(np.mean(rows[:, :, 2] ** 2, axis=(1, 2))))


def _greater(values: np.ndarray) -> np.ndarray:
    """The greater of the values (N,) at both ends of each interval."""
    return np.asarray(np.maximum(values[1:], values[:-1]))


def _graded(wanted: np.ndarray, step: np.ndarray) -> np.ndarray:
    """The intervals to halve, with those that would be more than twice as long as one beside them."""
    while True:
        left = np.pad(np.where(wanted, 0.5, 1.0) * step, 1, constant_values=np.inf)
        more = step > 2.0 * ALIKE * np.minimum(left[:-2], left[2:])
        if not np.any(more & ~wanted):
            return wanted
        wanted = wanted | more
