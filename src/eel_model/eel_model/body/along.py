# SPDX-License-Identifier: Apache-2.0
"""A number of the body along X, such as its mass per length: one value, a function, or values at the body's points."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from eel_base.quantity import checked_row, is_finite, number
from eel_base.wording import shown
from numpy.typing import ArrayLike

from eel_model.body.shapes import piecewise

ROUND_OFF = 1e-12  # of the greatest value, by which one may be below a minimum


class AlongBody:
    """Values along X [m], smooth between the `bounds` (0, kinks, length) [m].

    given: a number, a function of X, or an array at the points `x` (M,) [m], between which monotone cubics go.
    `ValueError` for values that are not finite, or below `minimum`.
    """

    def __init__(
        self,
        name: str,
        unit: str,
        given: Any,
        x: np.ndarray | None,
        bounds: Sequence[float],
        minimum: float | None = None,
    ) -> None:
        self.given, self._length, self._cubics = given, bounds[-1], None
        if callable(given):
            at = np.concatenate([np.linspace(*ends, 64) for ends in pairwise(bounds)])
            values = self(at)
        elif is_finite(given):
            self.given = number(name, given, minimum=minimum, unit=unit)
            return
        elif x is None:
            raise ValueError(f"{name} must be a number or a function of X, or an array with x=, got {shown(given)}")
        else:
            self.given = values = checked_row(name, given, None)
            if values.shape != x.shape:
                raise ValueError(f"{name} must have as many values as x, {len(x)}, got {len(values)}")
            at, self._cubics = x, _cubics(x, values, bounds)
        least = -np.inf if minimum is None else minimum - ROUND_OFF * np.max(np.abs(values))
        wrong = ~np.isfinite(values) | (values < least)
        if wrong.any():
            wanted = "finite" if minimum is None else f">= {minimum:g} {unit}"
            first = np.flatnonzero(wrong)[0]
            raise ValueError(f"{name} must be {wanted}, got {values[first]:.6g} at X = {at[first]:.6g} m")

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """The values at `x` [m]."""
        at: np.ndarray = np.clip(np.asarray(x, dtype=float), 0.0, self._length)
        if self._cubics is not None:
            return piecewise(*self._cubics, at)
        return np.array(np.broadcast_to(self.given(at) if callable(self.given) else self.given, at.shape), dtype=float)


def _cubics(x: np.ndarray, values: np.ndarray, bounds: Sequence[float]) -> tuple[list[Any], np.ndarray]:
    """Monotone cubics (Fritsch and Butland), one between two kinks that are points, and where they start."""
    from scipy.interpolate import PchipInterpolator

    cuts = cuts_at(x, bounds)
    return [PchipInterpolator(x[i : j + 1], values[i : j + 1]) for i, j in pairwise(cuts)], x[cuts[:-1]]


def cuts_at(x: np.ndarray, bounds: Sequence[float] | np.ndarray) -> list[int]:
    """The indices of the points `x` (M,) [m] at which a curve through them is cut: the ends, and those at a kink."""
    near = [int(np.argmin(np.abs(x - kink))) for kink in bounds[1:-1] if np.min(np.abs(x - kink)) < 1e-9 * x[-1]]
    return [0, *near, len(x) - 1]
