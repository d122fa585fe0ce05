# SPDX-License-Identifier: Apache-2.0
"""Weight, buoyancy and trim of a straight body, and the ballast that makes it float level.

Weight acts at the centre of mass, buoyancy at the centre of volume. A body floats if both are equal, and comes to rest
with one below the other: `trim_of`. One piece of ballast has two unknowns, its mass and its place along the body, for
two conditions, no net weight and no moment: `ballast_for`.
"""

from dataclasses import dataclass, replace

import numpy as np
from eel_common.quantity import number, positive
from eel_common.wording import shown

from eel_dynamics.model.body.body import Body, checked_body
from eel_dynamics.model.scene import Scene, checked_scene
from eel_dynamics.model.section_data import GRAVITY, NEUTRAL

LEVEL = 1e-9  # of the length: a smaller distance of the centres of mass and buoyancy counts as none
PART = 0.1  # of the length: default length of a piece of ballast


@dataclass(frozen=True)
class Trim:
    """The attitude of a straight body in the water."""

    mass: float  #: kg
    displaced: float  #: kg, of the displaced water
    centre_of_mass: float  #: X [m], from the nose
    centre_of_buoyancy: float  #: X [m]
    offset: float  #: m, depth of the centre of mass below the axis; negative: above it

    @property
    def net_weight(self) -> float:
        """Weight minus buoyancy [N]; a body with more than 0 sinks."""
        return GRAVITY * (self.mass - self.displaced)

    @property
    def pitch(self) -> float:
        """Pitch [rad] at rest, nose up: the centre of mass hangs below that of buoyancy. pi / 2 if only the nose can
        rise; 0 for a body that rests at any angle."""
        behind = self.centre_of_mass - self.centre_of_buoyancy
        level = abs(behind) < LEVEL * self.centre_of_buoyancy
        return 0.0 if level else float(np.arctan2(behind, self.offset))

    def about(self) -> str:
        """One line with the figures."""
        behind, net, moves = 1e3 * (self.centre_of_mass - self.centre_of_buoyancy), self.net_weight, "floats"
        if abs(self.mass - self.displaced) > NEUTRAL * self.mass:
            moves = f"{'sinks' if net > 0.0 else 'rises'} by {abs(net):.4g} N"
        where = f"{abs(behind):.3g} mm {'behind' if behind > 0.0 else 'ahead of'}"
        if abs(behind) < 1e3 * LEVEL * self.centre_of_buoyancy:
            where = "level with"
        return (
            f"{moves}; centre of mass {where} that of buoyancy and {1e3 * self.offset:.3g} mm below it, rests nose up "
            f"by {np.degrees(self.pitch):.3g} deg"
        )


@dataclass(frozen=True)
class Lump:
    """m(X) of a body with a piece of ballast around a station. The ballast is thinner towards its ends."""

    base: Body
    density: float | None  # kg/m^3, of a scene
    mass: float  # kg
    station: float  # m
    length: float  # m

    def alone(self, x) -> np.ndarray:
        """Mass per length [kg/m] of the ballast at `x` [m]: a parabola's square, 0 beyond its ends."""
        u = 2.0 * (np.asarray(x, dtype=float) - self.station) / self.length
        return 1.875 * self.mass / self.length * np.maximum(1.0 - u**2, 0.0) ** 2

    def __call__(self, x) -> np.ndarray:
        """[kg/m] at `x` [m]."""
        return self.base.mass_per_length(x, self.density) + self.alone(x)


@dataclass(frozen=True)
class Hung:
    """h(X) of a body with a piece of ballast `offset` [m] below the axis."""

    lump: Lump
    offset: float

    def __call__(self, x) -> np.ndarray:
        """[m] at `x` [m]."""
        own, added = self.lump.base.mass_per_length(x, self.lump.density), self.lump.alone(x)
        moment = own * self.lump.base.centre_of_mass_offset(x) + added * self.offset
        return np.divide(moment, own + added, out=np.zeros_like(moment), where=own + added > 0.0)


@dataclass(frozen=True)
class Ballast:
    """A piece of ballast, and the body with it."""

    mass: float  #: kg
    station: float  #: X [m] of its middle
    length: float  #: m along the body
    offset: float  #: m below the axis
    body: Body  #: including the ballast
    trim: Trim  #: of that body


def trim_of(body: Body | None = None, scene: Scene | None = None) -> Trim:
    """Weight, buoyancy and trim of a straight `body` in the water of `scene`. `ValueError` names a bad argument."""
    body, scene = checked_body(body), checked_scene(scene)

    def fields(x: np.ndarray) -> np.ndarray:
        mass, area = body.mass_per_length(x, scene.density), np.pi * body.half_width(x) * body.half_height(x)
        return np.array([mass, mass * x, mass * body.centre_of_mass_offset(x), area, area * x])

    mass, along, below, volume, along_volume = body.integral(fields)
    return Trim(mass, scene.fluid_density * volume, along / mass, along_volume / volume, below / mass)


def ballast_for(
    body: Body | None = None, scene: Scene | None = None, *, length: float | None = None, offset: float = 0.0
) -> Ballast:
    """The ballast with which `body` floats level in the water of `scene`.

    length: [m], of the ballast along the body, by default a tenth of the body's. offset: [m], depth of the ballast
    below the axis. `ValueError` if the body is too heavy without it, and if the ballast does not fit into it.
    """
    body, scene = checked_body(body), checked_scene(scene)
    length = positive("ballast length", PART * body.length if length is None else length, "m")
    offset, trim = number("ballast offset", offset, "m"), trim_of(body, scene)
    mass = trim.displaced - trim.mass
    if mass <= NEUTRAL * trim.mass:
        raise ValueError(f"body must be lighter than its water to take ballast, got {trim.about()}")
    station = (trim.displaced * trim.centre_of_buoyancy - trim.mass * trim.centre_of_mass) / mass
    if not 0.5 * length < station < body.length - 0.5 * length:
        raise ValueError(
            f"ballast must fit between X = 0 and {body.length:g} m, got {mass:.4g} kg, {length:g} m long, around X = "
            f"{station:.4g} m: move the body's own mass, or give a shorter length"
        )
    height = float(body.half_height(station))
    if abs(offset) > height:
        raise ValueError(f"ballast offset must lie within the section, {height:.4g} m high, got {shown(offset)} m")
    lump = Lump(body, scene.density, mass, station, length)
    ends = {station - 0.5 * length, station + 0.5 * length}
    heavier = body.changed(
        mass_per_length=lump,
        centre_of_mass_offset=Hung(lump, offset) if offset or body.offset else 0.0,
        kinks=tuple(sorted({*body.kinks, *ends})),
        nose=body.nose,
    )
    return Ballast(mass, station, length, offset, heavier, trim_of(heavier, replace(scene, density=None)))
