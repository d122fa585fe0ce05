# SPDX-License-Identifier: Apache-2.0
"""The built-in flows. `eel_core` evaluates them without Python."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from eel_common.quantity import Quantities, checked_row, documented, numbers, quantity
from eel_common.wording import shown

import eel_core
from eel_dynamics.model.flow.flow import Flow, FlowTraits

GRAVITY = 9.80665  # m/s^2, standard
TURN = 2.0 * math.pi
FEW_ROWS = 4.0  # intervals of a velocity table per period
FASTEST_SWIRL = 0.6382  # greatest speed of a Lamb-Oseen vortex / (Gamma / (2 pi r_c))


@dataclass(frozen=True)
class Uniform(Flow):
    """A flow uniform in space: constant `velocity` (3,) [m/s], or rows (n, 3) at `time` (n,) [s].

    Between rows the velocity is a cubic spline, with zero acceleration at both ends; it is constant before and
    after them. `ValueError` names a bad argument. The exact shift of frame of `Scene.current` costs less.
    """

    vectors = ("velocity",)

    velocity: tuple[Any, ...]
    time: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        if self.time is None:
            object.__setattr__(self, "velocity", tuple(checked_row("flow velocity", self.velocity, 3).tolist()))
            return
        time, rows = checked_row("flow time", self.time, None), numbers("flow velocity", self.velocity)
        if len(time) < 2 or not (np.diff(time) > 0.0).all():
            raise ValueError(f"flow time must be two instants or more that rise, got {shown(time.tolist())}")
        if rows.shape != (len(time), 3) or not np.isfinite(rows).all():
            raise ValueError(f"flow velocity must be finite, of shape {(len(time), 3)}, got {shown(rows.shape)}")
        object.__setattr__(self, "time", tuple(time.tolist()))
        object.__setattr__(self, "velocity", tuple(map(tuple, rows.tolist())))

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        if self.time is None:
            return [eel_core.RampedFlow(np.array(self.velocity), [])]
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(self.time, self.velocity, bc_type="clamped")
        coefficients = np.ascontiguousarray(spline.c[::-1].transpose(1, 0, 2))  # from the constant one on
        return [eel_core.SplineFlow(np.array(self.time), coefficients)]

    @cached_property
    def traits(self) -> FlowTraits:
        if self.time is None:
            return FlowTraits()
        return FlowTraits((self.time[0], self.time[-1]), FEW_ROWS * float(np.diff(self.time).min()))


@documented
@dataclass(frozen=True, kw_only=True)
class Gust(Flow, Quantities):
    """A gust uniform in space. It rises and falls by the smooth ramp f_r of eq. (64)."""

    vectors = ("velocity",)

    velocity: tuple[float, float, float] = quantity((0.1, 0.0, 0.0), "m/s", "of the water at its height")
    start: float = quantity(0.0, "s", "time at which it begins")
    rise: float = quantity(1.0, "s", "duration of the rise", 0.0, exclusive=True)
    hold: float = quantity(1.0, "s", "duration at full strength", 0.0)
    fall: float = quantity(1.0, "s", "duration of the fall", 0.0, exclusive=True)

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        start, risen, falls, end = self.traits.breakpoints
        return [eel_core.RampedFlow(np.array(self.velocity), [(start, risen, 1.0), (falls, end, -1.0)])]

    @cached_property
    def traits(self) -> FlowTraits:
        risen = self.start + self.rise
        return FlowTraits((self.start, risen, risen + self.hold, risen + self.hold + self.fall))


@documented
@dataclass(frozen=True, kw_only=True)
class Shear(Flow, Quantities):
    """A shear layer: u = velocity tanh(d / width), d the distance from its middle plane; or u = velocity d / width.

    The theory assumes irrotational flow: see the limits in docs/howto/flow.md.
    """

    vectors = "velocity", "across"

    velocity: tuple[float, float, float] = quantity((0.1, 0.0, 0.0), "m/s", "of the water far to one side")
    across: tuple[float, float, float] = quantity((0.0, 1.0, 0.0), "", "direction in which the velocity changes")
    centre: tuple[float, float, float] = quantity((0.0, 0.0, 0.0), "m", "a point of the middle plane")
    width: float = quantity(0.5, "m", "scale of the change", 0.0, exclusive=True)
    profile: str = quantity("tanh", "", "of the velocity over the distance", choices=("tanh", "linear"))

    def __post_init__(self) -> None:
        super().__post_init__()
        if abs(_unit("flow across", self.across) @ self.velocity) > 1e-9 * math.hypot(*self.velocity):
            raise ValueError(f"flow across must be normal to the velocity {self.velocity}, got {shown(self.across)}")

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        across, linear = _unit("flow across", self.across), self.profile == "linear"
        return [eel_core.ShearFlow(np.array(self.velocity), across, float(across @ self.centre), self.width, linear)]

    @cached_property
    def traits(self) -> FlowTraits:
        wave, speed = TURN * self.width, math.hypot(*self.velocity)
        return FlowTraits((), wave / speed if speed else np.inf, np.inf if self.profile == "linear" else wave)


class _Vortices(Flow):
    """Base of vortices about vertical axes, with fields `circulation`, `core`, `drift`."""

    vectors = ("drift",)

    circulation: float
    core: float
    drift: tuple[float, float, float]

    @cached_property
    def traits(self) -> FlowTraits:
        wave = TURN * self.core
        speed = FASTEST_SWIRL * abs(self.circulation) / wave + math.hypot(*self.drift)
        return FlowTraits((), wave / speed if speed else np.inf, wave)


@documented
@dataclass(frozen=True, kw_only=True)
class Vortex(_Vortices, Quantities):
    """A Lamb-Oseen vortex about a vertical axis: u = Gamma / (2 pi r^2) (1 - exp(-r^2 / r_c^2)) (-y, x, 0)."""

    circulation: float = quantity(0.1, "m^2/s", "Gamma; > 0 turns from x to y")
    core: float = quantity(0.2, "m", "radius r_c of the core", 0.0, exclusive=True)
    centre: tuple[float, float, float] = quantity((0.0, 0.0, 0.0), "m", "a point of its axis at t = 0")
    drift: tuple[float, float, float] = quantity((0.0, 0.0, 0.0), "m/s", "velocity of its axis")

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        x, y, _ = self.centre
        return [eel_core.VortexFlow(np.array([x, y, self.circulation]), self.core, np.array(self.drift))]


@documented
@dataclass(frozen=True, kw_only=True)
class VortexStreet(_Vortices, Quantities):
    """Two rows of vortices, staggered as behind a cylinder (von Karman); each is like a `Vortex`.

    Vortex number i of each row lies i `spacing` downstream of `start`; the right row lies half a spacing further. With
    circulation > 0 the left row turns from y to x, like the wake of a towed body; with < 0, of a swimming one.
    The vortices drift at `drift`; they do not move each other.
    """

    circulation: float = quantity(0.1, "m^2/s", "size of Gamma of each vortex")
    core: float = quantity(0.1, "m", "radius r_c of the cores", 0.0, exclusive=True)
    spacing: float = quantity(1.0, "m", "between neighbours of a row", 0.0, exclusive=True)
    width: float = quantity(0.28, "m", "between the rows", 0.0)
    count: int = quantity(17, "", "vortices of each row", 1, 10_000, whole=True)
    start: tuple[float, float, float] = quantity((0.0, 0.0, 0.0), "m", "point between the rows; the left begins there")
    downstream: tuple[float, float] = quantity((1.0, 0.0), "", "horizontal direction along the rows")
    drift: tuple[float, float, float] = quantity((0.0, 0.0, 0.0), "m/s", "velocity of all vortices")

    def __post_init__(self) -> None:
        super().__post_init__()
        _unit("flow downstream", self.downstream)

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        along = _unit("flow downstream", self.downstream)
        left = np.array([-along[1], along[0]])
        far = self.spacing * np.arange(self.count)[:, None] * along + self.start[:2]
        rows = far + 0.5 * self.width * left, far + 0.5 * self.spacing * along - 0.5 * self.width * left
        strength = np.repeat([-self.circulation, self.circulation], self.count)
        vortices = np.ascontiguousarray(np.column_stack([np.concatenate(rows), strength]))
        return [eel_core.VortexFlow(vortices, self.core, np.array(self.drift))]


@documented
@dataclass(frozen=True, kw_only=True)
class Wave(Flow, Quantities):
    """An Airy wave on deep water. At depth d the water moves on circles of radius amplitude exp(-k d).

    u = amplitude w exp(k (z - surface)) (cos p along the direction, sin p upwards), p = k s - w t + phase, w^2 = g k,
    s the distance along the direction.
    """

    in_plane = False

    amplitude: float = quantity(0.1, "m", "of the surface", 0.0)
    wavelength: float = quantity(5.0, "m", "2 pi / k", 0.0, exclusive=True)
    direction: tuple[float, float] = quantity((1.0, 0.0), "", "horizontal direction of propagation")
    surface: float = quantity(1.0, "m", "height z of the surface at rest, above the swimmer")
    phase: float = quantity(0.0, "rad", "p at t = 0 and s = 0")

    def __post_init__(self) -> None:
        super().__post_init__()
        _unit("flow direction", self.direction)

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        direction = np.append(_unit("flow direction", self.direction), 0.0)
        wavenumber = TURN / self.wavelength
        frequency = TURN / self.traits.time_scale
        return [eel_core.WaveFlow(self.amplitude, wavenumber, frequency, self.surface, self.phase, direction)]

    @cached_property
    def traits(self) -> FlowTraits:
        return FlowTraits((), math.sqrt(TURN * self.wavelength / GRAVITY), self.wavelength, self.surface)


def _unit(name: str, direction: tuple[float, ...]) -> np.ndarray:
    length = math.hypot(*direction)
    if not length > 0.0:
        raise ValueError(f"{name} must have a direction, got {shown(direction)}")
    return np.array(direction) / length
