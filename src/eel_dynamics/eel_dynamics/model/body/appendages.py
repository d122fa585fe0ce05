# SPDX-License-Identifier: Apache-2.0
"""Appendages of a body: bars, boxes, plates and cables as drag areas at places, and the base of a blunt tail.

An element is fixed to a section. With w = W(X) + Omega x (0, y, z), its velocity through the water in the section's
axes, its force is

    law "axis":  F_i = -1/2 rho_f drag_i |w_i| w_i     bars across the flow: each component by itself
    law "speed": F_i = -1/2 rho_f drag_i |w| w_i       blunt blocks

(eel_core/loads/appendages.hpp). It has only drag: its mass and volume belong to the body's mass per length, offset and
trim. Do not add one for a face that is a section's own (`lateral_drag` contains it), for a nose with `nose_drag`, or
for a base with `base_drag`. In a planar scene z counts as 0.
"""

from collections.abc import Iterable
from dataclasses import astuple, dataclass
from typing import Any, ClassVar

import numpy as np
from eel_common.quantity import Quantities, checked_instance, documented, quantity, required
from eel_common.wording import shown

from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.scene import Scene

LAWS = "axis", "speed"
MOST_APPENDAGES = 1000  # per body
APART = 1e-9  # of the body's length: closer places count as one


@documented
@dataclass(frozen=True)
class Appendage(Quantities):
    """A drag area fixed to a section. Immutable; `ValueError` names a bad field."""

    what: ClassVar[str] = "appendage"

    x: float = required("m", "X of its section, from the nose", 0.0)
    y: float = quantity(0.0, "m", "its offset along axis 2 of the section (to the right)")
    z: float = quantity(0.0, "m", "its offset along axis 3 of the section (upwards)")
    drag1: float = quantity(0.0, "m^2", "drag coefficient times area for flow along axis 1", 0.0)
    drag2: float = quantity(0.0, "m^2", "likewise along axis 2", 0.0)
    drag3: float = quantity(0.0, "m^2", "likewise along axis 3", 0.0)
    law: str = quantity("axis", "", "each component of the velocity by itself, or by the speed", choices=LAWS)

    @property
    def drag(self) -> tuple[float, float, float]:
        """Drag areas (3,) [m^2]."""
        return self.drag1, self.drag2, self.drag3


def checked_appendages(given: Any, length: float) -> tuple[Appendage, ...]:
    """The appendages of a body of `length` [m]. `ValueError` names one outside it, or with areas that cannot be m^2."""
    if given is None:
        return ()
    if isinstance(given, Appendage) or not isinstance(given, Iterable):
        raise ValueError(f"body appendages must be a list of Appendage, got {shown(given)}")
    found = tuple(checked_instance("body appendage", each, Appendage) for each in given)
    if len(found) > MOST_APPENDAGES:
        raise ValueError(f"body appendages must be at most {MOST_APPENDAGES}, got {len(found)}")
    for each in found:
        if each.x > length * (1.0 + APART):
            raise ValueError(f"appendage x must lie on the body, 0 to {length:g} m, got {each.x:g} m")
        if max(each.drag) > length**2:
            raise ValueError(
                f"appendage drag areas must be in m^2, below the square of the body's length {length**2:g} m^2, got "
                f"{max(each.drag):g} m^2 at X = {each.x:g} m"
            )
        if max(abs(each.y), abs(each.z)) > length:
            raise ValueError(
                f"appendage y and z must be in m, within the body's length {length:g} m, got {each.y:g} and {each.z:g}"
                f" m at X = {each.x:g} m"
            )
    return found


def core_appendages(body: Any, scene: Scene, grid: Grid, x: np.ndarray) -> list[Any]:
    """The appendages and the tail's base of `body` for the core. x (M,) [m]: stations."""
    if not scene.resistive:
        return []
    near, half_rho, rows = 10.0 * APART * body.length, 0.5 * scene.fluid_density, []

    def add(place: float, arm: tuple[float, float], areas: tuple[float, float, float], speed: bool, base: bool) -> None:
        if not any(areas):
            return
        y, z = arm[0], 0.0 if scene.planar else arm[1]
        drag = [half_rho * area for area in areas]
        node = None if place <= near else int(np.searchsorted(grid.x, place - near))
        station = len(x) if place >= body.length - near else int(np.searchsorted(x, place - near))
        rows.append((node, [0.0, y, z], drag, speed, base, station))

    for each in body.appendages:
        areas = tuple(body.appendage_factor * area for area in each.drag)
        add(each.x, (each.y, each.z), areas, each.law == "speed", False)
    end = np.array([body.length])
    base_area = float(np.pi * body.half_width(end)[0] * body.half_height(end)[0])
    add(body.length, (0.0, 0.0), (body.base_drag * base_area, 0.0, 0.0), False, True)
    return rows


def plain_appendages(appendages: Iterable[Appendage]) -> list[list[Any]]:
    """Appendages as rows of plain values, in the order of the fields."""
    return [list(astuple(each)) for each in appendages]
