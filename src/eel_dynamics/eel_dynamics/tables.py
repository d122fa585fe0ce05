"""What a run has of its body, its scene and its stations, tabulated once for all runs of the same."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

import eel_core

from .body import Body
from .inertia import check_inertia
from .quadrature import Grid
from .scene import Scene
from .sections import SectionTable, core_swimmer, nose_of, panels_of, sections_of
from .tabulated_law import Tabulation


class Built(NamedTuple):
    """What a grid is built for: points per body length, kinks of the drag that are looked for, knots [m] of a law."""

    resolution: float
    kinks: str
    knots: tuple[float, ...]


class Table(NamedTuple):
    """A body in a scene on a grid; the same for every run of the same."""

    grid: Grid
    sections: SectionTable  # at the nodes
    core: eel_core.Swimmer  # all of it, for the compiled mechanics
    mass: float  # kg, of the body
    tabulation: Tabulation


@lru_cache(maxsize=256)
def tabulated(body: Body, scene: Scene, built: Built, stations: bytes) -> Table:
    """Tabulate `body` in `scene` on the grid that is to be `built`, and at the X of the `stations` (the bytes of their
    array)."""
    x = np.frombuffer(stations)
    grid = Grid.of(panels_of(body, built.resolution, built.knots, scene.internal_wrench or scene.ledger))
    sections = sections_of(body, scene, grid.x)
    check_inertia(grid, sections, nose_of(body, scene)[0], body.length, scene.planar)
    nodes_before = np.searchsorted(grid.x, x, side="right")
    base = np.where(nodes_before > 0, grid.x[nodes_before - 1], 0.0)
    core = core_swimmer(body, scene, grid, sections, x, built.kinks)
    tabulation = Tabulation(grid.x, grid.previous, x, base)
    return Table(grid, sections, core, float(grid.weight @ sections.mass), tabulation)
