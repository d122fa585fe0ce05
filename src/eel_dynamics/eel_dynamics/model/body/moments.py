# SPDX-License-Identifier: Apache-2.0
"""Nodal values of a field that is smooth only between the data points of a body.

The derivatives of a spline jump at its data points, which lie inside the panels. The polynomial through the nodes of a
panel then does not integrate the field exactly. So the nodal values f_j of a panel with p nodes are chosen so that
their polynomial has the field's moments, and its value at the panel's end:

    sum_j w_j f_j P_k(u_j) = integral of f P_k dX,  k = 0 ... p - 2,    f_p = f(end)

P_k: Legendre polynomials of the panel's variable u; w_j: weights of the panel's Radau points. The integral over the
panel of the field times a smooth function, such as the motion of the body, is then as exact as for a smooth field. For
an integral up to a place inside the panel, `missed_before` and `missed_within` give the correction of each node's part.
"""

from collections.abc import Callable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from eel_dynamics.model.body.grid import (
    Grid,
    Panel,
    collocation_matrix,
    integration_matrix,
    interpolation_matrix,
    radau_points,
)

# Points of Gauss' rule in each part between two breaks, and number of equal parts of a panel that are short enough
# for the waves of its polynomials.
RULES = (8, 8), (4, 64), (3, 256)
_gauss_rule = cache(legendre.leggauss)


Field = Callable[[np.ndarray], np.ndarray]  # from X (M,) [m] to values (m, M)


class Part(NamedTuple):
    """A panel with p nodes, divided at E ends into parts in which the field is smooth."""

    panel: Panel
    nodes: slice  # indices of the nodes in the grid
    ends: np.ndarray  # (E,), fractions of the panel
    at: np.ndarray  # (M,), Gauss points in each part, fractions
    field: np.ndarray  # (m, M) at these points, times the weights of Gauss' rule [m]


def with_moments(field: Field, grid: Grid, breaks: np.ndarray) -> np.ndarray:
    """Values (m, n) at the nodes of `grid` with the moments of `field` over each panel.

    field: from X (M,) [m] to values (m, M); it is smooth between the `breaks` [m], which rise.
    """
    values = field(grid.x)
    inner = [_inside(panel, breaks) for panel in grid.panels]
    for part in _parts(field, grid, [ends if len(ends) else None for ends in inner]):
        values[:, part.nodes] += _correction(part, values[:, part.nodes])
    return values


def missed_before(field: Field, values: np.ndarray, grid: Grid, breaks: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Corrections (m, M, p_max) of the nodes' parts in the integral over the panel to X = `x` (M,) [m], ascending.

    With a smooth function g, the integral of field g from the nose is the sum over those nodes of the correction times
    g, plus the integral by the `grid` of the `values` (m, n) times g.
    """
    home = grid.panel_at(x)
    ends_at = [panel.fraction(x[home == index]) for index, panel in enumerate(grid.panels)]
    ends = [
        np.concatenate((_inside(panel, breaks), each)) if len(each) else None
        for panel, each in zip(grid.panels, ends_at, strict=True)
    ]
    result = np.zeros((len(values), len(x), grid.matrix.shape[1]))
    for part in _parts(field, grid, ends):
        index = grid.panels.index(part.panel)
        missed = _missed(part, values[:, part.nodes], ends_at[index])
        result[:, home == index, : part.panel.points] = missed.transpose(1, 0, 2)
    return result


def missed_within(
    field: Field, values: np.ndarray, grid: Grid, breaks: np.ndarray, fractions: np.ndarray
) -> np.ndarray:
    """The same from the start of each node's panel to `fractions` (K,) of it, for all nodes: (m, K, n)."""
    result = np.zeros((len(fractions), *values.shape))
    ends = [np.concatenate((_inside(panel, breaks), fractions)) for panel in grid.panels]
    for part in _parts(field, grid, ends):
        result[:, :, part.nodes] = _missed(part, values[:, part.nodes], fractions)
    result = np.divide(result, values, out=np.zeros_like(result), where=values != 0.0)
    return np.ascontiguousarray(result.transpose(1, 0, 2))


def _missed(part: Part, values: np.ndarray, ends_at: np.ndarray) -> np.ndarray:
    """The corrections (K, m, p) of the panel's nodes with the `values` (m, p), up to the fractions `ends_at` (K,)."""
    panel, shape = part.panel, (len(part.ends), len(part.at) // len(part.ends))
    fields = part.field.reshape(-1, *shape).transpose(1, 0, 2)
    exact = np.cumsum(fields @ interpolation_matrix(panel.points, part.at).reshape(*shape, -1), axis=0)
    rows = integration_matrix(panel.points, ends_at) * panel.locate(radau_points(panel.points))[1]
    return np.asarray(exact[np.searchsorted(part.ends, ends_at)] - rows[:, None, :] * values)


def _correction(part: Part, values: np.ndarray) -> np.ndarray:
    """The difference of the moments from those of the `values` (m, p) at the panel's nodes; 0 at the panel's end."""
    panel, nodes = part.panel, radau_points(part.panel.points)
    scale, basis = panel.locate(nodes)[1], _legendre(panel, nodes)
    moments = part.field @ _legendre(panel, part.at)
    moments -= (values * (collocation_matrix(panel.points)[-1] * scale)) @ basis
    series = moments * (2.0 * np.arange(panel.points) + 1.0)
    series[:, -1] = -series[:, :-1].sum(axis=1)  # P_k = 1 at the panel's end
    correction = series @ basis.T
    return np.asarray(np.divide(correction, scale, out=np.zeros_like(correction), where=scale > 0.0))


def _legendre(panel: Panel, at: np.ndarray) -> np.ndarray:
    return np.asarray(legendre.legvander(2.0 * at - 1.0, panel.points - 1))


def _inside(panel: Panel, breaks: np.ndarray) -> np.ndarray:
    """The `breaks` [m], rising, inside the panel, as fractions of it."""
    first, last = np.searchsorted(breaks, panel.start, side="right"), np.searchsorted(breaks, panel.end)
    return panel.fraction(breaks[first:last])


def _parts(field: Field, grid: Grid, ends: Sequence[np.ndarray | None]) -> list[Part]:
    """The panels of `grid` with `ends` of parts, as fractions; None for a panel that is not needed."""
    parts, weights, places, begin = [], [], [], 0
    for panel, each in zip(grid.panels, ends, strict=True):
        if each is not None:
            last, at, weight = _gauss_points(each)
            x, scale = panel.locate(at)
            places.append(x)
            weights.append(weight * scale)
            parts.append(Part(panel, slice(begin, begin + panel.points), last, at, np.empty(0)))
        begin += panel.points
    if not parts:
        return parts
    fields = field(np.concatenate(places)) * np.concatenate(weights)
    cuts = np.cumsum([len(each) for each in places])[:-1]
    return [part._replace(field=each) for part, each in zip(parts, np.split(fields, cuts, axis=1), strict=True)]


def _gauss_points(breaks: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The ends of a panel's parts between its `breaks`, and points and weights of Gauss' rule in each, as fractions.

    It uses the rule with the fewest points.
    """
    number, parts = min(RULES, key=lambda rule: rule[0] * (len(breaks) + rule[1]))
    ends = np.union1d(breaks, np.arange(1, parts + 1) / parts)
    points, weights = _gauss_rule(number)
    half = 0.5 * np.diff(ends, prepend=0.0)[:, None]
    return ends, (ends[:, None] - half * (1.0 - points)).ravel(), (half * weights).ravel()
