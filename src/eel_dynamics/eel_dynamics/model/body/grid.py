# SPDX-License-Identifier: Apache-2.0
"""Nodes along the body, and the matrices that integrate from the nose to each of them.

The body is cut into panels at its kinks, so that every field is smooth inside a panel. A panel has `p` right Radau
points. The last one is the panel's end. So the tail is a node, and each panel starts where the previous one ends. The
integral of the polynomial through the points (collocation; Hairer and Wanner, Solving Ordinary Differential Equations
II, section IV.5) is exact to degree 2p - 2 over a panel, and to degree p - 1 up to a point inside it.

The half-axes grow like sqrt(X) at a rounded nose. So the first panel is integrated in u with X = X_1 u^2: fields that
contain sqrt(X) are smooth in u. A tail that ends in an edge or a point has such roots too, in its perimeter or its
half-axes. There X = l - length (1 - u)^2.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import ArrayLike


@dataclass(frozen=True, kw_only=True)
class Panel:
    """Part of the body between two kinks, with `points` nodes.

    graded: the variable of integration; "start": u in X = start + length u^2; "end": u in X = end - length (1 - u)^2;
    "": X itself.
    """

    start: float
    end: float
    points: int
    graded: str = ""

    def locate(self, fraction: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """X [m] at the panel's variable `fraction` in (0, 1), and the derivative [m] of X with respect to it."""
        fraction = np.asarray(fraction, dtype=float)
        length = self.end - self.start
        if self.graded == "start":
            return self.start + length * fraction**2, 2.0 * length * fraction
        if self.graded == "end":
            return self.end - length * (1.0 - fraction) ** 2, 2.0 * length * (1.0 - fraction)
        return self.start + length * fraction, np.full_like(fraction, length)

    def fraction(self, x: ArrayLike) -> np.ndarray:
        """The panel's variable at X = `x` [m]; the inverse of `locate`."""
        part = np.clip((np.asarray(x, dtype=float) - self.start) / (self.end - self.start), 0.0, 1.0)
        if self.graded == "end":
            return np.asarray(1.0 - np.sqrt(1.0 - part))
        return np.asarray(np.sqrt(part) if self.graded else part)


class PanelPoints(NamedTuple):
    """M points along the body, each with the row that integrates over its panel up to the point."""

    matrix: np.ndarray  # (M, p_max) m: the integral from the panel's start is sum_j matrix[i, j] f[first[i] + j]
    first: np.ndarray  # (M,) unsigned, first node of the panel
    count: np.ndarray  # type: ignore[assignment]  # (M,) unsigned, nodes of the panel; not a tuple's `count`
    fraction: np.ndarray  # (M,) of the panel, in its own variable


