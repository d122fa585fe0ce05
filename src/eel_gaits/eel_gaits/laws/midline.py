# SPDX-License-Identifier: Apache-2.0
"""The curvature of a midline given by its lateral displacement h(X, t).

X is the arc length from the nose, and h [m] the displacement along section axis 2 from the line on which the fish
swims. The slope is dh/dX = sin(theta), with the angle theta of the midline to that line. So the curvature is

    K3 = d theta / dX = h_XX / sqrt(1 - h_X^2).

A wave h = a(X) sin(2 pi (X / wavelength - t / period)) gives a curvature that repeats with u = 2 pi (X / wavelength -
t / period). Its Fourier series in u has odd multiples only, and each of them is two terms of a law:

    K3 = sum over m = 1, 3, 5 ... of  A_m(X) sin(m u) + B_m(X) cos(m u).
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from eel_common.quantity import numbers

from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term

STEEPEST = 0.95  # slope |dh/dX| of a midline, of 1 at most
INSTANTS = 256  # of a period
POINTS, DEGREE = 65, 10  # along the body: points of the fit, and degree of the polynomials A_m and B_m
TOLERANCE = 1e-3  # multiples with less curvature, relative to the greatest, are left out


def curvature_of_lateral(slope: Any, bend: Any) -> np.ndarray:
    """The curvature K3 [rad/m] of a midline with the `slope` dh/dX [1] and the `bend` d2h/dX2 [1/m].

    All three are arrays of one shape. `ValueError` if a slope reaches 1: no midline of that arc length exists.
    """
    slope, bend = numbers("slope", slope), numbers("bend", bend)
    steepest = float(np.max(np.abs(slope), initial=0.0))
    if not steepest < 1.0:
        raise ValueError(f"slope of the midline must be below 1, got {steepest:.3g}")
    return np.asarray(bend / np.sqrt(1.0 - slope**2))


def lateral_wave(
    amplitude: Callable[[np.ndarray], tuple[np.ndarray, ...]],
    *,
    length: float,
    wavelength: float,
    period: float,
    envelope: tuple[Ramp, ...] = (),
) -> tuple[Term, ...]:
    """Terms in yaw of the wave h = a(X) sin(2 pi (X / wavelength - t / period)), with an `envelope`.

    Each multiple that is left out is below 1/1000 of the greatest curvature.

    Args:
        amplitude: function of X [m], shape (n,), that returns a [m], da/dX [1] and d2a/dX2 [1/m], each of shape (n,).
        length: [m], of the body. wavelength: [m]. period: [s].
        envelope: ramps, as in `Term`; they multiply the curvature.

    Returns:
        the terms. `ValueError` for a midline steeper than 0.95.
    """
    x = 0.5 * length * (1.0 - np.cos(np.pi * (np.arange(POINTS) + 0.5) / POINTS))
    a, a_x, a_xx = amplitude(x)
    k = 2.0 * math.pi / wavelength
    steepest = float(np.max(np.hypot(a_x, a * k)))
    if not steepest <= STEEPEST:
        raise ValueError(
            f"lateral amplitude must be so small that the midline's slope stays below {STEEPEST}, got {steepest:.3g}"
        )
    u = 2.0 * math.pi * np.arange(INSTANTS)[:, None] / INSTANTS
    curvature = curvature_of_lateral(
        a_x * np.sin(u) + a * k * np.cos(u), (a_xx - a * k**2) * np.sin(u) + 2.0 * a_x * k * np.cos(u)
    )
    spectrum = np.fft.rfft(curvature, axis=0) * 2.0 / INSTANTS
    least = TOLERANCE * np.max(np.abs(curvature))
    terms = []
    for multiple in range(1, INSTANTS // 2, 2):
        shared: Any = {"wavelength": wavelength / multiple, "period": period / multiple, "envelope": envelope}
        for row, phase in ((-spectrum[multiple].imag, 0.0), (spectrum[multiple].real, 0.5 * math.pi)):
            if np.max(np.abs(row)) >= least:
                fit = np.polynomial.Polynomial.fit(x, row, DEGREE, domain=[0.0, length]).convert()
                terms.append(Term(amplitude=tuple(fit.coef), phase=phase, **shared))
    return tuple(terms)
