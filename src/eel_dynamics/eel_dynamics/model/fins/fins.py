# SPDX-License-Identifier: Apache-2.0
"""Fins: stiff plates on the body that turn about their span, with a given angle, a servo, or control of the roll.

A fin has its root on the side of the body, and its span points outwards. Its forces act at the centre of an elliptic
plate, on the hinge line: attached lift after Whicker and Fehlner (David Taylor Model Basin, report 933, 1958) without
sweep; the induced drag; beyond the stall the drag of a plate across the stream; and the added mass along its normal
(eel_core/loads/fins.hpp). The body acts as a mirror: the effective aspect ratio is 2 span^2 / area.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from eel_common.quantity import (
    Quantities,
    checked_choice,
    checked_instance,
    checked_row,
    documented,
    is_finite,
    number,
    quantity,
    required,
)
from eel_common.wording import shown

import eel_core
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.scene import Scene

COMMANDED = "commanded"  # value of `angle` for a fin that follows commands
SIDES = {"right": 1.0, "left": -1.0}  # direction along axis 2 of the sections
APART = 1e-9  # of the body's length: closer stations count as one
LONGEST_NAME = 100  # characters


@dataclass(frozen=True)
class RollHold(Quantities):
    """The angle of a fin that holds the roll level: -k_p roll - k_d Omega1 on the right side, the opposite on the left.

    roll [rad]: of the section at the fin's station, 0 upright. Omega1 [rad/s]: angular velocity of it about E1.
    """

    what: ClassVar[str] = "roll hold"

    k_p: float = quantity(2.0, "", "rad of the fin by rad of roll")
    k_d: float = quantity(0.15, "s", "rad of the fin by rad/s")


@documented
@dataclass(frozen=True)
class Fin(Quantities):
    """A fin. Immutable; `ValueError` names a bad field."""

    what: ClassVar[str] = "fin"

    station: float = required("m", "X of its hinge, inside the body", 0.0, exclusive=True)
    side: str = required("", "left or right", plain=True)
    area: float = required("m^2", "of the plate", 0.0, exclusive=True)
    aspect_ratio: float = required("", "effective, twice span^2 by area", 0.0, exclusive=True)
    dihedral: float = quantity(0.0, "rad", "how much its tip rises", -1.5, 1.5)
    angle: Any = quantity(
        0.0,
        "rad",
        "a number; (times [s], angles), which a smooth spline joins; a `RollHold`; or commanded: what "
        "`Simulation.command_fins` asks for, 0 at first. Above 0 the leading edge rises",
        plain=True,
    )
    time_constant: float | None = quantity(
        None, "s", "of the servo that follows the angle; None: none, the fin has the angle", 0.0, exclusive=True
    )
    limit: float = quantity(0.6, "rad", "of the servo", 0.0, exclusive=True)
    initial_angle: float = quantity(0.0, "rad", "of the servo at the start (of a `RollHold` on the right)")
    lift_slope: float | None = quantity(
        None, "", "of sine times cosine of the incidence; None: Whicker's and Fehlner's", 0.0
    )
    normal_drag: float = quantity(1.2, "", "coefficient of a plate across the stream", 0.0)
    friction_drag: float = quantity(0.01, "", "coefficient of a plate along the stream", 0.0)
    efficiency: float = quantity(0.9, "", "of its lift, in the induced drag", 0.0, exclusive=True)
    added_mass: float = quantity(1.0, "", "by that of a flat plate; 0: none", 0.0)
    name: str = quantity(
        "", "", "in topics and commands; empty: in a run its side, such as left, left_2", plain=True, compare=False
    )

    def __post_init__(self) -> None:
        checked_choice("fin side", self.side, SIDES)
        known = isinstance(self.name, str) and len(self.name) <= LONGEST_NAME and self.name.isprintable()
        if not known or " " in self.name:
            rule = f"a text of at most {LONGEST_NAME} characters without spaces"
            raise ValueError(f"fin name must be {rule}, got {shown(self.name)}")
        super().__post_init__()
        object.__setattr__(self, "angle", _checked_angle(self.angle))
        if self.time_constant is not None:
            return
        if isinstance(self.angle, RollHold) or self.angle == COMMANDED:
            kind = "a RollHold" if self.angle != COMMANDED else "a commanded fin"
            raise ValueError(f"fin time_constant must be given for {kind}, in s, got none")
        if self.initial_angle:
            raise ValueError(f"fin initial_angle needs a time_constant, in s, got {shown(self.initial_angle)} and none")

    @staticmethod
    def pair(station: float, area: float, aspect_ratio: float, name: str = "", **others: Any) -> tuple["Fin", "Fin"]:
        """A fin on the left and one on the right, each of this area. The arguments are those of `Fin`.

        name: of the pair. The name of each fin begins with its side.
        """
        checked_instance("fin name", name, str)
        names = {side: f"{side}_{name}" if name else "" for side in ("left", "right")}
        left = Fin(station, "left", area, aspect_ratio, name=names["left"], **others)
        return left, replace(left, side="right", name=names["right"])

    @property
    def span(self) -> float:
        """From root to tip [m]."""
        return math.sqrt(0.5 * self.aspect_ratio * self.area)

    @property
    def chord(self) -> float:
        """Mean chord [m]."""
        return self.area / self.span

    @property
    def axis(self) -> np.ndarray:
        """Unit vector (3,) from root to tip, section axes."""
        return np.array([0.0, SIDES[self.side] * math.cos(self.dihedral), math.sin(self.dihedral)])

    @property
    def normal(self) -> np.ndarray:
        """Unit normal (3,) at rest, upwards, section axes."""
        return np.array([0.0, -SIDES[self.side] * math.sin(self.dihedral), math.cos(self.dihedral)])

    def root(self, body: Body) -> np.ndarray:
        """(3,) [m] from the section's centre to the root, section axes."""
        return np.array([0.0, SIDES[self.side] * float(body.half_width(self.station)), 0.0])

    @property
    def slope(self) -> float:
        """The effective lift slope."""
        if self.lift_slope is not None:
            return self.lift_slope
        ratio = self.aspect_ratio
        return 0.9 * 2.0 * math.pi * ratio / (math.sqrt(ratio**2 + 4.0) + 1.8)

    @property
    def sign(self) -> float:
        """The sign of its angle relative to its servo's."""
        return -1.0 if isinstance(self.angle, RollHold) and self.side == "left" else 1.0

    @property
    def servo(self) -> tuple[Any, ...]:
        """The key of its servo: fins with equal keys share one servo."""
        own: Any = self.name if self.angle == COMMANDED else None
        where = self.station if isinstance(self.angle, RollHold) else own
        return self.angle, self.time_constant, self.limit, where, self.initial_angle


