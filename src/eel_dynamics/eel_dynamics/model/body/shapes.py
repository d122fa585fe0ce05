# SPDX-License-Identifier: Apache-2.0
"""Half-axes along X as functions that compare by value, and that files can hold: by name, or as polynomials.

Sources: boyer2010 after section 7.2.1 of Boyer, Porez and Leroyer (2010); kern2006 after Kern and Koumoutsakos,
J. Exp. Biol. 209 (2006).
"""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

DEGREE = 48  # of the polynomials through a function on each panel
LOOKS, SEED = 1024, 1  # random evaluations of a function on each panel
DETAIL = 1e-2  # error of the polynomials, relative to the greatest value, that causes a warning
KERN_HEAD, KERN_TAIL, KERN_WIDTH_OF_TAIL = 0.04, 0.95, 0.01  # of the length
KERN_MIDDLE, KERN_HEIGHT = 0.51, 0.08
KINKS = {"boyer2010": (0.05, 0.2, 0.75), "kern2006": (KERN_HEAD, KERN_TAIL)}  # of the length


@dataclass(frozen=True)
class NamedHalfAxis:
    """The half-axis `name` ("half_width" or "half_height") of the library's body `body`, `length` [m] long."""

    body: str
    name: str
    length: float

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """[m] at `x` [m]."""
        return FUNCTIONS[self.body, self.name](np.asarray(x, dtype=float), self.length)


@dataclass(frozen=True)
class PolynomialAlong:
    """A number along the body that is a Chebyshev polynomial between successive `bounds` (0, kinks, length) [m].

    coefficients: one row for each panel.
    """

    bounds: tuple[float, ...]
    coefficients: tuple[tuple[float, ...], ...]

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """Its values at `x` [m]."""
        ends = zip(pairwise(self.bounds), self.coefficients, strict=True)
        series = [chebyshev.Chebyshev(row, domain=domain) for domain, row in ends]
        return piecewise(series, self.bounds, np.asarray(x, dtype=float))


@dataclass(frozen=True)
class PolynomialHalfAxis(PolynomialAlong):
    """A half-axis whose square is such a polynomial, with coefficients [m^2]; 0 at the nose unless that is `blunt`."""

    blunt: bool = False

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """[m] at `x` [m]."""
        x = np.asarray(x, dtype=float)
        square = super().__call__(x)
        if self.blunt:
            return np.asarray(np.sqrt(np.maximum(square, 0.0)))
        square -= np.where(x <= self.bounds[1], super().__call__(0.0), 0.0)
        least = np.finfo(float).tiny  # no section inside is singular by round-off
        return np.asarray(np.sqrt(np.where(x > 0.0, np.maximum(square, least), 0.0)))


def _boyer_radius(x: np.ndarray) -> np.ndarray:
    return np.asarray(0.05 * np.sqrt(np.maximum(0.0, 1.0 - np.maximum(0.0, 1.0 - x / 0.05) ** 2)))


def _boyer_half_width(x: np.ndarray, length: float) -> np.ndarray:
    return np.asarray(_boyer_radius(x) * (0.5 - (np.sin(np.pi * x - np.pi / 2) + 1.0) / 6.0 - x**2 / 8.0))


def _boyer_half_height(x: np.ndarray, length: float) -> np.ndarray:
    part = np.clip((20.0 * x - 4.0) / 11.0, 0.0, 1.0)
    return np.asarray(_boyer_radius(x) * (1.0 - (np.sin(np.pi * part - np.pi / 2) + 1.0) / 5.0))


def _kern_half_width(x: np.ndarray, length: float) -> np.ndarray:
    s, head, tail, width = x / length, KERN_HEAD, KERN_TAIL, KERN_WIDTH_OF_TAIL
    front = np.sqrt(np.maximum(0.0, 2.0 * head * s - s**2))
    trunk = head - (head - width) * ((s - head) / (tail - head)) ** 2
    return np.asarray(length * np.where(s < head, front, np.where(s < tail, trunk, width * (1.0 - s) / (1.0 - tail))))


