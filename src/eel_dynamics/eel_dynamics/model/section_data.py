# SPDX-License-Identifier: Apache-2.0
"""Section data of the body and the water at the nodes and the stations (sections 3.3, 4.2 and 7.2.1 of the paper).

The half-axis a lies along E3, b along E2.

Body: m_b = rho_b pi a b, J2 = rho_b pi a^3 b/4, J3 = rho_b pi a b^3/4, J1 = J2 + J3.
Water: J_f1 = rho_f pi/8 (a^2 - b^2)^2, M_f = rho_f pi diag(0, a^2, b^2), times the factors of separated flow.

The printed eq. (37) exchanges the half-axes a and b in M_f. This is corrected here: the added mass of an ellipse that
moves along one axis is proportional to the square of the other half-axis (Lamb; section 4.3 of the paper). The scene's
`added_mass="printed"` keeps the printed form.

The drag coefficients of the rows `drag2` to `turbulent` become loads in `resistive_load`, eel_core/loads/drag.hpp.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

import eel_core
from eel_dynamics.model.body.appendages import core_appendages
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.grid import Grid, PanelPoints
from eel_dynamics.model.body.moments import missed_before, missed_within, with_moments
from eel_dynamics.model.fins.fins import Fin, core_fins
from eel_dynamics.model.scene import Scene

WATCHED = {"all": 1, "jumps": 4, "none": 5}  # first of the speeds (V1, V2, V3, Omega1, Re/8e4 - 1) whose changes of
# sign within a panel are integrated exactly
GRAVITY = 9.80665  # m/s^2, standard
NEUTRAL = 1e-9  # of the mass: a greater difference from the displaced water is a net weight
LEAST = 1e-9  # of the greatest drag per length: lower bound of the drag at a node
PLACES = 8  # per node of the largest panel: places at which integrals up to a kink are tabulated
TAYLOR = 5.4  # coefficient of the friction along a cylinder in oblique flow: eel_core/model/friction.hpp
CRITICAL_REYNOLDS = 8.0e4  # Reynolds number at which the printed friction law jumps from laminar to turbulent


def swept_water(body: Body, scene: Scene, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Added masses (n,) of the sections at `x` (n,) [m]: M_f along E2 and E3 [kg/m], and J_f1 [kg m] (eq. 37).

    They are those of the water swept past the sections, and zero if the scene is not reactive.
    """
    rho = scene.fluid_density if scene.reactive else 0.0
    a_squared, b_squared = body.half_height(x) ** 2, body.half_width(x) ** 2
    along2, along3 = (a_squared, b_squared) if scene.added_mass == "corrected" else (b_squared, a_squared)
    factor2, factor3 = body.added_mass_factors(x)
    roll = rho * np.pi / 8.0 * (a_squared - b_squared) ** 2
    return rho * np.pi * along2 * factor2, rho * np.pi * along3 * factor3, roll


class SectionData(NamedTuple):
    """Section data at n points, (n,) each, SI units."""

    mass: np.ndarray  # kg/m, of the body
    added2: np.ndarray  # kg/m, added mass along E2
    added3: np.ndarray  # kg/m, along E3
    lever: np.ndarray  # kg, m h of the weight, at the depth h below the axis
    net: np.ndarray  # kg/m, mass of displaced water minus body, if bodies have weight
    inertia1: np.ndarray  # kg m, of body and water about E1
    inertia2: np.ndarray  # kg m, about E2
    inertia3: np.ndarray  # kg m, about E3
    added_roll: np.ndarray  # kg m, of the water about E1
    displaced: np.ndarray  # kg/m, of the water that the section displaces
    drag2: np.ndarray  # kg/m^2, 1/2 rho_f k2
    drag3: np.ndarray  # kg/m^2, 1/2 rho_f k3
    drag_roll: np.ndarray  # kg, 1/2 rho_f k4
    laminar: np.ndarray  # friction force per length = -laminar |V1|^(1/2) V1
    turbulent: np.ndarray  # likewise -turbulent (Re/8e4)^(4/5) V1; by Taylor -turbulent |Vn|^(1/2) V1
    by_critical_speed: np.ndarray  # s/m, Re/8e4 per |V1|
    segment: np.ndarray  # kg/m^2, 1/2 rho_f k5 of a robot's links

    def of_water(self) -> "SectionData":
        """The section data of the water alone: the mass and inertia of the body are zero."""
        none = np.zeros_like(self.mass)
        return self._replace(mass=none, lever=none, net=none, inertia1=self.added_roll, inertia2=none, inertia3=none)

    def rows(self, names: tuple[str, ...]) -> np.ndarray:
        """The fields with these `names`, concatenated."""
        return np.array([getattr(self, name) for name in names])


