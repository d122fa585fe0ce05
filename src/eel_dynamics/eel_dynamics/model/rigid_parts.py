# SPDX-License-Identifier: Apache-2.0
"""Mass, centre of mass and inertia of the parts of the straight body between places along it.

They are integrals of the section data, of the body without its water.
"""

from typing import NamedTuple

import numpy as np

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.body.moments import with_moments
from eel_dynamics.model.body.panels import panels_of
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.section_data import sections_of

RESOLUTION = 40  # points per length, as for the integrals of `Body`
SAME = 1e-9  # of the length: closer places count as one


class RigidPart(NamedTuple):
    """A part of the straight body, in the axes of its head (REP-103), from the nose."""

    mass: float  # kg
    centre: np.ndarray  # (3,) m
    inertia: np.ndarray  # (3, 3) kg m^2, about its centre of mass


def rigid_parts(body: Body, places: list[float], density: float | None = None) -> list[RigidPart]:
    """The parts between the nose, the `places` [m] in ascending order, and the tail of `body`.

    density: [kg/m^3] of a scene, instead of a homogeneous body's own.
    """
    ends = body.panel_ends
    cuts = np.array([min((end for end in ends if abs(end - x) < SAME * body.length), default=x) for x in places])
    grid = Grid.of(panels_of(body, resolution=RESOLUTION, edges=tuple(cuts.tolist())))
    bounds = np.array([0.0, *cuts, body.length])
    middles, scene = 0.5 * (bounds[1:] + bounds[:-1]), Scene(density=density, reactive=False)

    def fields(x: np.ndarray) -> np.ndarray:
        sections, along = sections_of(body, scene, x), x - middles[np.searchsorted(cuts, x)]
        mass, lever = sections.mass, sections.lever
        turning = sections.inertia1, sections.inertia2 + mass * along**2, sections.inertia3 + mass * along**2
        return np.array([mass, mass * along, lever, lever * along, *turning])

    values = with_moments(fields, grid, body.breaks) if len(body.breaks) else fields(grid.x)
    first = np.searchsorted(grid.x, bounds[:-1], side="right")
    sums = np.add.reduceat(values * grid.weight, first, axis=1)
    return [_part(middle, *column) for middle, column in zip(middles.tolist(), sums.T.tolist(), strict=True)]


def _part(
    middle: float, mass: float, ahead: float, lever: float, product: float, roll: float, pitch: float, yaw: float
) -> RigidPart:
    """A part from sums over its sections, about its `middle` [m]; levers are depths below the axis."""
    inertia = np.array([[roll, 0.0, -product], [0.0, pitch, 0.0], [-product, 0.0, yaw]])
    if not mass > 0.0:
        return RigidPart(0.0, np.array([-middle, 0.0, 0.0]), inertia)
    c = np.array([-ahead, 0.0, -lever]) / mass
    inertia -= mass * ((c @ c) * np.eye(3) - np.outer(c, c))
    return RigidPart(mass, c - [middle, 0.0, 0.0], inertia)
