# SPDX-License-Identifier: Apache-2.0
"""Actions that are rates of the curvature at knots along the body: the policy shapes the body itself.

During a control step the rate changes from the last action's to the present one's as s^2 (3 - 2 s). So the curvature,
its rate and its acceleration never jump.
"""

from typing import Any

import numpy as np
from eel_common.quantity import checked_row, positive
from eel_common.wording import shown
from eel_dynamics.simulation.sampled_swimmers import Array


class KnotAction:
    """Turns actions into the curvature of the body at the ends of control steps.

    An action holds the rate at each knot, first in pitch, then in yaw, from -1 to 1 times `greatest_rate`. Signs are
    as in section axes: yaw above 0 bends the tail to the right, pitch above 0 down. Near `greatest_bend` the rate of a
    curvature is reduced so that the curvature never exceeds it.

    Args:
        knots: number from nose to tail, or their X [m]. Natural cubic splines interpolate between them.
        axes: ("yaw",), ("pitch",) or both.
        greatest_rate: [rad/m/s].
        greatest_bend: [rad/m].
        length: [m], of the body.
    """

    period = 1.0  # s: averaging time of a task, as there is no wave
    waves = None  # number of waves on the body: as many as the knots allow

    def __init__(
        self,
        knots: Any = 5,
        axes: tuple[str, ...] = ("yaw",),
        *,
        greatest_rate: float = 10.0,
        greatest_bend: float = 5.0,
        length: float = 1.0,
    ):
        length = positive("length", length, "m")
        count = isinstance(knots, int) and not isinstance(knots, bool)
        self.x = np.linspace(0.0, length, max(knots, 0)) if count else checked_row("knots", knots, None)
        if len(self.x) < 2:
            raise ValueError(f"knots must be 2 or more, or their X in m, got {shown(knots)}")
        if not (np.iterable(axes) and axes) or any(name not in ("pitch", "yaw") for name in axes):
            raise ValueError(f"axes must be pitch, yaw or both, got {shown(axes)}")
        self.axes = tuple(name for name in ("pitch", "yaw") if name in axes)
        self.greatest_rate = positive("greatest_rate", greatest_rate, "rad/m/s")
        self.greatest_bend = positive("greatest_bend", greatest_bend, "rad/m")
        self._value = self._rate = np.zeros(self.size)

    @property
    def size(self) -> int:
        """The number of values in an action."""
        return len(self.axes) * len(self.x)

    def described(self) -> list[str]:
        """One line about the values of an action: name, unit, bounds."""
        where = ", ".join(f"{x:g}" for x in self.x)
        bound = f"{self.greatest_rate:g}"
        return [
            f"rate of the curvature in {name} at X = {where} m [rad/m/s], -{bound} to {bound}" for name in self.axes
        ]

    def begin(self, own_time: Any = 0.0) -> Array:
        """Restart with a straight body, or N if `own_time` is (N,). Returns the curvature as `advance` does."""
        self._value = self._rate = np.zeros((*np.shape(own_time), self.size))
        return self._curvature()

    def begin_some(self, swimmers: list[int], own_times: Array) -> Array:
        """Restart K of N swimmers. Returns their curvature (K, 6, knots)."""
        self._value[swimmers] = self._rate[swimmers] = 0.0
        rows: Array = self._curvature()[swimmers]
        return rows

    def advance(self, action: Array, step: float) -> Array:
        """The curvature at the end of a control step of `step` [s] with this `action` (size,), or (N, size).

        Returns (6, knots), or (N, 6, knots): pitch, its rate and its acceleration, then yaw: rad/m, rad/m/s, rad/m/s^2.
        """
        up, down = (  # greatest rates: twice a step at that rate reaches the bound
            (2.0 * (self.greatest_bend - sign * self._value) / step - sign * self._rate) / 3.0 for sign in (1.0, -1.0)
        )
        rate = np.clip(self.greatest_rate * action, -np.maximum(down, 0.0), np.maximum(up, 0.0))
        self._value = self._value + 0.5 * step * (self._rate + rate)
        self._rate = rate
        return self._curvature()

    @property
    def names_of_state(self) -> list[tuple[str, str, float]]:
        """Name, unit and scale of each value of `state`."""
        at = [f"{name} at X = {x:g} m" for name in self.axes for x in self.x]
        return [(f"curvature in {name}", "rad/m", self.greatest_bend) for name in at] + [
            (f"rate of the curvature in {name}", "rad/m/s", self.greatest_rate) for name in at
        ]

    @property
    def state(self) -> list[Any]:
        """Curvature, then its rate, at the knots of each axis; (N,) each for N swimmers."""
        return [*self._value.T, *self._rate.T]

    def _curvature(self) -> Array:
        swimmers = self._value.shape[:-1]
        rows: Array = np.zeros((*swimmers, 2, 3, len(self.x)))
        for k, name in enumerate(self.axes):
            part = slice(k * len(self.x), (k + 1) * len(self.x))
            for derivative, values in enumerate((self._value, self._rate)):
                rows[..., ("pitch", "yaw").index(name), derivative, :] = values[..., part]
        curvature: Array = rows.reshape(*swimmers, 6, -1)
        return curvature
