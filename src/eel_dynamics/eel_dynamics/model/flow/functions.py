# SPDX-License-Identifier: Apache-2.0
"""A flow defined by a user's function. It runs in Python: one swimmer at a time."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from eel_common.quantity import checked_instance, number
from eel_common.wording import shown

import eel_core
from eel_dynamics.model.flow.flow import ROWS, Flow, FlowTraits

Field = Callable[[np.ndarray, float], Any]


@dataclass(frozen=True, kw_only=True)
class LostFunction:
    """Placeholder for the function of a saved flow: files hold no code. A call raises `ValueError`."""

    name: str

    def __call__(self, places: np.ndarray, time: float) -> Any:
        raise ValueError(f"flow {shown(self.name)} is a function, which its file does not hold: give it again")


@dataclass(frozen=True)
class FlowField(Flow):
    """A flow from functions of places (n, 3) [m], world, and time [s].

    Args:
        function: u (n, 3) [m/s].
        jacobian: du_i/dx_j (n, 3, 3) [1/s]; None: by central differences, in one call with 6 n places.
        rate: du/dt at fixed places (n, 3) [m/s^2]; None: by central differences, in two calls.
        name: in messages and files. A file holds the name alone.
        step: [m], of the differences in space; their error is proportional to its square.
        time_step: [s], of the differences in time.
        period: [s], shortest of u at a fixed place; it bounds the steps in time. None: not known.
        wave: [m], shortest wavelength of u; it bounds the distance of the nodes. None: not known.

    `ValueError`, with the place and the time, for a value that is not finite or has the wrong shape, and for a vertical
    velocity in a planar scene.
    """

    function: Field = field(repr=False)
    jacobian: Field | None = field(default=None, repr=False)
    rate: Field | None = field(default=None, repr=False)
    name: str = "of a function"
    step: float = 1e-4
    time_step: float = 1e-4
    period: float | None = None
    wave: float | None = None

    def __post_init__(self) -> None:
        checked_instance("flow name", self.name, str)
        for name, unit in (("step", "m"), ("time_step", "s"), ("period", "s"), ("wave", "m")):
            if (value := getattr(self, name)) is not None or "step" in name:
                checked = number(f"flow {name}", value, unit, minimum=0.0, exclusive=True)
                object.__setattr__(self, name, checked)
        for name in ("function", "jacobian", "rate"):
            if (given := getattr(self, name)) is not None and not callable(given):
                raise ValueError(f"flow {name} must be a function of places and time, got {shown(given)}")

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        def fill(time: float, view: memoryview) -> None:
            rows = np.asarray(view)
            x = rows[:, :3].copy()
            rows[:, 3:6] = velocity = self._called("function", x, time)
            rows[:, 6:9] = self._rate(x, time)
            rows[:, 9:ROWS] = self._jacobian(x, time).reshape(-1, 9)
            if planar and velocity[:, 2].any():
                index = np.flatnonzero(velocity[:, 2])[0]
                raise ValueError(
                    f"flow {shown(self.name)} must have no part along z in a planar scene, got "
                    f"{velocity[index, 2]:.3g} m/s {_where(x[index], time)}"
                )

        return [eel_core.FunctionFlow(fill)]

    @cached_property
    def traits(self) -> FlowTraits:
        return FlowTraits(time_scale=self.period or np.inf, shortest_wave=self.wave or np.inf)

    def velocity(self, places: np.ndarray, time: float) -> np.ndarray:
        """u (n, 3) [m/s] at `places` (n, 3) [m] and `time` [s]."""
        return self._called("function", places, time)

    def _rate(self, x: np.ndarray, time: float) -> np.ndarray:
        if self.rate is not None:
            return self._called("rate", x, time)
        before, after = (self._called("function", x, time + sign * self.time_step) for sign in (-1.0, 1.0))
        return np.asarray((after - before) / (2.0 * self.time_step))

    def _jacobian(self, x: np.ndarray, time: float) -> np.ndarray:
        if self.jacobian is not None:
            return self._called("jacobian", x, time, (3, 3))
        shifts = self.step * np.concatenate([np.eye(3), -np.eye(3)])
        moved = (x + shifts[:, None]).reshape(-1, 3)
        after, before = self._called("function", moved, time).reshape(2, 3, len(x), 3)
        return np.asarray(np.moveaxis(after - before, 0, -1) / (2.0 * self.step))

    def _called(self, what: str, x: np.ndarray, time: float, shape: tuple[int, ...] = (3,)) -> np.ndarray:
        function, wanted = getattr(self, what), (len(x), *shape)
        try:
            values = np.asarray(function(x, time), dtype=float)
        except (TypeError, ValueError) as error:
            if isinstance(function, LostFunction):
                raise
            raise ValueError(f"flow {shown(self.name)}: {what} failed {_where(x[0], time)}: {error}") from error
        if values.shape != wanted:
            raise ValueError(
                f"flow {shown(self.name)}: {what} must give shape {wanted}, got {values.shape} {_where(x[0], time)}"
            )
        bad = ~np.isfinite(values.reshape(len(x), -1)).all(axis=1)
        if bad.any():
            index = np.flatnonzero(bad)[0]
            raise ValueError(
                f"flow {shown(self.name)}: {what} must be finite, got {shown(values[index].tolist())} "
                f"{_where(x[index], time)}"
            )
        return values


def _where(place: np.ndarray, time: float) -> str:
    x, y, z = place
    return f"at ({x:.4g}, {y:.4g}, {z:.4g}) m and {time:.4g} s"
