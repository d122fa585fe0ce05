# SPDX-License-Identifier: Apache-2.0
"""Laws from midlines: any lateral displacement h(X, t) of a fish becomes a curvature.

X is the arc length from the nose, and h the displacement across the line of swimming, towards section axis 2. The
formula is in `eel_gaits.laws.midline`. For a sine wave, `lateral_wave` there makes a law without rows.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from eel_common.quantity import numbers
from eel_common.wording import shown

from eel_gaits.laws.midline import curvature_of_lateral
from eel_gaits.sources.sampled_law import crowded

POINTS = 129  # points along the body for the spline of h, which is checked at a random place between each two
MISSED = 1e-3  # largest error of the spline there, relative to the greatest h
ROUND_OFF = 1e-9  # of the length
STEEPEST = 0.99  # greatest slope of a midline
SEED = 1  # seed of the random places


class LateralMidline:
    """The midline of the lateral displacement h(X, t) [m] of a body of `length` [m].

    h(X, t): for the points X (n,) [m] at the time t [s]. `ValueError` names t and X where it is unsuitable.
    """

    def __init__(self, displacement: Callable[..., Any], length: float = 1.0) -> None:
        self._displacement, self.length = displacement, float(length)
        self._x, self._draw = crowded(POINTS, self.length), np.random.default_rng(SEED)

    def curvature(self, time: float, x: np.ndarray) -> np.ndarray:
        """Yaw curvature (n,) [rad/m] at `time` [s] and the points `x` (n,) [m]: a function for `eel_gaits.sampled`."""
        line = self._line(time)
        return curvature_of_lateral(line(x, 1), line(x, 2))

    def position(self, time: float, x: np.ndarray) -> np.ndarray:
        """Positions (n, 2) [m] of the points `x` (n,) [m]: along the line of swimming from the nose, and across it."""
        from scipy.interpolate import make_interp_spline

        line = self._line(time)
        ahead = make_interp_spline(self._x, np.sqrt(1.0 - line(self._x, 1) ** 2), k=5).antiderivative()
        return np.stack((ahead(x), line(x)), axis=-1)

    def _line(self, time: float) -> Any:
        """The spline of h at `time` [s]."""
        from scipy.interpolate import make_interp_spline

        x = np.empty(2 * POINTS - 1)
        x[::2], x[1::2] = self._x, self._x[:-1] + np.diff(self._x) * self._draw.random(POINTS - 1)
        h, where = numbers("h", self._displacement(x.copy(), float(time))), f"at t = {time:g} s"
        if h.shape != x.shape:
            raise ValueError(f"h must return {len(x)} numbers for {len(x)} points X, got {shown(h)} {where}")
        if not np.all(np.isfinite(h)):
            place = np.argmin(np.isfinite(h))
            raise ValueError(f"h must be finite, got {h[place]} {where}, X = {x[place]:g} m")
        line = make_interp_spline(self._x, h[::2], k=5)
        apart = np.abs(line(x) - h)
        if np.max(apart) > max(MISSED * np.max(np.abs(h)), ROUND_OFF * self.length):
            raise ValueError(
                f"h must be smooth along the body: {POINTS} points miss it by {np.max(apart):.2g} m {where}, "
                f"X = {x[np.argmax(apart)]:g} m"
            )
        slope = np.abs(line(self._x, 1))
        if np.max(slope) > STEEPEST:
            raise ValueError(
                f"h must be less steep than {STEEPEST}, as X is the arc length, got a slope of {np.max(slope):.3g} "
                f"{where}, X = {self._x[np.argmax(slope)]:g} m"
            )
        return line
