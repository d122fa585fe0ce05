# SPDX-License-Identifier: Apache-2.0
"""Data of a body along X: its half-axes, and numbers such as its mass per length.

At a rounded nose a half-axis grows like sqrt(X), and only its square is smooth.
"""

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from eel_common.quantity import checked_row, is_finite, number
from eel_common.wording import shown
from numpy.typing import ArrayLike

from eel_dynamics.model.body.shapes import piecewise, series_through, values_along, warn_of_details

ROUND_OFF = 1e-12  # of the greatest value: tolerance below a minimum
Bounds = Sequence[float]  # m: 0, kinks, length; between two of them a field is smooth


class AlongBody:
    """Values along X [m], smooth between the `bounds`.

    given: a number, a function of X, or an array at the points `x` (M,) [m], interpolated by monotone cubics.
    `ValueError` for values that are not finite, or below `minimum`.
    """

    def __init__(
        self, name: str, unit: str, given: Any, x: np.ndarray | None, bounds: Bounds, minimum: float | None = None
    ) -> None:
        self.given, self._bounds, self._length, self._cubics = given, bounds, bounds[-1], None
        if callable(given):
            at = _points(bounds)
            values = self(at)
            warn_of_details(name, given, bounds)
        elif is_finite(given):
            self.given = number(name, given, minimum=minimum, unit=unit)
            return
        elif x is None:
            raise ValueError(f"{name} must be a number or a function of X, or an array with x=, got {shown(given)}")
        else:
            self.given = values = _checked_values(name, given, x)
            at, self._cubics = x, _cubics(x, values, bounds)
        least = -np.inf if minimum is None else minimum - ROUND_OFF * np.max(np.abs(values))
        wrong = ~np.isfinite(values) | (values < least)
        if wrong.any():
            wanted = "finite" if minimum is None else f">= {minimum:g} {unit}"
            first = np.flatnonzero(wrong)[0]
            raise ValueError(f"{name} must be {wanted}, got {values[first]:.6g} at X = {at[first]:.6g} m")

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Derivative with respect to X at `x` [m]; of a function, from the polynomial through it on each panel."""
        if self._cubics is None and not callable(self.given):
            return np.zeros(np.shape(x))
        return piecewise(*self._slopes, np.clip(x, 0.0, self._length))

    @cached_property
    def _slopes(self) -> tuple[list[Any], Any]:
        return _slopes_of(self, self._cubics, self._bounds)

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """The values at `x` [m]."""
        at: np.ndarray = np.clip(np.asarray(x, dtype=float), 0.0, self._length)
        if self._cubics is not None:
            return piecewise(*self._cubics, at)
        return np.array(np.broadcast_to(self.given(at) if callable(self.given) else self.given, at.shape), dtype=float)


class HalfAxis:
    """A half-axis along X [m]: a function that returns m, or an array [m] at the points `x` (M,) [m].

    The squares of an array are interpolated by monotone cubics (Fritsch and Butland). `ValueError` unless the half-axis
    is 0 at a nose that is not `blunt`, and positive inside.

    Attributes:
        given: the function, or X and values (2, M).
        breaks: X [m] inside the body where a derivative may jump: the points of an array.
    """

    def __init__(self, name: str, given: Any, x: np.ndarray | None, bounds: Bounds, blunt: bool = False) -> None:
        self.given, self.breaks, self._cubics, self._bounds = given, np.empty(0), None, bounds
        if x is not None:
            at, values = x, _checked_values(f"body {name}", given, x)
            self.given, self.breaks = np.stack((x, values)), x[1:-1]
            self._cubics = _cubics(x, values**2, bounds)
        elif callable(given):
            at = _points(bounds)
            values = values_along(given, at)
            warn_of_details(f"body {name}", given, bounds, 2)
        else:
            raise ValueError(f"body {name} must be a function of X, or an array with x=, got {shown(given)}")
        _check_shape(name, at, values, bounds[-1], blunt)

    def square(self, x: np.ndarray) -> np.ndarray:
        """[m^2] at `x` [m]."""
        x = np.clip(x, 0.0, self._bounds[-1])
        if self._cubics is None:
            return values_along(self.given, x) ** 2
        return np.asarray(np.maximum(0.0, piecewise(*self._cubics, x)))

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Derivative of the square by X [m] at `x` [m]; of a function, from its polynomial on each panel."""
        return piecewise(*self._slopes, np.clip(x, 0.0, self._bounds[-1]))

    @cached_property
    def _slopes(self) -> tuple[list[Any], Any]:
        return _slopes_of(lambda x: values_along(self.given, x) ** 2, self._cubics, self._bounds)


def _slopes_of(function: Any, cubics: Any, bounds: Bounds) -> tuple[list[Any], Any]:
    """Derivatives of the `cubics`, or of the polynomials through a `function` of X, and their starting points."""
    if cubics is not None:
        return [piece.derivative() for piece in cubics[0]], cubics[1]
    return [each.deriv() for each in series_through(function, bounds)], bounds


def _points(bounds: Bounds) -> np.ndarray:
    """X [m] at which a function is checked."""
    return np.concatenate([np.linspace(*ends, 64) for ends in pairwise(bounds)])


def _checked_values(name: str, given: Any, x: np.ndarray) -> np.ndarray:
    values = checked_row(name, given, None)
    if values.shape != x.shape:
        raise ValueError(f"{name} must have as many values as x, {len(x)}, got {len(values)}")
    return values


def _cubics(x: np.ndarray, values: np.ndarray, bounds: Bounds) -> tuple[list[Any], np.ndarray]:
    """Monotone cubics (Fritsch and Butland), one between two kinks that are data points, and their starting points."""
    from scipy.interpolate import PchipInterpolator

    near = [int(np.argmin(np.abs(x - kink))) for kink in bounds[1:-1] if np.min(np.abs(x - kink)) < 1e-9 * x[-1]]
    cuts = [0, *near, len(x) - 1]
    return [PchipInterpolator(x[i : j + 1], values[i : j + 1]) for i, j in pairwise(cuts)], x[cuts[:-1]]


def _check_shape(name: str, x: np.ndarray, values: np.ndarray, length: float, blunt: bool) -> None:
    """`ValueError` unless the half-axis is finite, 0 at a nose that is not `blunt`, and positive inside."""
    if not np.isfinite(values).all():
        worst = np.flatnonzero(~np.isfinite(values))[0]
        raise ValueError(f"body {name} must be finite, got {values[worst]} at X = {x[worst]:.6g} m")
    if np.any(values < 0.0):
        worst = np.argmin(values)
        raise ValueError(f"body {name} must be >= 0 m, got {values[worst]:.6g} at X = {x[worst]:.6g} m")
    if values[0] > 1e-9 * length and not blunt:
        raise ValueError(
            f"body {name} must be 0 m at the nose (X = 0), or the body has blunt_nose on, got {values[0]:.6g}"
        )
    if values[0] == 0.0 and blunt:
        raise ValueError(f"body {name} must be > 0 m at a blunt nose (X = 0), got 0")
    inside = (x > 0.0) & (x < length)
    if np.any(values[inside] == 0.0):
        worst = x[inside][np.argmin(values[inside])]
        raise ValueError(
            f"body {name} must be > 0 m between nose and tail, got 0 at X = {worst:.6g} m: such a section is singular, "
            f"without inertia along axes 1 and {3 if name == 'half_width' else 2}"
        )
