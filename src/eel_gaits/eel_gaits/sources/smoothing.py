# SPDX-License-Identifier: Apache-2.0
"""Smoothing splines for measured data. The noise is estimated from the data.

The spline s of degree 5 through the points x_1 < ... < x_n minimises

    sum_i |y_i - s(x_i)|^2 + p * integral |s'''(x)|^2 dx

The penalty p minimises the generalised cross-validation (Craven and Wahba, Numerische Mathematik 31 (1979),
doi:10.1007/BF01404567; quintic splines for accelerations: Woltring, Adv. Eng. Softw. 8 (1986)),

    V(p) = n RSS / (n - trace of A(p))^2,   s(x) = A(p) y,

whose minimum predicts left-out data best, if the noise is uncorrelated. The knots are those of the interpolating spline
with not-a-knot ends, which is the limit p = 0.

In time, the columns of y are first transformed to principal components (Jolliffe, Principal Component Analysis, 2002).
Each has its own penalty: the few that hold the motion stay, and the many that hold only noise vanish.
"""

from typing import Any, NamedTuple

import numpy as np

DEGREE = 5
FEWEST = 7  # points
POWERS = np.arange(-6.0, 12.1, 0.5)  # logarithms (base 10) of the trial values of p, for points one unit apart


class Smoothed(NamedTuple):
    """Splines through the columns of the data, and the effect of smoothing."""

    spline: Any  # scipy.interpolate.BSpline, (..., columns)
    degrees: float  # of freedom left to each column, on average: n without smoothing


def interpolated(x: np.ndarray, values: np.ndarray) -> Smoothed:
    """Splines through `values` (n, columns) at `x` (n,), n >= 7, without smoothing."""
    from scipy.interpolate import make_interp_spline

    return Smoothed(make_interp_spline(x, values, k=DEGREE), float(len(x)))


def smoothed_in_time(time: np.ndarray, values: np.ndarray) -> Smoothed:
    """Smoothing splines through `values` (N, columns) at `time` (N,), with a penalty for each principal component."""
    from scipy.interpolate import BSpline

    centre = values.mean(axis=0)
    parts, sizes, shapes = np.linalg.svd(values - centre, full_matrices=False)
    found = smoothed(time, parts * sizes, together=False)
    spline = BSpline(found.spline.t, found.spline.c @ shapes + centre, DEGREE)
    return Smoothed(spline, found.degrees * len(sizes) / values.shape[1])


def smoothed(x: np.ndarray, values: np.ndarray, together: bool = True) -> Smoothed:
    """Smoothing splines through `values` (n, columns) at `x` (n,), n >= 7. together: with one penalty for all."""
    from scipy.interpolate import BSpline
    from scipy.linalg import cho_solve_banded, cholesky_banded

    count = len(x)
    unit = (x - x[0]) / (x[-1] - x[0]) * (count - 1)
    knots = np.concatenate(([unit[0]] * (DEGREE + 1), unit[3:-3], [unit[-1]] * (DEGREE + 1)))
    design = BSpline.design_matrix(unit, knots, DEGREE).tocsr()
    gram, rough = _bands(design.T @ design), _bands(_roughness(knots))
    centre = values.mean(axis=0)
    right = design.T @ (values - centre)
    best = np.full(values.shape[1], np.inf)
    coefficients, degrees = np.zeros_like(values), np.full(values.shape[1], float(count))
    for power in POWERS:
        try:
            factor = cholesky_banded(gram + 10.0**power * rough, lower=True)
        except np.linalg.LinAlgError:  # the penalty is too large for the matrix's rounding
            break
        trial, left = cho_solve_banded((factor, True), right), trace_of_quotient(factor, gram)
        score = np.sum((values - centre - design @ trial) ** 2, axis=0) / max(1.0 - left / count, 1e-12) ** 2
        score = np.full_like(score, score.sum()) if together else score
        better = score < best
        best[better], coefficients[:, better], degrees[better] = score[better], trial[:, better], left
    places = x[0] + (x[-1] - x[0]) / (count - 1) * knots
    return Smoothed(BSpline(places, coefficients + centre, DEGREE), float(degrees.mean()))


def _roughness(knots: np.ndarray) -> Any:
    """The matrix (n, n) of integrals of products of the third derivatives of the B-splines on these `knots`."""
    from scipy.interpolate import BSpline
    from scipy.sparse import diags

    count, slopes = len(knots) - DEGREE - 1, None
    for order in range(3):  # from coefficients of the spline to those of its derivative
        degree = DEGREE - order
        inner = knots[order : len(knots) - order]
        weight = degree / (inner[degree + 1 : degree + count - order] - inner[1 : count - order])
        step = diags([-weight, weight], [0, 1], shape=(count - order - 1, count - order))
        slopes = step if slopes is None else step @ slopes
    points, weights = np.polynomial.legendre.leggauss(3)
    ends = np.unique(knots)
    at = (0.5 * (ends[1:] + ends[:-1])[:, None] + 0.5 * np.diff(ends)[:, None] * points).ravel()
    weight = (0.5 * np.diff(ends)[:, None] * weights).ravel()
    third = BSpline.design_matrix(at, knots[3:-3], DEGREE - 3).tocsr() @ slopes
    return third.T @ diags(weight) @ third


def _bands(matrix: Any) -> np.ndarray:
    """The lower bands (6, n) of a symmetric sparse `matrix`, as `scipy.linalg.cholesky_banded` takes them."""
    bands = np.zeros((DEGREE + 1, matrix.shape[0]))
    for offset in range(min(DEGREE + 1, matrix.shape[0])):
        bands[offset, : matrix.shape[0] - offset] = matrix.diagonal(-offset)
    return bands


def trace_of_quotient(factor: np.ndarray, gram: np.ndarray) -> float:
    """Trace of S^-1 G for bands of the factor of S = L L^T and of G: the bands of S^-1 alone, from the last row up.

    After Takahashi, Fagan and Chin (1973), as in Hutchinson and de Hoog, Numerische Mathematik 47 (1985),
    doi:10.1007/BF01389878.
    """
    width, count = DEGREE, gram.shape[1]
    window = np.zeros((width, width))  # the part of S^-1 in the rows after the present one
    total = 0.0
    below = factor[1:] / factor[0]  # L with columns scaled to 1 on the diagonal
    for row in range(count - 1, -1, -1):
        column = below[:, row]
        beside = -window @ column
        diagonal = 1.0 / factor[0, row] ** 2 - column @ beside
        total += diagonal * gram[0, row] + 2.0 * (beside @ gram[1:, row])
        window[1:, 1:] = window[:-1, :-1].copy()
        window[0, 0], window[0, 1:], window[1:, 0] = diagonal, beside[:-1], beside[:-1]
    return float(total)
