"""What the loops need of the body and the scene, tabulated once: section data at the nodes (model of sections 3.3, 4.2,
7.2.1).

Half-axes a along E3, b along E2. Body: m_b = rho_b pi a b, J2 = rho_b pi a^3 b/4, J3 = rho_b pi a b^3/4, J1 = J2 + J3.
Water: J_f1 = rho_f pi/8 (a^2 - b^2)^2, M_f = rho_f pi diag(0, a^2, b^2) (eq. 37 with its semi-axes exchanged: the added
mass for motion along an axis of an ellipse goes with the square of the other half-axis; Lamb; section 4.3 of the
paper).
"""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .body import Body
from .kinks import WATCHED
from .lanes import WIDTH, aligned
from .packed import Form
from .quadrature import Blocks, Grid, Panel
from .scene import FRICTION, Scene

FILLED = WIDTH  # nodes, of whose multiples there are always as many
WIDEST_PANEL = 24  # points; a longer panel is cut into equal parts
CLOSEST = 1e-3  # lengths between a kink of the body and a knot of a law that still gets a panel
TRANSITION = 8.0e4  # Reynolds number at which the printed friction law jumps from laminar to turbulent


class Swimmer(NamedTuple):
    """Constants of a run at the n nodes and at the nose, SI units. Arrays (n,) unless said; those of float64 are longer
    and 0 behind the last node (`lanes`), but for x."""

    x: np.ndarray  # m
    blocks: int  # of eight nodes
    upto: Blocks  # of the integral from the nose to each node
    weight: np.ndarray  # m, of the integral over the body
    first: np.ndarray  # (n,) unsigned, first node of the node's panel
    count: np.ndarray  # (n,) unsigned, nodes of the panel
    mass: np.ndarray  # kg/m, of the body
    added2: np.ndarray  # kg/m, added mass along E2
    added3: np.ndarray  # kg/m, along E3
    inertia1: np.ndarray  # kg m, of body and water about E1
    inertia2: np.ndarray  # kg m, about E2
    inertia3: np.ndarray  # kg m, about E3
    added_roll: np.ndarray  # kg m, of the water about E1
    drag2: np.ndarray  # kg/m^2, 1/2 rho_f k2
    drag3: np.ndarray  # kg/m^2, 1/2 rho_f k3
    drag_roll: np.ndarray  # kg, 1/2 rho_f k4
    laminar: np.ndarray  # friction force per length = -laminar |V1|^(1/2) V1
    turbulent: np.ndarray  # friction force per length = -turbulent (|V1|/transition)^(4/5) V1
    transition: np.ndarray  # m/s, |V1| at which Re = 8e4
    reynolds: np.ndarray  # s/m, 1/transition
    friction: int  # index into scene.FRICTION
    resistive: bool
    watched: int  # first row of the speeds along the body whose changes of sign are looked for (`kinks`)
    wake: float  # 1; 0 where no water is swept past the sections
    nose_mass: float  # kg, m_o
    nose_drag: float  # kg/m, 1/2 rho_f k_o
    fraction: np.ndarray  # (n,) of the node's panel, in its own variable
    apart: np.ndarray  # (n,) one by the difference of the fraction to the node before, in the panel; to its start
    span: np.ndarray  # (n,) one by that between the nodes before and behind; those of a panel's last node are not used
    barycentric: np.ndarray  # (n,) weights of the interpolation in a panel
    series: np.ndarray  # (p, n) m, of the integrals from a panel's start to any place in it


