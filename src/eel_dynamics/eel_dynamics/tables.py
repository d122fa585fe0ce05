"""What a run has of its body, its scene and its stations, tabulated once for all runs of the same."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .body import Body
from .drive import Tabulation
from .inertia import check_inertia
from .packed import Packed
from .quadrature import Grid
from .scene import Scene
from .sections import STATIONS, SWIMMER, panels_of, stations_of, swimmer_of


class Built(NamedTuple):
    """What a grid is built for: points per body length, kinks of the drag that are looked for, knots [m] of a law."""

    resolution: float
    kinks: str
    knots: tuple[float, ...]


class Table(NamedTuple):
    """A body in a scene on a grid; the same for every run of the same."""

    grid: Grid
    swimmer: Packed
    stations: Packed
    mass: float  # kg, of the body
    tabulation: Tabulation


@lru_cache(maxsize=256)
def tabulated(body: Body, scene: Scene, built: Built, stations: bytes) -> Table:
    """Tabulate `body` in `scene` on the grid that is to be `built`, and at the X of the `stations` (the bytes of their
    array)."""
    x = np.frombuffer(stations).copy()  # that can be written to, as elsewhere: the loops are compiled for such
    grid = Grid.of(panels_of(body, built.resolution, built.knots, scene.internal_wrench or scene.ledger))
    here = stations_of(body, scene, grid, x)
    base = np.where(here.node >= 0, grid.x[here.node], 0.0)
    swimmer = swimmer_of(body, scene, grid, built.kinks)
    check_inertia(swimmer, body.length, scene.planar)
    mass = float(swimmer.weight @ swimmer.mass)
    tabulation = Tabulation(grid.x, grid.previous, x, base)
    return Table(grid, SWIMMER.packed(swimmer), STATIONS.packed(here), mass, tabulation)
