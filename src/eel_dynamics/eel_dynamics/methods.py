"""The methods that steps in time are taken by.

Adams and Bashforth's of orders 1 to 6 (their weights are in `adams`); the pair of Dormand and Prince of orders 5(4) (J.
Comp. Appl. Math. 6 (1980)), with dense output of order 4 by Shampine (Math. Comp. 46 (1986)); and the classical
Runge-Kutta method of order 4. docs/integrators.md tells why these.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from .adams import HIGHEST
from .packed import Form, Packed


class Method(NamedTuple):
    """A method whose last rate is the first of the next step: of s stages, or (`adams` > 0) Adams' of that order, whose
    rows are the rate at the start, the mean rate and the rate at the end."""

    a: np.ndarray  # (s, s)
    c: np.ndarray  # (s,)
    error: np.ndarray  # (s,) weights of the error estimate, zero where there is none
    dense: np.ndarray  # (s, 4) y(theta) = y + h sum_i k_i sum_j dense[i, j] theta^(j+1)
    adaptive: bool
    order: int  # of the error's size by the step's length
    adams: int  # order, 0: a Runge-Kutta method


@cache
def classical() -> Method:
    """The classical Runge-Kutta method of order 4; between steps the cubic that meets value and rate at both ends."""
    a = np.zeros((5, 5))
    a[1, 0], a[2, 1], a[3, 2] = 0.5, 0.5, 1.0
    a[4, :4] = 1 / 6, 1 / 3, 1 / 3, 1 / 6
    return Method(a, np.array([0.0, 0.5, 0.5, 1.0, 1.0]), np.zeros(5), _hermite(a[4]), False, 4, 0)


@cache
def adams_bashforth(order: int) -> Method:
    """Steps of Adams and Bashforth of an `order` from 1 to 6; between them as with the classical method."""
    if not 1 <= order <= HIGHEST:
        raise ValueError(f"order of the method adams must be 1 to {HIGHEST}, got {order!r}")
    return Method(
        np.zeros((3, 3)), np.array([0.0, 0.5, 1.0]), np.zeros(3), _hermite([0.0, 1.0, 0.0]), True, order + 1, order
    )


def _hermite(mean) -> np.ndarray:
    """Dense output by the cubic that meets value and rate at both ends; `mean` (s,): the weights of the mean rate."""
    dense = np.outer(mean, [0.0, 3.0, -2.0, 0.0])
    dense[0] += [1.0, -2.0, 1.0, 0.0]
    dense[-1] += [0.0, -1.0, 1.0, 0.0]
    return dense


@cache
def dormand_prince() -> Method:
    """The pair of orders 5(4)."""
    a = np.zeros((7, 7))
    a[1, :1] = 1 / 5
    a[2, :2] = 3 / 40, 9 / 40
    a[3, :3] = 44 / 45, -56 / 15, 32 / 9
    a[4, :4] = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
    a[5, :5] = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
    a[6, :6] = 35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
    error = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
    dense = np.array(
        [
            [1, -8048581381 / 2820520608, 8663915743 / 2820520608, -12715105075 / 11282082432],
            [0, 0, 0, 0],
            [0, 131558114200 / 32700410799, -68118460800 / 10900136933, 87487479700 / 32700410799],
            [0, -1754552775 / 470086768, 14199869525 / 1410260304, -10690763975 / 1880347072],
            [0, 127303824393 / 49829197408, -318862633887 / 49829197408, 701980252875 / 199316789632],
            [0, -282668133 / 205662961, 2019193451 / 616988883, -1453857185 / 822651844],
            [0, 40617522 / 29380423, -110615467 / 29380423, 69997945 / 29380423],
        ]
    )
    return Method(a, np.array([0.0, 0.2, 0.3, 0.8, 8 / 9, 1.0, 1.0]), error, dense, True, 5, 0)


METHOD = Form(classical)


@cache
def method_of(name: str, order: int) -> Packed:
    """The method of integration of an accuracy, its `Method`."""
    if name == "adams":
        return METHOD.packed(adams_bashforth(order))
    return METHOD.packed(classical() if name == "classical" else dormand_prince())
