# SPDX-License-Identifier: Apache-2.0
"""A law from a function K(t, X): rows at instants and points so close together that they meet the function.

Points and rows are added until what lies between them differs from the function by no more than a part `tolerance` of
the greatest curvature. Derivatives that the function does not give are those of the spline of degree 5 through the
rows.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from eel_base.quantity import numbers, positive
from eel_base.wording import shown

from eel_gaits.sources.sampled_law import SampledLaw, points_for, quintic

TOLERANCE = 1e-5
FIRST_ROWS, MOST_ROWS = 17, 20_000
LOOKS = 24  # instants at which the points along the body are chosen
SMOOTH = 1e-3  # part of the accelerations' root mean square by which those that are found may still change


def sampled(
    function: Callable[..., Any],
    duration: float,
    *,
    length: float = 1.0,
    tolerance: float = TOLERANCE,
    name: str | None = None,
) -> SampledLaw:
    """The law of `function` from t = 0 to `duration` [s], for a body of `length` [m].

    function(t, X): curvature [rad/m] at the time t [s] and the points X (n,) [m]. It returns yaw (n,), or pitch and yaw
    (2, n); or, with rate [rad/m/s] and acceleration [rad/m/s^2] in time, (3, 2, n), or what `Law.curvature` returns,
    (3, n, 3). name: by default the function's.

    `ValueError` names t and X where the function returns something else, or jumps.
    """
    duration, length = positive("duration", duration, "s"), positive("length", length, "m")
    tolerance, curvature = positive("tolerance", tolerance), CheckedFunction(function)
    instants = np.linspace(0.0, duration, LOOKS)
    x = points_for(lambda x: np.array([curvature(t, x)[0] for t in instants]), length, tolerance)
    time, values, missed = _rows(curvature, duration, x, tolerance)
    about = f"a function in {len(time)} rows of {len(x)} points, which miss it by {missed:.1g} of its greatest value"
    name = getattr(function, "__name__", type(function).__name__) if name is None else name
    return SampledLaw(time, x, values, name=name, about=about)


class CheckedFunction:
    """Calls a user's function, and checks what it returns. `given`: whether it returns derivatives too."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function
        self.given: bool | None = None

    def __call__(self, time: float, x: np.ndarray) -> np.ndarray:
        """Curvature (1, 2, n), or with derivatives (3, 2, n), at `time` [s] and `x` (n,) [m]."""
        count, where = len(x), f"at t = {time:g} s"
        returned = self._function(float(time), x.copy())
        try:
            found = numbers("", returned)
        except ValueError:
            found = None
        if found is not None and found.shape == (3, count, 3):
            found = found[:, :, 1:].swapaxes(1, 2)
        elif found is not None and found.shape in ((count,), (2, count)):
            found = np.stack((np.zeros(count), found))[None] if found.ndim == 1 else found[None]
        if found is None or found.shape not in ((1, 2, count), (3, 2, count)):
            got = shown(returned) if found is None else f"the shape {found.shape}"
            raise ValueError(
                f"the curvature's function must return numbers of the shape ({count},), (2, {count}), (3, 2, {count}) "
                f"or (3, {count}, 3) for {count} points X, got {got} {where}"
            )
        if not np.all(np.isfinite(found)):
            _, axis, point = np.argwhere(~np.isfinite(found))[0]
            bad = found[:, axis, point][~np.isfinite(found[:, axis, point])][0]
            raise ValueError(
                f"the curvature's function must be finite, got {bad} in {('pitch', 'yaw')[axis]} {where}, "
                f"X = {x[point]:g} m"
            )
        if self.given is None:
            self.given = len(found) == 3
        if self.given != (len(found) == 3):
            raise ValueError(f"the curvature's function must give derivatives always or never, got another way {where}")
        return found


def _rows(
    curvature: CheckedFunction, duration: float, x: np.ndarray, tolerance: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Times (N,), values (N, 2, 3, n) and the greatest distance between rows, relative to the greatest curvature."""
    from scipy.interpolate import make_interp_spline

    def evaluated(instants: np.ndarray) -> np.ndarray:
        return np.array([curvature(t, x) for t in instants]).swapaxes(1, 2)  # (N, 2, 1 or 3, n)

    def completed(time: np.ndarray, values: np.ndarray) -> np.ndarray:
        if curvature.given:
            return values
        spline = make_interp_spline(time, values[:, :, 0], k=5)
        return np.stack([spline(time, order) if order else values[:, :, 0] for order in range(3)], axis=2)

    time = np.linspace(0.0, duration, FIRST_ROWS)
    values = evaluated(time)
    rows = completed(time, values)
    while True:
        middle = 0.5 * (time[1:] + time[:-1])
        between = evaluated(middle)
        step = time[1] - time[0]
        start, end = (rows[each].transpose(2, 0, 1, 3) for each in (slice(None, -1), slice(1, None)))
        guessed = quintic(start, end, step, 0.5).transpose(1, 2, 0, 3)
        scale = np.max(np.abs(np.concatenate((values[:, :, 0], between[:, :, 0]))))
        apart = np.abs(guessed[:, :, 0] - between[:, :, 0]).max(axis=(1, 2))
        merged = np.empty((2 * len(time) - 1, *values.shape[1:]))
        merged[::2], merged[1::2] = values, between
        time, values, coarse = np.linspace(0.0, duration, 2 * len(time) - 1), merged, rows
        rows = completed(time, values)
        change = np.sqrt(np.mean((rows[::2, :, 2] - coarse[:, :, 2]) ** 2))
        missed = float(np.max(apart) / scale) if scale > 0.0 else 0.0
        last = 2 * len(time) > MOST_ROWS  # accelerations that jump are then found to SMOOTH almost everywhere
        if missed <= tolerance and (last or change <= SMOOTH * np.sqrt(np.mean(rows[:, :, 2] ** 2))):
            return time, rows, missed
        if last:
            raise ValueError(
                f"the curvature's function must be smooth in time: {len(time)} rows miss it by {missed:.2g} of its "
                f"greatest value at t = {middle[np.argmax(apart)]:g} s; the tolerance is {tolerance:g}"
            )
