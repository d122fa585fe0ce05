# SPDX-License-Identifier: Apache-2.0
"""The greatest values of a run between its samples.

With 20 samples per period the greatest sample of the torque is 2 % below its peak (median of all gaits; at most 3 %). A
spline of degree 5 misses it by 3e-4 (at most 4e-3: ramps and drag have kinks), with 100 samples by about 1e-5. So the
overall greatest torque comes from a new swim, through the three sample periods around the spline's peak. It starts from
the state at a sample, or from the start of the run if that state does not determine the rest. The peaks of a window, of
single stations, of joints and of power come from splines through ten times the samples (`Run.finely_sampled`): to 4e-5
or better, as exact as the run. A run of more than a thousand samples has fewer than ten times as many, and a run that
was recorded elsewhere only its own: its peaks of power may then be wrong by 2 % at 20 samples per period.
"""

from functools import lru_cache

import numpy as np

from eel_dynamics.simulation.march import March

DEGREE = 5
BETWEEN = 8  # instants per sample period for finding the greatest; a parabola then gives the peak
FINER, MOST_SAMPLES = 10, 10_000  # samples per sample period, and in all, of a run that is swum again for its peaks
AT_ONCE = 512  # number of these instants evaluated together
FEW, EQUIDISTANT = 40, 1e-9  # values up to this number share a table of splines, if equidistant to this part
NEAR = 0.7  # of the greatest sample: the peak between samples is not beside smaller ones
AROUND = 1  # sample periods, and station distances, to either side of the peak that are swum again
FINE = 12  # instants and stations in each of these
BESIDE = 6  # number of them to either side of the greatest, for the spline of the peak


def torque_size(torque: np.ndarray) -> np.ndarray:
    """Magnitudes (...) [N m] of internal torques (..., 3)."""
    return np.sqrt(np.einsum("...k,...k->...", torque, torque))


