# SPDX-License-Identifier: Apache-2.0
"""Laws by midline: any lateral displacement h(X, t) of a fish becomes a curvature.

X is the arc length from the nose, and h the displacement across the line on which the fish swims, towards section axis
2, as in `eel_gaits.laws.midline`, which has the formula. A wave of sines needs no rows: `lateral_wave` there.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from eel_base.quantity import numbers
from eel_base.wording import shown

from eel_gaits.laws.midline import curvature_of_lateral
from eel_gaits.sources.sampled_law import crowded

POINTS = 129  # along the body, at which h is evaluated
STEEPEST = 0.99  # of a midline's slope


class LateralMidline:
    """The midline of the lateral displacement h(X, t) [m] of a body of `length` [m].

    h(X, t): of the points X (n,) [m] at the time t [s]. `ValueError` names t and X where it does not fit.
    """

    def __init__(self, displacement: Callable[..., Any], length: float = 1.0) -> None:
        self._displacement, self.length = displacement, float(length)
        self._x = crowded(POINTS, self.length)

    def curvature(self, time: float, x: np.ndarray) -> np.ndarray:
        """Yaw curvature (n,) [rad/m] at `time` [s] and the points `x` (n,) [m]: a function for `eel_gaits.sampled`."""
        line = self._line(time)
        return curvature_of_lateral(line(x, 1), line(x, 2))

    def position(self, time: float, x: np.ndarray) -> np.ndarray:
        """Positions (n, 2) [m] of the points `x` (n,) [m], along the line of swimming from the nose, and across it."""
        from scipy.interpolate import make_interp_spline

        line = self._line(time)
        ahead = make_interp_spline(self._x, np.sqrt(1.0 - line(self._x, 1) ** 2), k=5).antiderivative()
        return np.stack((ahead(x), line(x)), axis=-1)

    def _line(self, time: float) -> Any:
        """The spline of h at `time` [s]."""
        from scipy.interpolate import make_interp_spline

        h, where = numbers("h", self._displacement(self._x.copy(), float(time))), f"at t = {time:g} s"
        if h.shape != self._x.shape:
            raise ValueError(f"h must return {POINTS} numbers for {POINTS} points X, got {shown(h)} {where}")
        if not np.all(np.isfinite(h)):
            place = np.argmin(np.isfinite(h))
            raise ValueError(f"h must be finite, got {h[place]} {where}, X = {self._x[place]:g} m")
        line = make_interp_spline(self._x, h, k=5)
        slope = np.abs(line(self._x, 1))
        if np.max(slope) > STEEPEST:
            raise ValueError(
                f"h must be less steep than {STEEPEST}, as X is the arc length, got a slope of {np.max(slope):.3g} "
                f"{where}, X = {self._x[np.argmax(slope)]:g} m"
            )
        return line
