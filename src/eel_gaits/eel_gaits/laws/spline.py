# SPDX-License-Identifier: Apache-2.0
"""Natural cubic splines through many rows of values at once.

The spline s through the knots x_0 < ... < x_(n-1) is a piecewise cubic. s, s' and s'' are continuous, and s'' = 0 at
both end knots. Its second derivatives M_i at the knots ("moments") solve the tridiagonal system

    h_(i-1) M_(i-1) + 2 (h_(i-1) + h_i) M_i + h_i M_(i+1) = 6 (d_i - d_(i-1)),   h_i = x_(i+1) - x_i,
    d_i = (s_(i+1) - s_i) / h_i,   i = 1 ... n-2,   M_0 = M_(n-1) = 0

(de Boor, A Practical Guide to Splines, 1978, chapter IV). Beyond its end knots the spline continues as a straight line.
"""

from typing import Any

import numpy as np
from eel_common.quantity import numbers
from eel_common.wording import shown


def natural_spline(knots: Any, values: Any, x: Any) -> np.ndarray:
    """Evaluate the natural cubic splines through (knots, values) at x. `ValueError` names a bad argument.

    The result is linear in the values. So `natural_spline(knots, numpy.eye(n), x).T` is the matrix, shape (m, n), that
    takes values at the knots to values at x.

    Args:
        knots: [m], shape (n,), n >= 2, strictly increasing.
        values: [any], shape (..., n); one spline per row.
        x: [m], shape (m,), points of evaluation, also outside the knots.

    Returns:
        [unit of the values], shape (..., m).
    """
    knots, values, x = numbers("knots", knots), numbers("values", values), numbers("x", x)
    if knots.ndim != 1 or knots.size < 2:
        raise ValueError(f"knots must be a row of at least 2 numbers, got shape {knots.shape}")
    if not np.all(np.isfinite(knots)) or not np.all(np.diff(knots) > 0.0):
        raise ValueError(f"knots must be finite and strictly increasing, got {shown(knots.tolist())}")
    if values.ndim < 1 or values.shape[-1] != knots.size:
        raise ValueError(f"values must have {knots.size} entries per row, one for each knot, got shape {values.shape}")

    spacing = np.diff(knots)
    slopes = np.diff(values, axis=-1) / spacing
    moments = _moments(spacing, slopes)
    start_slopes = slopes - spacing * (2.0 * moments[..., :-1] + moments[..., 1:]) / 6.0

    inside = np.clip(x, knots[0], knots[-1])
    piece = np.clip(np.searchsorted(knots, inside, side="right") - 1, 0, knots.size - 2)
    step = inside - knots[piece]
    cubic = (moments[..., piece + 1] - moments[..., piece]) / (6.0 * spacing[piece])
    result = values[..., piece] + step * (start_slopes[..., piece] + step * (0.5 * moments[..., piece] + step * cubic))
    end_slope = slopes[..., -1] + spacing[-1] * moments[..., -2] / 6.0
    whole: np.ndarray = (
        result
        + start_slopes[..., :1] * np.minimum(x - knots[0], 0.0)
        + end_slope[..., np.newaxis] * np.maximum(x - knots[-1], 0.0)
    )
    return whole


def _moments(spacing: Any, slopes: np.ndarray) -> np.ndarray:
    """Second derivatives at the knots, shape (..., n), by elimination without pivoting (diagonally dominant).

    The loops use Python floats for a single spline: NumPy would take ten times as long.
    """
    rows: Any = np.moveaxis(6.0 * np.diff(slopes, axis=-1), -1, 0)
    rows, zero = (rows.tolist(), 0.0) if rows.ndim == 1 else (list(rows), np.zeros(slopes.shape[:-1]))
    pivots, spacing = (2.0 * (spacing[:-1] + spacing[1:])).tolist(), spacing.tolist()
    for row in range(1, len(rows)):
        factor = spacing[row] / pivots[row - 1]
        pivots[row] -= factor * spacing[row]
        rows[row] = rows[row] - factor * rows[row - 1]
    moments = [zero] * (len(rows) + 2)
    for row in reversed(range(len(rows))):
        moments[row + 1] = (rows[row] - spacing[row + 1] * moments[row + 2]) / pivots[row]
    return np.stack(moments, axis=-1)
