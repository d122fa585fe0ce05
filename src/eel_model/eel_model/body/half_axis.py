# SPDX-License-Identifier: Apache-2.0
"""One half-axis of the body along X: its square and the derivative of its square.

A half-axis grows like sqrt(X) at a rounded nose. Only its square is smooth there.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from eel_base.wording import shown
from numpy.polynomial import chebyshev

from eel_model.body.along import cuts_at
from eel_model.body.shapes import piecewise

DEGREE = 48  # of the polynomial through the square on each panel, for its derivative


class FunctionHalfAxis:
    """A half-axis given as a function of X [m]. It is smooth between the `bounds` (0, kinks, length) [m]."""

    breaks = np.empty(0)

    def __init__(self, name: str, function: Any, bounds: Sequence[float]) -> None:
        if not callable(function):
            raise ValueError(f"body {name} must be a function of X, or an array with x=, got {shown(function)}")
        self.name = name
        self.given = self._function = function
        self._bounds = np.array(bounds)
        self._check()

    @cached_property
    def _slopes(self) -> list[chebyshev.Chebyshev]:
        return [self._fit(start, end) for start, end in pairwise(self._bounds)]

    def _value(self, x: np.ndarray) -> np.ndarray:
        try:
            value = np.asarray(self._function(x), dtype=float)
            if value.shape not in (x.shape, ()):
                raise ValueError
        except (TypeError, ValueError):  # a function of one number at a time
            value = np.array([float(self._function(float(each))) for each in x.ravel()]).reshape(x.shape)
        return np.broadcast_to(value, x.shape)

    def square(self, x: np.ndarray) -> np.ndarray:
        """[m^2] at `x` [m]."""
        return self._value(np.clip(x, 0.0, self._bounds[-1])) ** 2

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Derivative of the square by X [m] at `x` (M,) [m], from the polynomial through it on each panel."""
        return piecewise(self._slopes, self._bounds, x)

    def _fit(self, start: float, end: float) -> chebyshev.Chebyshev:
        # Gauss points lie inside the panel: a jump at its ends is not seen.
        series = chebyshev.Chebyshev.interpolate(lambda x: self._value(x) ** 2, DEGREE, domain=[start, end])
        return series.deriv()

    def _check(self) -> None:
        length = self._bounds[-1]
        x = np.concatenate([np.linspace(start, end, 64) for start, end in pairwise(self._bounds)])
        values = self._value(x)
        if not np.all(np.isfinite(values)):
            worst = np.flatnonzero(~np.isfinite(values))[0]
            raise ValueError(f"body {self.name} must be finite, got {values[worst]} at X = {x[worst]:.6g} m")
        _check_shape(self.name, x, values, length)


class ArrayHalfAxis:
    """A half-axis given at points: monotone cubics through its squares (Fritsch and Butland), one between two kinks."""

    def __init__(self, name: str, x: np.ndarray, values: np.ndarray, bounds: Sequence[float]) -> None:
        from scipy.interpolate import PchipInterpolator

        if values.shape != x.shape:
            raise ValueError(f"body {name} must have as many values as x, {len(x)}, got {len(values)}")
        _check_shape(name, x, values, x[-1])
        self.given, self.breaks = np.stack((x, values)), x[1:-1]
        cuts = cuts_at(x, bounds)
        self._starts = x[cuts[:-1]]
        self._pieces = [PchipInterpolator(x[i : j + 1], values[i : j + 1] ** 2) for i, j in pairwise(cuts)]
        self._slopes = [piece.derivative() for piece in self._pieces]
        self._length = x[-1]

    def square(self, x: np.ndarray) -> np.ndarray:
        """[m^2] at `x` [m]."""
        return np.asarray(np.maximum(0.0, self._each(self._pieces, x)))

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Derivative of the square by X [m] at `x` [m]."""
        return self._each(self._slopes, x)

    def _each(self, functions: Sequence[Callable[..., Any]], x: np.ndarray) -> np.ndarray:
        return piecewise(functions, self._starts, np.clip(np.asarray(x, dtype=float), 0.0, self._length))


def _check_shape(name: str, x: np.ndarray, values: np.ndarray, length: float) -> None:
    """`ValueError` unless the half-axis is 0 at the nose and positive inside."""
    if np.any(values < 0.0):
        worst = np.argmin(values)
        raise ValueError(f"body {name} must be >= 0 m, got {values[worst]:.6g} at X = {x[worst]:.6g} m")
    if values[0] > 1e-9 * length:
        raise ValueError(
            f"body {name} must be 0 m at the nose (X = 0): a blunt nose would shed a wake, got {values[0]:.6g}"
        )
    inside = (x > 0.0) & (x < length)
    if np.any(values[inside] == 0.0):
        worst = x[inside][np.argmin(values[inside])]
        raise ValueError(
            f"body {name} must be > 0 m between nose and tail, got 0 at X = {worst:.6g} m: such a section is singular, "
            f"without inertia along axes 1 and {3 if name == 'half_width' else 2}"
        )