# Fields in which a section's inertial wrench, weight, flow pressure and drag are linear, in the order of the
# core's `SectionPart`.
PARTS = tuple(name for name in SectionData._fields if name not in ("added_roll", "by_critical_speed"))
DRAG_PARTS = "drag2", "drag3", "drag_roll"


class StationData(NamedTuple):
    """Data of the M stations, at which profiles are given."""

    sections: SectionData
    points: PanelPoints
    nodes_before: np.ndarray  # (M,) unsigned, number of nodes at or before the station
    added2_slope: np.ndarray  # (M,) kg/m^2, derivative of `added2` by X
    added3_slope: np.ndarray  # (M,) kg/m^2
    added_roll_slope: np.ndarray  # (M,) kg
    missed: np.ndarray | tuple[()]  # (15, M, p_max), by `PARTS`: corrections of the rows of `points`, times m; or none


def nose_of(body: Body, scene: Scene) -> tuple[float, float]:
    """m_o [kg] and 1/2 rho_f k_o [kg/m] of the nose."""
    area = np.pi * body.nose[0] * body.nose[1] if scene.nose else 0.0
    reactive = scene.fluid_density if scene.reactive and scene.added_inertia else 0.0
    resistive = 0.5 * scene.fluid_density if scene.resistive else 0.0
    return float(reactive * area * body.nose_added_mass * body.nose[2]), float(resistive * area * body.nose_drag)


def core_swimmer(
    body: Body,
    scene: Scene,
    grid: Grid,
    sections: SectionData,
    x: np.ndarray,
    kinks: str,
    fins: tuple[Fin, ...] = (),
    sensors: np.ndarray | tuple[()] = (),
) -> eel_core.Swimmer:
    """`body` in `scene` for the core: the `sections` at the nodes of `grid`, stations at `x` (M,) [m], and `sensors` at
    rising X (S,) [m]. kinks: which kinks of the drag are integrated exactly (`Accuracy`)."""
    nose_mass, nose_drag = nose_of(body, scene)
    of_fins, servos = core_fins(body, scene, grid, x, fins)
    stations = stations_of(body, scene, grid, sections, with_sensors(x, sensors))
    own = sections.added2, sections.added3, sections.added_roll
    swept = own if scene.added_inertia else swept_water(body, scene, grid.x)
    return eel_core.Swimmer(
        grid,
        sections,
        stations,
        shown=len(x),
        friction="laminar" if scene.friction == "none" or scene.viscosity == 0.0 else scene.friction,
        resistive=bool(scene.resistive),
        segmented=bool(sections.segment.any()),
        first_watched=WATCHED[kinks],
        wake=bool(scene.wake),
        inertia_of_water=bool(scene.added_inertia),
        tail_water=np.array([row[-1] for row in swept]),
        flow_gradient=bool(scene.flow_gradient),
        nose_mass=nose_mass,
        nose_drag=nose_drag,
        distributed_pressure=scene.tail_pressure == "distributed",
        offset=body.offset and not scene.planar,
        righting=GRAVITY * (scene.metacentric_height or float(scene.weight and not scene.planar)),
        gravity=GRAVITY if sections.net.any() else 0.0,
        missed_drag=missed_drag_of(body, scene, grid, sections) if kinks == "all" else (),
        fins=of_fins,
        servos=servos,
        appendages=core_appendages(body, scene, grid, x),
    )