def peaks(
    x: np.ndarray, values: np.ndarray, size=np.abs, start=-np.inf, end=np.inf, near: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The greatest `size` of a spline through `values` (T, ...) at `x` (T,), and its place: from `start` to `end`.

    size: of values (n, ...); it may remove the last axis. Each other axis has a peak of its own.
    near: (T,) bool: samples beside which peaks may lie; None: beside any.
    """
    if len(x) < 2:
        return size(values)[0], np.broadcast_to(x[0], size(values)[0].shape)
    inside = np.unique(np.clip(x, start, end)) if np.isfinite([start, end]).any() else x
    inside = inside[np.diff(inside, prepend=-np.inf) > EQUIDISTANT * (x[1] - x[0])]  # without duplicates from round-off
    between = np.arange((len(inside) - 1) * BETWEEN + 1) / BETWEEN
    fine = np.interp(between, np.arange(len(inside)), inside)
    wanted = slice(None) if near is None else np.interp(between, np.arange(len(inside)), near) > 0.0
    if inside is x and len(x) <= FEW and np.ptp(np.diff(x)) <= EQUIDISTANT * (x[1] - x[0]):
        rows = _table(len(x))[wanted] @ np.asarray_chkfinite(values).reshape(len(x), -1)
        return _greatest(fine[wanted], size(rows.reshape(-1, *values.shape[1:])))
    curve, fine = _spline(x, values), fine[wanted]
    parts = [fine[max(0, begin - 1) : begin + AT_ONCE + 1] for begin in range(0, max(1, len(fine) - 1), AT_ONCE)]
    found = [_greatest(part, size(curve(part))) for part in parts]
    if len(found) == 1:
        return found[0]
    sizes, places = map(np.array, zip(*found, strict=True))
    first = np.argmax(sizes, axis=0)[None]
    return np.take_along_axis(sizes, first, axis=0)[0], np.take_along_axis(places, first, axis=0)[0]


def _spline(x: np.ndarray, values: np.ndarray):
    from scipy.interpolate import make_interp_spline

    return make_interp_spline(x, values, k=min(DEGREE, len(x) - 1))


@lru_cache(maxsize=FEW)
def _table(count: int) -> np.ndarray:
    """(n, count): splines that are 1 at one of `count` equidistant places, with `BETWEEN` rows per interval."""
    return np.asarray(_spline(np.arange(count), np.eye(count))(np.arange((count - 1) * BETWEEN + 1) / BETWEEN))


def greatest_torque_of(run) -> tuple[float, float, float]:
    """Greatest magnitude [N m] of the internal torque of `run`, with its X [m] and its time [s].

    A run is not swum again if it was recorded elsewhere, has a single sample, or is a later part of a run that
    `depends_on_its_start`.
    """
    size = torque_size(run.torque)
    high = size >= NEAR * size.max()
    near, when = np.flatnonzero(high.any(axis=0)), np.flatnonzero(high.any(axis=1))
    part = slice(max(0, when[0] - BESIDE), when[-1] + BESIDE + 1)
    sizes, times = peaks(run.time[part], run.torque[part, near], torque_size, near=high[part].any(axis=1))
    station, time = near[np.argmax(sizes)], times[np.argmax(sizes)]
    if not run.steps or len(run.time) < 2 or (depends_on_its_start(run) and run.time[0] != 0.0):
        return peak_along(run.time, run.x, run.torque)
    times, x, torque = _swum_anew(run, time, int(station))
    size = torque_size(torque)
    instant, place = np.unravel_index(np.argmax(size), size.shape)
    near_time, near_x = _around(int(instant), len(times)), _around(int(place), len(x))
    return peak_along(times[near_time], x[near_x], torque[near_time, near_x])


def depends_on_its_start(run) -> bool:
    """Whether the head's motion at an instant does not determine the rest of `run`: a flow or a wrench depends on time,
    and robots and fins have further states."""
    return run.flow is not None or run.robot is not None or bool(run.fins) or bool(run.wrenches)


def _around(place: int, count: int) -> slice:
    return slice(max(0, place - BESIDE), min(count, place + BESIDE + 1))


def peak_along(time: np.ndarray, x: np.ndarray, torque: np.ndarray) -> tuple[float, float, float]:
    """The greatest magnitude [N m] of splines through `torque` (T, M, 3) [N m], with its X [m] and its time [s]."""
    sizes, times = peaks(time, torque, torque_size)
    size, place = peaks(x, sizes)
    return float(size), float(place), float(times[np.argmax(sizes)])


def _swum_anew(run, time: float, station: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (T,) [s], stations (M,) [m] and torque (T, M, 3) [N m] around `time` [s] and a `station` of `run`."""
    sample = int(np.searchsorted(run.time, time, side="right")) - 1
    first, last = max(0, sample - AROUND), min(len(run.time) - 1, sample + 1 + AROUND)
    times = np.linspace(run.time[first], run.time[last], (last - first) * FINE + 1)
    near = run.x[max(0, station - AROUND) : station + AROUND + 1]
    x = np.linspace(near[0], near[-1], (len(near) - 1) * FINE + 1)
    if depends_on_its_start(run):
        first = 0
    swimmer, start = run.swimmer_at(first, x, run.accuracy.as_it_is()), float(run.time[first])
    out, _, _, stopped = March(swimmer, -start).record(times - start, True, False)
    if stopped is not None:
        raise stopped
    return times, x, out.torque


def _greatest(x: np.ndarray, sizes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The greatest of the `sizes` (n, ...) at `x` (n,) and its place, by a parabola through it and its neighbours."""
    shape, rows = sizes.shape[1:], sizes.reshape(len(sizes), -1)
    column, at = np.arange(rows.shape[1]), np.argmax(rows, axis=0)
    inner = np.minimum(np.maximum(at, 1), max(1, len(x) - 2))
    around = inner + np.arange(-1, 2)[:, None]
    (before, size, after), (previous, here, following) = rows[around, column], x[around]
    left, right = here - previous, following - here
    up, down = (size - before) / left, (after - size) / right
    bend, slope = (down - up) / (left + right), (up * right + down * left) / (left + right)
    inside = (at == inner) & (bend < 0.0)
    step = np.minimum(np.maximum(-0.5 * slope / np.where(inside, bend, -1.0), -left), right)
    peak = np.where(inside, size + step * (slope + step * bend), rows[at, column])
    return peak.reshape(shape), np.where(inside, here + step, x[at]).reshape(shape)
