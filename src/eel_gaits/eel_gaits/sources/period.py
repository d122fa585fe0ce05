# SPDX-License-Identifier: Apache-2.0
"""The period of a sampled motion, from the squared difference between the motion and its delayed copy.

d(T) = mean |K(t + T) - K(t)|^2 / (2 mean |K - mean K|^2) is 0 where the motion repeats after T, and about 1 where it is
unrelated (de Cheveigne and Kawahara, J. Acoust. Soc. Am. 111 (2002), doi:10.1121/1.1458024, likewise for sound).
"""

import math

import numpy as np

from eel_gaits.laws.term import Term

MOST = 1024  # instants at which motions are compared
COLUMNS = 12  # of the values compared, or a few more
REPEATED = 0.1  # a motion repeats if d(T) is below
LEFT = 0.5  # the search for the period starts when d(T) has risen above this
POINTS = 64  # per period, for the first harmonic
STANDING = 0.1  # waves on the body: below this a harmonic is standing
ALIKE = 0.05  # relative difference of the periods of pitch and yaw within one motion
LONGEST_GAP = 0.25  # of the fastest motion's period
HIGHEST = 0.05  # part of the strongest harmonic's amplitude: weaker ones are noise


def period_of(time: np.ndarray, values: np.ndarray) -> float:
    """The period [s] of `values` (N, m) at `time` (N,) [s]; inf if they do not repeat within 3/4 of the time."""
    from scipy.interpolate import CubicSpline
    from scipy.optimize import minimize_scalar

    if len(time) < 8:
        return np.inf
    curve, span = CubicSpline(time, values[:, :: max(1, values.shape[1] // COLUMNS)]), float(time[-1] - time[0])
    count = min(MOST, 4 * len(time))
    rows, step = curve(np.linspace(time[0], time[-1], count)), span / (count - 1)
    power = float(np.mean(np.sum((rows - rows.mean(axis=0)) ** 2, axis=1)))
    if power <= 1e-20 * float(np.mean(np.sum(rows**2, axis=1))):
        return np.inf

    def difference(lag: float) -> float:
        t = np.linspace(time[0], time[-1] - lag, count // 2)
        return float(np.mean(np.sum((curve(t + lag) - curve(t)) ** 2, axis=1))) / (2.0 * power)

    shifts = np.arange(1, 3 * count // 4)
    apart = np.array([np.mean(np.sum((rows[shift:] - rows[:-shift]) ** 2, axis=1)) for shift in shifts]) / (2.0 * power)
    risen = np.argmax(apart > LEFT) if np.any(apart > LEFT) else len(shifts)
    below = np.flatnonzero(apart[risen:] < REPEATED)
    if not len(below):
        return np.inf
    place = risen + below[0]
    while place + 1 < len(shifts) and apart[place + 1] <= apart[place]:
        place += 1
    around = step * shifts[max(place - 1, 0)], step * shifts[min(place + 1, len(shifts) - 1)]
    return float(minimize_scalar(difference, bounds=around, method="bounded", options={"xatol": 1e-9 * span}).x)


def first_harmonics(time: np.ndarray, x: np.ndarray, curvature: dict[str, np.ndarray]) -> tuple[Term, ...]:
    """The first harmonic of the `curvature` (N, n) [rad/m] of each axis, as a wave; none if it does not repeat.

    time (N,) [s]; x (n,) [m]. The period is found in the later half of the time, or else in all of it. The harmonic is
    fitted to as many whole periods as the later half holds, at least one. Its wave number is the slope of its phase
    along the body, weighted by the square of its amplitude.
    """
    for part in (time >= 0.5 * (time[0] + time[-1]), time >= time[0]):
        periods = {axis: period_of(time[part], curvature[axis][part]) for axis in ("yaw", "pitch")}
        shared = next((period for period in periods.values() if np.isfinite(period)), np.inf)
        if np.isfinite(shared):
            break
    return tuple(
        _harmonic(axis, time, x, curvature[axis], shared)
        for axis, period in periods.items()
        if abs(period / shared - 1.0) < ALIKE
    )


def _harmonic(axis: str, time: np.ndarray, x: np.ndarray, rows: np.ndarray, period: float) -> Term:
    from scipy.interpolate import CubicSpline

    whole = max(1, math.floor(0.5 * (time[-1] - time[0]) / period + 1e-6))
    instants = time[-1] - period * whole * np.arange(POINTS * whole) / (POINTS * whole)
    turning = np.exp(2j * math.pi * instants / period)
    found = 2.0 / len(instants) * turning @ CubicSpline(time, rows)(instants)  # K = Re(found exp(-2 pi i t / T))
    phase, weight = np.unwrap(np.angle(found)), np.abs(found) ** 2
    turns = np.polyfit(x, phase, 1, w=np.sqrt(weight))[0] / (2.0 * math.pi) if np.any(weight) else 0.0
    wavelength = 1.0 / turns if abs(turns) * (x[-1] - x[0]) > STANDING else 0.0
    return Term(axis=axis, amplitude=tuple(np.abs(found)), knots=tuple(x), wavelength=wavelength, period=period)


def long_gap(time: np.ndarray, values: np.ndarray) -> tuple[int, str] | None:
    """The instant before a gap longer than a quarter of the fastest period in `values` (N, m), and a text about it.

    The fastest harmonic is the one of highest frequency with at least 5 % of the strongest one's amplitude.
    """
    from scipy.interpolate import CubicSpline

    even = np.linspace(time[0], time[-1], max(64, 2 * len(time)))
    rows = CubicSpline(time, values)(even)
    rows = (rows - rows.mean(axis=0)) * np.hanning(len(even))[:, None]
    amplitude = np.sqrt(np.sum(np.abs(np.fft.rfft(rows, axis=0)) ** 2, axis=1))
    strong = np.flatnonzero(amplitude >= HIGHEST * amplitude.max())
    gaps, period = np.diff(time), np.inf
    if amplitude.max() > 0.0 and strong[-1]:
        period = float((time[-1] - time[0]) / strong[-1])
    place = int(np.argmax(gaps))
    if not gaps[place] > LONGEST_GAP * period:
        return None
    least = f"more than a quarter of the fastest motion's period ({period:.3g} s)"
    return place, f"a gap of {gaps[place]:.3g} s at {time[place]:.4g} s, {least}"
