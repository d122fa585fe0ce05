# SPDX-License-Identifier: Apache-2.0
"""A body in a scene on a grid: its section data at the nodes and the stations. Equal runs share it."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

import eel_core
from eel_dynamics.accuracy.grid_settings import GridSettings
from eel_dynamics.curvature.tabulated_law import Tabulation
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.grid import Grid, Panel
from eel_dynamics.model.body.panels import panels_of
from eel_dynamics.model.fins.fins import Fin
from eel_dynamics.model.inertia import check_inertia
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.section_data import (
    SectionData,
    check_weight,
    core_swimmer,
    nose_of,
    sections_on,
    weight_time,
    with_sensors,
)
from eel_dynamics.simulation.swimmer import Swimmer


class Discretisation(NamedTuple):
    """A body in a scene on a grid. It never changes."""

    grid: Grid
    sections: SectionData  # at the nodes
    swimmer: eel_core.Swimmer  # the whole, for the core
    mass: float  # kg, of the body
    weight_time: float  # s
    tabulation: Tabulation


def discretise(swimmer: Swimmer, settings: GridSettings) -> Discretisation:
    """Tabulate the body in its scene on a grid of these `settings`, and at the stations.

    `ValueError` for a body without inertia in some direction.
    """
    body, scene = swimmer.body, swimmer.scene
    wrench = scene.internal_wrench or scene.ledger
    panels = panels_of(body, settings.resolution, settings.knots, wrench, settings.edges)
    further = b"" if swimmer.modes is None else swimmer.modes.points.tobytes()
    return _on_panels(body, scene, panels, settings.kinks, swimmer.x.tobytes(), further, swimmer.fins, swimmer.sensors)


@lru_cache(maxsize=256)
def _on_panels(
    body: Body,
    scene: Scene,
    panels: tuple[Panel, ...],
    kinks: str,
    stations: bytes,
    further: bytes,
    fins: tuple[Fin, ...],
    sensors: tuple[float, ...],
) -> Discretisation:
    """Many resolutions give the same `panels`: nodes fill blocks of eight.

    stations, further: X [m], as bytes of arrays; laws are tabulated at `further` too.
    sensors: rising X [m].
    """
    x, grid = np.frombuffer(stations), Grid.of(panels)
    sections = sections_on(body, scene, grid)
    check_inertia(grid, sections, nose_of(body, scene)[0], body.length, scene.planar, body.offset)
    check_weight(body, scene, sections, grid.weight)
    swimmer = core_swimmer(body, scene, grid, sections, x, kinks, fins, np.array(sensors))
    x = with_sensors(x, np.array(sensors))
    nodes_before = np.searchsorted(grid.x, x, side="right")
    base = np.where(nodes_before > 0, grid.x[nodes_before - 1], 0.0)
    tabulation = Tabulation(grid.x, grid.previous, x, base, np.frombuffer(further))
    mass, time = float(grid.weight @ sections.mass), weight_time(scene, sections, grid.weight, body.length)
    return Discretisation(grid, sections, swimmer, mass, time, tabulation)
