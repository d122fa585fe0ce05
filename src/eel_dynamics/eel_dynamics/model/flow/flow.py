# SPDX-License-Identifier: Apache-2.0
"""The interface of all flows: the velocity u(x, t) of the undisturbed water, its Jacobian and its rate.

Places and velocities are in the axes of the world (REP-103). The scene's current is not part of u: the water's velocity
is the sum of both. Flows add by `+`.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import chain
from typing import Any, ClassVar, NamedTuple

import numpy as np
from eel_common.quantity import checked_instance, is_finite, numbers
from eel_common.wording import shown
from numpy.typing import ArrayLike

import eel_core

ROWS = 18  # numbers of a place in eel_core: x, u, u_t, and the Jacobian row by row
SPACINGS = 6.0  # spacings of the lattice per body length
REACH = np.array([8, 6, 3])  # spacings of the lattice to each side, along x, y and z


class FlowSample(NamedTuple):
    """The water at n places."""

    velocity: np.ndarray  # (n, 3) m/s, u
    rate: np.ndarray  # (n, 3) m/s^2, du/dt at the fixed place
    jacobian: np.ndarray  # (n, 3, 3) 1/s, du_i/dx_j


class FlowTraits(NamedTuple):
    """Properties of a flow that grid and steps depend on."""

    breakpoints: tuple[float, ...] = ()  # s, at which a time derivative of u jumps
    time_scale: float = np.inf  # s, shortest period at a fixed place; infinite for a steady flow
    shortest_wave: float = np.inf  # m, shortest wavelength of u; infinite for a uniform flow
    surface_height: float = np.inf  # m, z of the water's surface; infinite without one
    span: tuple[float, float] = -np.inf, np.inf  # s, first and last time at which it is known


class Flow:
    """A flow of the water. It never changes; two are equal if their fields are.

    vectors: names of the fields that lie in the plane if u does.
    """

    what: ClassVar[str] = "flow"
    vectors: ClassVar[tuple[str, ...]] = ()

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        """Its sources for `eel_core.Flow`. planar: for a planar scene."""
        raise NotImplementedError

    @cached_property
    def traits(self) -> FlowTraits:
        """Its scales in space and time."""
        return FlowTraits()

    @property
    def in_plane(self) -> bool:
        """Whether u has no component along z and does not depend on z, as a planar scene requires."""
        return not any(np.atleast_2d(getattr(self, name))[:, 2].any() for name in self.vectors)

    def outside(self, time: float, place: ArrayLike) -> tuple[str, float] | None:
        """If u is unknown at a `place` (3,) [m]: the axis and its bounds in words, and the place along it."""
        return None

    def sample(self, places: ArrayLike, time: float = 0.0) -> FlowSample:
        """The water at `places` (n, 3) [m], or at one (3,), at `time` [s]."""
        x = numbers("places", places)
        if x.shape[-1:] != (3,) or not np.isfinite(x).all():
            raise ValueError(f"places must be finite, of shape (n, 3), got {shown(x.shape)}")
        if not is_finite(time):
            raise ValueError(f"time must be finite, got {shown(time)} s")
        rows = self.rows_at(x, float(time))
        for place in rows[np.isnan(rows[..., 3]), :3]:
            if found := self.outside(time, place):
                raise ValueError(f"places must lie in the grid of the flow, {found[0]}, got {shown(place.tolist())}")
        return FlowSample(rows[..., 3:6], rows[..., 6:9], rows[..., 9:].reshape(*x.shape, 3))

    def rows_at(self, places: np.ndarray, time: float) -> np.ndarray:
        """(..., 18): place, velocity, rate and Jacobian, at `places` (..., 3) [m]; NaN where unknown."""
        rows = np.zeros((*places.shape[:-1], ROWS))
        rows[..., :3] = places
        core_flow(self, False).at(time, rows)
        return rows

    def __add__(self, other: "Flow") -> "Flow":
        if not isinstance(other, Flow):
            return NotImplemented
        return FlowSum((*parts_of(self), *parts_of(other)))


@dataclass(frozen=True)
class FlowSum(Flow):
    """The sum of several flows."""

    parts: tuple[Flow, ...]

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        return [source for part in self.parts for source in part.sources(planar)]

    @cached_property
    def traits(self) -> FlowTraits:
        times, periods, waves, heights, spans = zip(*(part.traits for part in self.parts), strict=True)
        starts, ends = zip(*spans, strict=True)
        breakpoints = tuple(sorted(set(chain(*times))))
        return FlowTraits(breakpoints, min(periods), min(waves), min(heights), (max(starts), min(ends)))

    @property
    def in_plane(self) -> bool:
        return all(part.in_plane for part in self.parts)

    def outside(self, time: float, place: ArrayLike) -> tuple[str, float] | None:
        return next(filter(None, (part.outside(time, place) for part in self.parts)), None)


def parts_of(flow: Flow) -> tuple[Flow, ...]:
    """The flows whose sum is `flow`."""
    return flow.parts if isinstance(flow, FlowSum) else (flow,)


@lru_cache(maxsize=64)
def core_flow(flow: Flow, planar: bool) -> eel_core.Flow:
    """`flow` for the core. planar: for a planar scene."""
    return eel_core.Flow(flow.sources(planar))


def checked_flow(flow: Any, planar: bool) -> Flow | None:
    """`flow`, if it is a flow or None. `ValueError` for one that a planar scene does not allow."""
    if flow is None:
        return None
    given: Flow = checked_instance("flow", flow, Flow)
    for part in parts_of(given):
        if planar and not part.in_plane:
            raise ValueError(f"flow must stay in the plane z = 0 of a planar scene, and be alike along z, got {part!r}")
    return given


def check_covers(flow: Flow | None, duration: float) -> None:
    """`ValueError` unless `flow` is known from 0 to `duration` [s]."""
    start, end = FlowTraits().span if flow is None else flow.traits.span
    if not start <= 0.0 <= duration <= end:
        raise ValueError(f"flow time must cover the run, 0 to {duration:g} s, got {start:g} to {end:g} s")


def lattice_around(place: np.ndarray, length: float, flow: Flow) -> np.ndarray:
    """Points (n, 3) [m] for showing a flow around a `place` (3,) [m] of a body of this `length` [m].

    They are multiples of a spacing, so they are fixed in the world. They lie in a horizontal sheet at the place's
    height. If the flow changes with height, an upright sheet along x crosses it. Their number depends only on the
    flow.
    """
    spacing = length / SPACINGS
    middle = np.round(np.asarray(place) / spacing)
    x, y, z = (np.arange(-reach, reach + 1) for reach in REACH)
    level = np.stack(np.meshgrid(x, y, [0], indexing="ij"), axis=-1).reshape(-1, 3)
    upright = np.stack(np.meshgrid(x, [0], z[z != 0], indexing="ij"), axis=-1).reshape(-1, 3)
    return np.asarray(spacing * (middle + (level if flow.in_plane else np.concatenate([level, upright]))))


def velocities_at(flow: Flow, points: np.ndarray, time: float) -> np.ndarray:
    """Velocities (n, 3) [m/s] at the `points` at `time` [s]; 0 where unknown."""
    return np.asarray(np.nan_to_num(flow.rows_at(points, time)[..., 3:6], nan=0.0))
