# SPDX-License-Identifier: Apache-2.0
"""Explicit Runge-Kutta methods of orders 2 to 8, each as (order, a, b, c).

Order 2: midpoint. 3: Bogacki and Shampine, Appl. Math. Lett. 2 (1989). 4: classical. 5: Dormand and Prince, J. Comp.
Appl. Math. 6 (1980). 6: Butcher, J. Austral. Math. Soc. 4 (1964). 7: Fehlberg, NASA TR R-287 (1968). 8: Prince and
Dormand's DOP853 (Hairer, Norsett and Wanner, section II.5). Those of orders 5 and 8 are read from scipy.
"""

import numpy as np


def _tableau(order, rows, weights):
    stages = len(weights)
    a = np.zeros((stages, stages))
    for i, row in enumerate(rows, 1):
        a[i, : len(row)] = row
    return order, a, np.array(weights, dtype=float), a.sum(axis=1)


def tableaus() -> dict:
    """The methods by name."""
    from scipy.integrate import RK45
    from scipy.integrate._ivp import dop853_coefficients as dop853

    return {
        "midpoint": _tableau(2, [[1 / 2]], [0, 1]),
        "Bogacki-Shampine": _tableau(3, [[1 / 2], [0, 3 / 4]], [2 / 9, 1 / 3, 4 / 9]),
        "classical": _tableau(4, [[1 / 2], [0, 1 / 2], [0, 0, 1]], [1 / 6, 1 / 3, 1 / 3, 1 / 6]),
        "Dormand-Prince": (5, np.pad(RK45.A, ((0, 0), (0, 1))), RK45.B.copy(), RK45.C.copy()),
        "Butcher": _tableau(
            6,
            [
                [1 / 3],
                [0, 2 / 3],
                [1 / 12, 1 / 3, -1 / 12],
                [-1 / 16, 9 / 8, -3 / 16, -3 / 8],
                [0, 9 / 8, -3 / 8, -3 / 4, 1 / 2],
                [9 / 44, -9 / 11, 63 / 44, 18 / 11, 0, -16 / 11],
            ],
            [11 / 120, 0, 27 / 40, 27 / 40, -4 / 15, -4 / 15, 11 / 120],
        ),
        "Fehlberg": _tableau(
            7,
            [
                [2 / 27],
                [1 / 36, 1 / 12],
                [1 / 24, 0, 1 / 8],
                [5 / 12, 0, -25 / 16, 25 / 16],
                [1 / 20, 0, 0, 1 / 4, 1 / 5],
                [-25 / 108, 0, 0, 125 / 108, -65 / 27, 125 / 54],
                [31 / 300, 0, 0, 0, 61 / 225, -2 / 9, 13 / 900],
                [2, 0, 0, -53 / 6, 704 / 45, -107 / 9, 67 / 90, 3],
                [-91 / 108, 0, 0, 23 / 108, -976 / 135, 311 / 54, -19 / 60, 17 / 6, -1 / 12],
                [2383 / 4100, 0, 0, -341 / 164, 4496 / 1025, -301 / 82, 2133 / 4100, 45 / 82, 45 / 164, 18 / 41],
            ],
            [41 / 840, 0, 0, 0, 0, 34 / 105, 9 / 35, 9 / 35, 9 / 280, 9 / 280, 41 / 840],
        ),
        "DOP853": (8, dop853.A[:12, :12].copy(), dop853.B.copy(), dop853.C[:12].copy()),
    }


def adams_weights(points) -> np.ndarray:
    """Weights that integrate from 0 to 1 the polynomial through values at `points`."""
    points = np.asarray(points, dtype=float)
    return np.linalg.solve(np.vander(points, increasing=True).T, 1.0 / np.arange(1, len(points) + 1))