def _kern_half_height(x: np.ndarray, length: float) -> np.ndarray:
    s = x / length
    return np.asarray(length * KERN_HEIGHT * np.sqrt(np.maximum(0.0, 1.0 - ((s - KERN_MIDDLE) / KERN_MIDDLE) ** 2)))


FUNCTIONS = {
    ("boyer2010", "half_width"): _boyer_half_width,
    ("boyer2010", "half_height"): _boyer_half_height,
    ("kern2006", "half_width"): _kern_half_width,
    ("kern2006", "half_height"): _kern_half_height,
}


def polynomials_through(
    half_axis: Callable[[np.ndarray], np.ndarray], bounds: tuple[float, ...], blunt: bool = False
) -> PolynomialHalfAxis:
    """Polynomials through the square of a `half_axis` (function of X [m] that returns m) between the `bounds` [m]."""
    return PolynomialHalfAxis(tuple(bounds), coefficients_of(lambda x: half_axis(x) ** 2, bounds), blunt)


def coefficients_of(
    function: Callable[[np.ndarray], np.ndarray], bounds: tuple[float, ...]
) -> tuple[tuple[float, ...], ...]:
    """Rows of coefficients of the polynomials through a `function` of X [m] between the `bounds` [m]."""
    return tuple(tuple(each.coef.tolist()) for each in series_through(function, bounds))


def series_through(function: Callable[[np.ndarray], np.ndarray], bounds: Sequence[float]) -> list[Any]:
    """Chebyshev series through a `function` of X [m], one between successive `bounds` [m].

    The points lie inside the panels, so a jump at their ends has no influence.
    """
    return [chebyshev.Chebyshev.interpolate(function, DEGREE, domain=ends) for ends in pairwise(bounds)]


def warn_of_details(name: str, function: Callable[..., Any], bounds: Sequence[float], power: int = 1) -> None:
    """Warn of a `function` of X [m] whose `power` changes within a short part of a panel: a grid may not resolve it.

    It is evaluated at random X, `LOOKS` per panel. Other checks report values that are not finite.
    """
    if isinstance(function, NamedHalfAxis | PolynomialAlong):
        return
    draw = np.random.default_rng(SEED)
    parts = (np.arange(LOOKS) + draw.random(LOOKS)) / LOOKS
    x = np.concatenate([start + (end - start) * parts for start, end in pairwise(bounds)])

    def wanted(x: np.ndarray) -> np.ndarray:
        return values_along(function, x) ** power

    with np.errstate(all="ignore"):
        values = wanted(x)
        apart = np.abs(piecewise(series_through(wanted, bounds), bounds, x) - values)
    worst = int(np.argmax(apart))
    if apart[worst] > DETAIL * np.max(np.abs(values)):
        warnings.warn(
            f"{name} is not smooth near X = {x[worst]:.4g} m, between its kinks: a grid may pass over such a detail; "
            "give kinks= there, or values at x=",
            stacklevel=4,
        )


def piecewise(
    functions: Sequence[Callable[..., Any]], bounds: Sequence[float] | np.ndarray, x: np.ndarray
) -> np.ndarray:
    """Values at `x` [m] of functions of X, each between successive `bounds` [m]; a bound belongs to the first.

    The first and the last function extend beyond the bounds.
    """
    if len(functions) == 1:
        return np.asarray(functions[0](x))
    home = np.clip(np.searchsorted(bounds, x, side="left") - 1, 0, len(functions) - 1)
    result = np.empty(x.shape)
    for index, function in enumerate(functions):
        here = home == index
        result[here] = function(x[here])
    return result


def values_along(function: Callable[..., Any], x: np.ndarray) -> np.ndarray:
    """Values of a `function` of X at `x` [m]. The function accepts arrays, or one number at a time."""
    try:
        values = np.asarray(function(x), dtype=float)
        if values.shape not in (x.shape, ()):
            raise ValueError
    except (TypeError, ValueError):
        values = np.array([float(function(float(each))) for each in x.ravel()]).reshape(x.shape)
    return np.broadcast_to(values, x.shape)