def _checked_angle(angle: Any) -> Any:
    if isinstance(angle, RollHold) or (isinstance(angle, str) and angle == COMMANDED):
        return angle
    if is_finite(angle):
        return number("fin angle", angle, "rad")
    try:
        if isinstance(angle, str):
            raise TypeError
        time, values = angle
    except (TypeError, ValueError):
        raise ValueError(
            f"fin angle must be a number in rad, (times, angles), a RollHold or commanded, got {shown(angle)}"
        ) from None
    time, values = checked_row("fin angle times", time, None), checked_row("fin angle angles", values, None)
    if len(time) < 2 or np.any(np.diff(time) <= 0.0) or len(values) != len(time):
        raise ValueError(
            f"fin angle must have rising times and as many angles, two or more, got {len(time)} times and "
            f"{len(values)} angles"
        )
    return tuple(time.tolist()), tuple(values.tolist())


def checked_fins(fins: Any, body: Body, scene: Scene) -> tuple[Fin, ...]:
    """The fins of a run, with pairs separated, each with its own name.

    `ValueError` names a fin that `body` or `scene` does not allow.
    """
    if fins is None:
        return ()
    if isinstance(fins, Fin) or not np.iterable(fins):
        raise ValueError(f"fins must be a list of Fin, got {shown(fins)}")
    flat = [each for item in fins for each in (item if isinstance(item, (tuple, list)) else (item,))]
    found = _named([checked_instance("fin", each, Fin) for each in flat])
    if found and scene.planar:
        raise ValueError(f"fins need a scene in space, got planar and {len(found)} fins")
    for place, fin in enumerate(found):
        if not APART * body.length < fin.station < (1.0 - APART) * body.length:
            raise ValueError(f"fin station must lie inside the body, 0 to {body.length:g} m, got {fin.station:g} m")
        for other in found[:place]:
            if other.side == fin.side and abs(other.station - fin.station) < APART * body.length:
                raise ValueError(
                    f"fins must be at different places, got two on the {fin.side} at X = {fin.station:g} m"
                )
    states = sum(1 for servo in servos_of(found) if servo[1] is not None)
    if states > eel_core.MOST_SERVOS:
        raise ValueError(f"fins must have {eel_core.MOST_SERVOS} servos with a time constant at most, got {states}")
    return found