@dataclass(frozen=True)
class Grid:
    """Nodes of all panels in order. n nodes, p_max the largest number of points of a panel.

    x (n,) [m]; weight (n,) [m]: integral over the body; previous (n,) [m]: X of the node before (0 for the first);
    first (n,): index of the first node of a node's panel; count (n,): points of that panel;
    matrix (n, p_max) [m]: integral from the panel's start to node i is sum_j matrix[i, j] f[first[i] + j];
    fraction (n,): the panel's variable; barycentric (n,): weights of the nodes in their panel's interpolation;
    series (p_max + 1, n) [m]: those rows at any place, as coefficients of Chebyshev polynomials.
    """

    panels: tuple[Panel, ...]
    x: np.ndarray
    weight: np.ndarray
    previous: np.ndarray
    first: np.ndarray
    count: np.ndarray
    matrix: np.ndarray
    fraction: np.ndarray
    barycentric: np.ndarray
    series: np.ndarray

    @staticmethod
    def of(panels: tuple[Panel, ...]) -> "Grid":
        """The grid of these `panels`, which follow one another from the nose to the tail."""
        total = sum(panel.points for panel in panels)
        widest = max(panel.points for panel in panels)
        x, weight, matrix = np.empty(total), np.empty(total), np.zeros((total, widest))
        fractions, barycentric, series = np.empty(total), np.empty(total), np.zeros((widest + 1, total))
        first, count = np.empty(total, dtype=np.uintp), np.empty(total, dtype=np.uintp)
        begin = 0
        for panel in panels:
            span = slice(begin, begin + panel.points)
            fraction = radau_points(panel.points)
            x[span], scale = panel.locate(fraction)
            x[begin + panel.points - 1] = panel.end
            matrix[span, : panel.points] = collocation_matrix(panel.points) * scale
            weight[span] = matrix[begin + panel.points - 1, : panel.points]
            first[span], count[span] = begin, panel.points
            fractions[span], barycentric[span] = fraction, barycentric_weights(panel.points)
            series[: panel.points + 1, span] = _integral_series(panel.points) * scale
            begin += panel.points
        previous = np.concatenate(([0.0], x[:-1]))
        return Grid(panels, x, weight, previous, first, count, matrix, fractions, barycentric, series)

    def interpolation_at(self, x: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        """The function from fields at the nodes (..., n) to their values at X = `x` (M,) [m]: (..., M)."""
        rows, first, *_ = self.points_at(x, "value")
        last = len(self.x) - 1

        def values(fields: np.ndarray) -> np.ndarray:
            nodes = (np.minimum(first + j, last).astype(np.int64) for j in range(rows.shape[1]))
            return np.asarray(sum(rows[:, j] * fields[..., node] for j, node in enumerate(nodes)))

        return values

    def panel_at(self, x: np.ndarray) -> np.ndarray:
        """Index (M,) of the panel that holds X = `x` (M,) [m]. A kink belongs to the panel that it ends."""
        ends = np.array([panel.end for panel in self.panels])
        return np.asarray(np.minimum(np.searchsorted(ends, x, side="left"), len(ends) - 1))

    def points_at(self, x: np.ndarray, kind: str = "integral") -> PanelPoints:
        """The points at X = `x` (M,) [m], ascending, with rows that convert nodal values to values there.

        kind "integral": the integral from the start of the panel to X [m]. kind "value": the interpolating polynomial.
        """
        maker = {"integral": integration_matrix, "value": interpolation_matrix}[kind]
        x = np.asarray(x, dtype=float)
        home, rows, fraction = self.panel_at(x), np.zeros((len(x), self.matrix.shape[1])), np.empty(len(x))
        counts = np.array([panel.points for panel in self.panels])
        for index, panel in enumerate(self.panels):
            here = np.flatnonzero(home == index)
            if len(here):
                fraction[here] = panel.fraction(x[here])
                part = maker(panel.points, fraction[here])
                if kind == "integral":
                    part = part * panel.locate(radau_points(panel.points))[1]
                rows[here, : panel.points] = part
        first = (np.cumsum(counts) - counts)[home]
        return PanelPoints(rows, first.astype(np.uintp), counts[home].astype(np.uintp), fraction)


@cache
def radau_points(points: int) -> np.ndarray:
    """The right Radau points in (0, 1], ascending: zeros of P_p - P_(p-1) on (-1, 1], mapped."""
    if points == 1:
        return np.array([1.0])
    series = np.zeros(points + 1)
    series[points], series[points - 1] = 1.0, -1.0
    zeros = np.sort(legendre.legroots(series).real)
    slope = legendre.legder(series)
    for _ in range(3):
        zeros = zeros - legendre.legval(zeros, series) / legendre.legval(zeros, slope)
    zeros[-1] = 1.0
    return 0.5 * (zeros + 1.0)


@cache
def collocation_matrix(points: int) -> np.ndarray:
    """Integral from 0 to each Radau point of the polynomial through the Radau points: (points, points)."""
    return integration_matrix(points, radau_points(points))


@cache
def barycentric_weights(points: int) -> np.ndarray:
    """Weights (points,) of the Radau points in the barycentric formula, up to a common factor.

    Berrut and Trefethen, SIAM Review 46 (2004).
    """
    at = radau_points(points)
    distance = 4.0 * (at[:, None] - at[None, :]) + np.eye(points)  # in quarters: the products stay within range
    return np.asarray(1.0 / np.prod(distance, axis=1))


def interpolation_matrix(points: int, at: ArrayLike) -> np.ndarray:
    """Values at `at` (M,) in [0, 1] of the polynomial through the Radau points: (M, points)."""
    return np.asarray(chebyshev.chebvander(2.0 * np.asarray(at, dtype=float) - 1.0, points - 1) @ _series(points))


def integration_matrix(points: int, end: ArrayLike) -> np.ndarray:
    """Integral from 0 to `end` (M,) in [0, 1] of the polynomial through the Radau points: (M, points)."""
    return np.asarray(chebyshev.chebvander(2.0 * np.asarray(end, dtype=float) - 1.0, points) @ _integral_series(points))


@cache
def _series(points: int) -> np.ndarray:
    """The polynomial through values at the Radau points as a Chebyshev series: (points, points)."""
    return np.linalg.inv(chebyshev.chebvander(2.0 * radau_points(points) - 1.0, points - 1))


@cache
def _integral_series(points: int) -> np.ndarray:
    """The integral from 0 of that polynomial as a Chebyshev series: (points + 1, points)."""
    return 0.5 * chebyshev.chebint(_series(points), lbnd=-1)