def panels_of(body: Body, resolution: float, knots: tuple[float, ...] = (), wrench: bool = True) -> tuple[Panel, ...]:
    """Panels between the kinks of `body` and the `knots` [m] of a law's splines, with about `resolution` points per
    length of the body, and three to spare each; where the internal `wrench` is wanted more in the first, in which the
    body and its loads go like roots of X (they weigh little there), and in the last where they do so at the tail.

    The loops take eight nodes at once: the last eight are filled, by points for the panels that would have them next.
    """
    least = CLOSEST * body.length
    kinks = np.array([0.0, *body.panel_ends])
    inner = [knot for knot in knots if np.min(np.abs(kinks - knot)) > least and kinks[1] < knot < body.length]
    panels, start = [], 0.0
    for end in sorted({*body.panel_ends, *inner}):
        points = 3 + nearest(resolution * (end - start) / body.length)
        graded = "start" if start == 0.0 else "end" if end == body.length and body.pointed_tail else ""
        if graded:
            points = 1 + (max(points, 3 + nearest(math.sqrt(resolution))) if wrench else points)
        parts = -(-points // WIDEST_PANEL) if start > 0.0 else 1
        edges = np.linspace(start, end, parts + 1).tolist()
        for left, right in pairwise(edges):
            kind = graded if right == end else ""
            panels.append(Panel(start=left, end=right, points=-(-points // parts), graded=kind))
        start = end
    for _ in range(-sum(panel.points for panel in panels) % FILLED):
        index = min(range(len(panels)), key=lambda k: (round(_next_resolution(panels[k], body.length), 6), k))
        panels[index] = replace(panels[index], points=panels[index].points + 1)
    return tuple(panels)


def _next_resolution(panel: Panel, length: float) -> float:
    """The resolution at which `panel` of a body of `length` [m] would have a further point."""
    return (panel.points - 2.5 - (1 if panel.graded else 0)) * length / (panel.end - panel.start)


def nearest(count: float) -> int:
    """The nearest whole number, halves upwards: the last bit of `count` differs between versions of numpy."""
    return math.floor(count + 0.5 + 1e-9)


def added_masses(body: Body, scene: Scene, a_squared, b_squared):
    """M_f along E2 and E3 [kg/m], J_f1 [kg m]; zero where the scene has no reactive water."""
    rho = scene.fluid_density if scene.reactive else 0.0
    along2, along3 = (a_squared, b_squared) if scene.added_mass == "corrected" else (b_squared, a_squared)
    return rho * np.pi * along2, rho * np.pi * along3, rho * np.pi / 8.0 * (a_squared - b_squared) ** 2


def swimmer_of(body: Body, scene: Scene, grid: Grid, kinks: str = "all") -> Swimmer:
    """Tabulate `body` in `scene` at the nodes of `grid`; `kinks`: which of the drag's are integrated exactly
    (`Accuracy`)."""
    before = np.where(np.arange(len(grid.x)) > grid.first, np.roll(grid.fraction, 1), 0.0)
    behind = np.where(grid.fraction < 1.0, np.roll(grid.fraction, -1), 2.0)
    apart, span = 1.0 / (grid.fraction - before), 1.0 / (behind - before)
    return _tabulate(
        body,
        scene,
        grid.x,
        watched=int(WATCHED[kinks]),
        upto=grid.blocks(),
        weight=aligned(grid.weight),
        first=grid.first,
        count=grid.count,
        fraction=aligned(grid.fraction),
        apart=aligned(apart),
        span=aligned(span),
        barycentric=aligned(grid.barycentric),
        series=aligned(grid.series),
    )


class Stations(NamedTuple):
    """Section data where profiles are given, M stations; as `Swimmer`, from whose nodes they go on."""

    section: Swimmer  # (M,) each
    node: np.ndarray  # (M,) int, the last node at or before the station, -1: none
    added2_slope: np.ndarray  # (M,) kg/m^2, derivative of `added2` by X
    added3_slope: np.ndarray  # (M,) kg/m^2
    added_roll_slope: np.ndarray  # (M,) kg


def stations_of(body: Body, scene: Scene, grid: Grid, x: np.ndarray) -> Stations:
    """Tabulate `body` in `scene` at the stations `x` (M,) [m]."""
    a_squared, b_squared, a_slope, b_slope = body.squares(x)
    slope2, slope3, _ = added_masses(body, scene, a_slope, b_slope)
    rho = scene.fluid_density if scene.reactive else 0.0
    none, no_index = np.zeros(0), np.zeros(0, dtype=np.uintp)
    return Stations(
        section=_tabulate(
            body,
            scene,
            x,
            watched=0,
            upto=grid.blocks(x),
            weight=none,
            first=no_index,
            count=no_index,
            fraction=none,
            apart=none,
            span=none,
            barycentric=none,
            series=np.zeros((0, 0)),
        ),
        node=(np.searchsorted(grid.x, x, side="right") - 1).astype(np.int64),
        added2_slope=aligned(slope2),
        added3_slope=aligned(slope3),
        added_roll_slope=aligned(rho * np.pi / 4.0 * (a_squared - b_squared) * (a_slope - b_slope)),
    )


@cache
def example() -> tuple[Swimmer, Stations]:
    """A swimmer and its stations, for the types of their arrays."""
    body, scene = Body.boyer2010(), Scene()
    grid = Grid.of(panels_of(body, 1.0))
    return swimmer_of(body, scene, grid), stations_of(body, scene, grid, np.array([0.0, body.length]))


SWIMMER, STATIONS = Form(lambda: example()[0]), Form(lambda: example()[1])


def _tabulate(body: Body, scene: Scene, x, **grid) -> Swimmer:
    a, b = body.half_height(x), body.half_width(x)
    density = body.density if scene.density is None else scene.density
    area = np.pi * a * b
    added2, added3, added_roll = added_masses(body, scene, a**2, b**2)
    inertia2, inertia3 = density * area * a**2 / 4.0, density * area * b**2 / 4.0
    half_rho = 0.5 * scene.fluid_density if scene.resistive else 0.0
    behind = np.maximum(
        x, 1e-9 * body.length
    )  # at the nose c_f P has a limit, as c_f grows like X^-1/2 and P like X^1/2
    c, d = body.half_height(behind), body.half_width(behind)
    perimeter = np.pi * (1.5 * (c + d) - np.sqrt(c * d)) * (0.5 if scene.perimeter == "printed" else 1.0)
    nose_area = np.pi * body.nose[0] * body.nose[1] if scene.nose else 0.0
    reactive_rho = scene.fluid_density if scene.reactive else 0.0
    rubbed = 0.0 if scene.friction == "none" else half_rho
    transition = TRANSITION * scene.viscosity / behind
    with np.errstate(divide="ignore"):
        reynolds = np.where(transition > 0.0, 1.0 / transition, 0.0)
    return Swimmer(
        x=np.ascontiguousarray(x, dtype=float),
        blocks=-(-len(x) // WIDTH),
        mass=aligned(density * area),
        added2=aligned(added2),
        added3=aligned(added3),
        inertia1=aligned(inertia2 + inertia3 + added_roll),
        inertia2=aligned(inertia2),
        inertia3=aligned(inertia3),
        added_roll=aligned(added_roll),
        drag2=aligned(half_rho * 2.0 * body.lateral_drag * a),
        drag3=aligned(half_rho * 2.0 * body.vertical_drag * b),
        drag_roll=aligned(half_rho * body.roll_drag * np.pi * (a**2 - b**2) ** 2),
        laminar=aligned(rubbed * perimeter * 0.664 * np.sqrt(scene.viscosity / behind)),
        turbulent=aligned(rubbed * perimeter * 0.059 * (scene.viscosity / behind) * TRANSITION**0.8),
        transition=aligned(transition),
        reynolds=aligned(reynolds),
        friction=FRICTION.index("laminar" if scene.friction == "none" or scene.viscosity == 0.0 else scene.friction),
        resistive=bool(scene.resistive),
        wake=float(scene.wake),
        nose_mass=float(reactive_rho * nose_area * body.nose_added_mass * body.nose[2]),
        nose_drag=float(half_rho * nose_area * body.nose_drag),
        **grid,
    )