def _named(fins: list[Fin]) -> tuple[Fin, ...]:
    """The `fins`, with names by side and order for those without. A name does not change when a fin moves."""
    taken = [fin.name for fin in fins if fin.name]
    for name in taken:
        if taken.count(name) > 1:
            raise ValueError(f"fins must have different names, got {shown(name)} twice")
    found = []
    for fin in fins:
        free = (name for name in (fin.side, *(f"{fin.side}_{k}" for k in range(2, len(fins) + 2))) if name not in taken)
        found.append(fin if fin.name else replace(fin, name=next(free)))
        taken.append(found[-1].name)
    return tuple(found)


def servos_of(fins: tuple[Fin, ...]) -> list[tuple[Any, ...]]:
    """The distinct servos of the fins."""
    return list(dict.fromkeys(fin.servo for fin in fins))


def edges_of(body: Body, stations: Iterable[float], known: tuple[float, ...] = ()) -> tuple[float, ...]:
    """X [m] at which panels must end for point loads at `stations`: those not within `APART` of a kink of the body, of
    `known`, or of each other."""
    ends, near = [0.0, *body.panel_ends, *known], APART * body.length
    edges: list[float] = []
    for station in sorted({*stations}):
        if min(abs(station - end) for end in ends) >= near:
            edges.append(station)
            ends.append(station)
    return tuple(edges)


def core_fins(
    body: Body, scene: Scene, grid: Grid, x: np.ndarray, fins: tuple[Fin, ...]
) -> tuple[list[Any], list[Any]]:
    """The fins and their servos for the core. x (M,) [m]: stations."""
    if not fins:
        return [], []
    near, servos = 10.0 * APART * body.length, servos_of(fins)
    node = {fin.station: int(np.searchsorted(grid.x, fin.station - near)) for fin in fins}
    rows = []
    for fin in fins:
        centre = fin.root(body) + 4.0 * fin.span / (3.0 * math.pi) * fin.axis
        reactive = scene.fluid_density * fin.added_mass if scene.reactive and scene.added_inertia else 0.0
        rows.append(
            (
                node[fin.station],
                fin.normal.tolist(),
                centre.tolist(),
                0.5 * scene.fluid_density * fin.area,
                fin.slope,
                1.0 / (math.pi * fin.efficiency * fin.aspect_ratio),
                fin.normal_drag,
                fin.friction_drag,
                reactive * 0.25 * math.pi * fin.chord**2 * fin.span,
                servos.index(fin.servo),
                fin.sign,
                int(np.searchsorted(x, fin.station - near)),
            )
        )
    turns = []
    for angle, time_constant, limit, station, initial in servos:
        gains = (angle.k_p, angle.k_d) if isinstance(angle, RollHold) else (0.0, 0.0)
        turns.append((time_constant or 0.0, limit, *gains, node.get(station, 0), initial))
    return rows, turns


def given_angles(fins: tuple[Fin, ...], commands: dict[str, float]) -> list[tuple[np.ndarray, np.ndarray]]:
    """The given angle of each servo: knots (n,) [s] and coefficients (n - 1, 4) of cubics [rad], constant first.

    commands: [rad] by the names of commanded fins."""
    return [
        _cubics(commands.get(where, 0.0) if angle == COMMANDED else angle) for angle, _, _, where, _ in servos_of(fins)
    ]


def commanded_names(fins: tuple[Fin, ...]) -> tuple[str, ...]:
    """Names of the `fins` that follow commands."""
    return tuple(fin.name for fin in fins if isinstance(fin.angle, str) and fin.angle == COMMANDED)


def checked_commands(fins: tuple[Fin, ...], commands: Any) -> dict[str, float]:
    """Angles [rad] by the names of commanded `fins`. `ValueError` for an unknown name, or an angle that is no
    number."""
    known = commanded_names(fins)
    for name in commands:
        checked_choice("commanded fin", name, known)
    return {name: number(f"angle of fin {name}", angle, "rad") for name, angle in commands.items()}


def _cubics(angle: Any) -> tuple[np.ndarray, np.ndarray]:
    if not isinstance(angle, tuple):
        constant = 0.0 if isinstance(angle, RollHold) else angle
        return np.array([0.0, 1.0]), np.array([[constant, 0.0, 0.0, 0.0]])
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(*angle, bc_type="clamped")
    return np.array(spline.x), np.ascontiguousarray(spline.c[::-1].T)


def knots_of(fins: tuple[Fin, ...]) -> list[float]:
    """Times [s] at which a derivative of a given angle jumps."""
    return sorted({time for fin in fins if isinstance(fin.angle, tuple) for time in fin.angle[0]})


def servo_time(fins: tuple[Fin, ...]) -> float:
    """The shortest time constant [s] of a servo; infinite without one."""
    return min((fin.time_constant for fin in fins if fin.time_constant is not None), default=np.inf)
