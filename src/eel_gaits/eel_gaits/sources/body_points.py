# SPDX-License-Identifier: Apache-2.0
"""Points along the body, as many as natural splines through them need to meet a curvature."""

from collections.abc import Callable

import numpy as np

from eel_gaits.laws.spline import natural_spline

POINTS = 17, 25, 33, 49, 65, 97, 129, 193, 257, 385, 513  # along the body


def crowded(count: int, length: float) -> np.ndarray:
    """X (count,) [m] from nose to tail, closer together at the ends, where the second derivative of a natural spline
    is 0 and that of the curvature is not."""
    return 0.5 * length * (1.0 - np.cos(np.linspace(0.0, np.pi, count)))


def points_for(value_at: Callable[[np.ndarray], np.ndarray], length: float, tolerance: float) -> np.ndarray:
    """X (n,) [m] with natural splines through which value_at(X) (..., n) [rad/m] is met to a part `tolerance`.

    `ValueError` where no number of points meets it.
    """
    check = np.linspace(0.0, length, 4 * POINTS[-1] // 3)
    wanted = value_at(check)
    scale = np.max(np.abs(wanted))
    for count in POINTS:
        x = crowded(count, length)
        apart = np.abs(natural_spline(x, value_at(x), check) - wanted)
        if not np.max(apart) > tolerance * scale:
            return x
    place = check[np.unravel_index(np.argmax(apart), apart.shape)[-1]]
    raise ValueError(
        f"the curvature must be smooth along the body: {POINTS[-1]} points miss it by {np.max(apart) / scale:.2g} of "
        f"its greatest value at X = {place:g} m"
    )
