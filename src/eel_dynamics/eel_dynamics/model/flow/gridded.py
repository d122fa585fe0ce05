# SPDX-License-Identifier: Apache-2.0
"""A flow measured or computed on a grid."""

import math
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from typing import Any

import numpy as np
from eel_common.quantity import checked_row, number, numbers
from eel_common.wording import shown
from numpy.typing import ArrayLike

import eel_core
from eel_dynamics.model.equality import EqualByFields
from eel_dynamics.model.flow.flow import Flow, FlowTraits
from eel_dynamics.model.flow.grid_files import AXES, read_grid

ALONE = (0.0,)  # the points of an axis along which the flow is constant
RESOLVED = 8.0  # grid points per shortest wave that the cubics resolve


@dataclass(frozen=True, eq=False)
class GriddedFlow(EqualByFields, Flow):
    """A flow on a grid, interpolated by Catmull-Rom cubics, with a continuous first derivative.

    Args:
        velocity: (T, X, Y, Z, 3) [m/s] at the points, of the given axes alone.
        time, x, y, z: points [s, m] of each axis, rising. Along an axis that is not given, or has one point, all is the
            same.
        period: [s], shortest period of u at a fixed place; it bounds the time steps. None: 8 intervals.
        wave: [m], shortest wavelength of u; it bounds the distance of the nodes. None: 8 cells.

    Nothing is extrapolated: a swimmer that leaves the grid stops, and the times must cover the run. `of` reads
    arrays of xarray and netCDF files. `ValueError` names the fault.
    """

    velocity: Any
    time: Any = ALONE
    x: Any = ALONE
    y: Any = ALONE
    z: Any = ALONE
    period: float | None = None
    wave: float | None = None

    def __post_init__(self) -> None:
        sizes, given = [], []
        for name in AXES:
            axis = checked_row(f"flow {name}", getattr(self, name), None)
            if not len(axis) or not (np.diff(axis) > 0.0).all():
                raise ValueError(f"flow {name} must rise, got {shown(axis.tolist())}")
            if getattr(self, name) is not ALONE:
                given.append(len(axis))
            sizes.append(len(axis))
            self._keep(name, axis)
        velocity = numbers("flow velocity", self.velocity)
        if velocity.shape not in ((*given, 3), (*sizes, 3)):
            raise ValueError(f"flow velocity must have shape {(*given, 3)}, got {velocity.shape}")
        velocity = velocity.reshape(*sizes, 3)
        if not np.isfinite(velocity).all():
            index = np.argwhere(~np.isfinite(velocity))[0]
            t, x, y, z = (float(getattr(self, name)[i]) for name, i in zip(AXES, index, strict=False))
            raise ValueError(
                f"flow velocity must be finite, got {velocity[tuple(index)]} at ({x:g}, {y:g}, {z:g}) m and {t:g} s"
            )
        self._keep("velocity", velocity)
        for name, unit in (("period", "s"), ("wave", "m")):
            if (value := getattr(self, name)) is not None:
                object.__setattr__(self, name, number(f"flow {name}", value, unit, minimum=0.0, exclusive=True))

    def _keep(self, name: str, array: np.ndarray) -> None:
        array = np.ascontiguousarray(array)
        array.setflags(write=False)
        object.__setattr__(self, name, array)

    @staticmethod
    def of(
        source: Any,
        velocity: tuple[str, str, str | None] = ("u", "v", "w"),
        period: float | None = None,
        wave: float | None = None,
    ) -> "GriddedFlow":
        """The flow of an `xarray.Dataset`, or of the netCDF file at a path.

        velocity: names of the variables [m/s] along x, y and z; the last may be absent. Their dimensions are some of
        time, x, y and z. Times are seconds; those of a calendar count from the first.
        """
        rows, axes = read_grid(source, velocity)
        return GriddedFlow(rows, **axes, period=period, wave=wave)

    def __hash__(self) -> int:  # type: ignore[override]  # the base has none
        return self._hash

    @cached_property
    def _hash(self) -> int:
        digest = sha256(self.velocity)
        for name in AXES:
            digest.update(getattr(self, name))
        return hash((digest.digest(), self.period, self.wave))

    def __repr__(self) -> str:
        spans = [f"{name} {getattr(self, name)[0]:g} to {getattr(self, name)[-1]:g}" for name in AXES]
        return f"GriddedFlow({self.velocity.shape[:4]} points, {', '.join(spans)})"

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        return [eel_core.GriddedFlow(tuple(getattr(self, name) for name in AXES), self.velocity)]

    @cached_property
    def traits(self) -> FlowTraits:
        time = (self.time[0], self.time[-1]) if len(self.time) > 1 else ()
        period = self.period or RESOLVED * _finest(self.time)
        wave = self.wave or RESOLVED * min(map(_finest, (self.x, self.y, self.z)))
        return FlowTraits(time, period, wave, span=time or FlowTraits().span)

    @property
    def in_plane(self) -> bool:
        return not self.velocity[..., 2].any() and bool((self.velocity == self.velocity[:, :, :, :1]).all())

    def outside(self, time: float, place: ArrayLike) -> tuple[str, float] | None:
        for name, value in zip(AXES, (time, *np.asarray(place).tolist()), strict=True):
            axis, unit = getattr(self, name), "s" if name == "time" else "m"
            if len(axis) > 1 and not axis[0] <= value <= axis[-1]:
                return f"{name} {axis[0]:g} to {axis[-1]:g} {unit}", value
        return None


def _finest(axis: np.ndarray) -> float:
    return float(np.diff(axis).min()) if len(axis) > 1 else math.inf