def with_sensors(x: np.ndarray, sensors: np.ndarray | tuple[()]) -> np.ndarray:
    """The stations of a core's swimmer: `x` (M,) [m], then the `sensors` (S,) [m], which begin a stretch."""
    return np.concatenate((x, np.full(-len(x) % eel_core.FILLED, x[-1]), sensors)) if len(sensors) else x


def missed_drag_of(body: Body, scene: Scene, grid: Grid, sections: SectionData) -> np.ndarray | tuple[()]:
    """Corrections of the integrals of the drag up to a kink: (3, K, n), or empty for a smooth body."""
    if not (len(body.breaks) and scene.resistive):
        return ()
    angle = np.linspace(0.0, np.pi, 1 + PLACES * grid.matrix.shape[1])
    places = 0.5 - 0.5 * np.cos(angle)
    given = sections.rows(DRAG_PARTS)
    return missed_within(lambda x: sections_of(body, scene, x).rows(DRAG_PARTS), given, grid, body.breaks, places)


def weight_time(scene: Scene, sections: SectionData, weight: np.ndarray, length: float) -> float:
    """The shorter of the times [s] in which the straight body's weight rolls it (the inverse angular frequency), or
    moves it by its `length` [m]; infinite without weight.

    sections: at the nodes. weight (n,) [m]: integration weights of the nodes.
    """
    moment = GRAVITY * abs(scene.metacentric_height or scene.weight) * abs(float(weight @ sections.lever))
    force, time = GRAVITY * float(weight @ np.abs(sections.net)), np.inf
    if moment > 0.0 and not scene.planar:
        time = float(np.sqrt(weight @ sections.inertia1 / moment))
    return min(time, float(np.sqrt(length * (weight @ sections.mass) / force))) if force > 0.0 else time


def check_weight(body: Body, scene: Scene, sections: SectionData, weight: np.ndarray) -> None:
    """`ValueError` for a planar `scene` with a net weight, or a metacentric height for a `body` with its own offset.
    Other arguments as in `weight_time`."""
    net = float(weight @ np.abs(sections.net))
    if scene.metacentric_height and body.offset:
        raise ValueError(
            "scene metacentric_height must be 0 m for a body with centre_of_mass_offset, got "
            f"{scene.metacentric_height} m: turn on weight"
        )
    if scene.planar and net > NEUTRAL * float(weight @ sections.mass):
        raise ValueError(
            f"scene planar must be off where weight and buoyancy differ, got {GRAVITY * net:.3g} N between them"
        )


def stations_of(body: Body, scene: Scene, grid: Grid, nodes: SectionData, x: np.ndarray) -> StationData:
    """Tabulate `body` in `scene` at the stations `x` (M,) [m]. nodes: the sections at the nodes of `grid`."""
    missed: np.ndarray | tuple[()] = ()
    if len(body.breaks):
        given = nodes.rows(PARTS)
        missed = missed_before(lambda at: sections_of(body, scene, at).rows(PARTS), given, grid, body.breaks, x)
    a_squared, b_squared, a_slope, b_slope = squares = _squares_at(body, x.tobytes())
    slope2, slope3 = body.added_mass_slopes(x, squares, scene.added_mass == "printed")
    rho = scene.fluid_density if scene.reactive else 0.0
    sections, swept = sections_of(body, scene, x), swept_water(body, scene, x)
    return StationData(
        sections=sections._replace(**dict(zip(("added2", "added3", "added_roll"), swept, strict=True))),
        points=grid.points_at(x),
        nodes_before=np.searchsorted(grid.x, x, side="right").astype(np.uint64),
        added2_slope=rho * np.pi * slope2,
        added3_slope=rho * np.pi * slope3,
        added_roll_slope=rho * np.pi / 4.0 * (a_squared - b_squared) * (a_slope - b_slope),
        missed=missed,
    )


@lru_cache(maxsize=64)
def _squares_at(body: Body, x: bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """`Body.squares` at the stations, shared by all runs and companions of a body."""
    return body.squares(np.frombuffer(x))


def sections_on(body: Body, scene: Scene, grid: Grid) -> SectionData:
    """Section data of `body` in `scene` at the nodes of `grid`; for a body from data, values with its moments."""
    sections = sections_of(body, scene, grid.x)
    if not len(body.breaks):
        return sections
    table = SectionData(*with_moments(lambda x: np.array(sections_of(body, scene, x)), grid, body.breaks))
    # no zeros, such as at a pointed tail: a weight of a drag can then represent any load there
    drags = table.rows(DRAG_PARTS)
    least = LEAST * np.max(np.abs(drags), axis=1, keepdims=True)
    drags = np.where(np.abs(drags) < least, least, drags)
    return table._replace(by_critical_speed=sections.by_critical_speed, **dict(zip(DRAG_PARTS, drags, strict=True)))


def sections_of(body: Body, scene: Scene, x: np.ndarray) -> SectionData:
    """Section data of `body` in `scene` at `x` (n,) [m]."""
    a, b = body.half_height(x), body.half_width(x)
    area = np.pi * a * b
    mass = body.mass_per_length(x, scene.density)
    added2, added3, added_roll = (float(scene.added_inertia) * row for row in swept_water(body, scene, x))
    inertia2, inertia3 = mass * a**2 / 4.0, mass * b**2 / 4.0  # about the centre of mass
    lever, hung = np.zeros_like(mass), 0.0
    if body.offset:
        lever = mass * body.centre_of_mass_offset(x)
        hung = lever * body.centre_of_mass_offset(x)
    elif scene.metacentric_height:
        lever = mass  # times g h: `core_swimmer`
    half_rho = 0.5 * scene.fluid_density if scene.resistive else 0.0
    # at the nose c_f P has a limit, as c_f behaves like X^-1/2 and P like X^1/2
    behind = np.maximum(x, 1e-9 * body.length)
    c, d = (a, b) if np.array_equal(behind, x) else (body.half_height(behind), body.half_width(behind))
    perimeter = np.pi * (1.5 * (c + d) - np.sqrt(c * d)) * (0.5 if scene.perimeter == "printed" else 1.0)
    across = half_rho if scene.cross_flow else 0.0
    rubbed = 0.0 if scene.friction == "none" else half_rho * body.friction_factor
    c_2, c_3 = body.cross_flow(x)
    critical_speed = CRITICAL_REYNOLDS * scene.viscosity / behind  # m/s, |V1| at which Re = 8e4
    with np.errstate(divide="ignore"):
        by_critical_speed = np.where(critical_speed > 0.0, 1.0 / critical_speed, 0.0)
    if scene.friction == "taylor":
        oblique = TAYLOR * np.sqrt(scene.viscosity * perimeter / np.pi)
    else:
        oblique = perimeter * 0.059 * (scene.viscosity / behind) * CRITICAL_REYNOLDS**0.8
    table = SectionData(
        mass=mass,
        added2=added2,
        added3=added3,
        lever=lever,
        net=scene.fluid_density * area - mass if scene.weight else np.zeros_like(mass),
        inertia1=inertia2 + inertia3 + added_roll + hung,
        inertia2=inertia2 + hung,
        inertia3=inertia3,
        added_roll=added_roll,
        displaced=scene.fluid_density * area,
        drag2=across * 2.0 * c_2 * a,
        drag3=across * 2.0 * c_3 * b,
        drag_roll=across * body.roll_drag * np.pi * (a**2 - b**2) ** 2,
        laminar=rubbed * perimeter * 0.664 * np.sqrt(scene.viscosity / behind),
        turbulent=rubbed * oblique,
        by_critical_speed=by_critical_speed,
        segment=half_rho * body.joint_drag * area / (body.link_length or 1.0),
    )
    return SectionData(*(np.ascontiguousarray(row, dtype=float) for row in table))
