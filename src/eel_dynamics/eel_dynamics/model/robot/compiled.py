# SPDX-License-Identifier: Apache-2.0
"""A robot on its body as arrays, for the mechanics: modes, actuators, and how the law acts on them.

Curvature = imposed curvature + sum_m q_m(t) B_m(X), each B_m along E2 (pitch) or E3 (yaw): 1/width on the support of a
joint, a Legendre polynomial P_n(z), z from -1 to 1, on that of a continuous part. Everything here is in the paper's
section axes: q of a joint is the bend of the curvature, which the library's angle is times `sign`.
"""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from eel_common.cached import cached_property
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from numpy.polynomial import legendre

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.shapes import values_along
from eel_dynamics.model.robot.actuators import Servo, Torque
from eel_dynamics.model.robot.joint import STOP_DEPTH
from eel_dynamics.model.robot.part import HINGE
from eel_dynamics.model.robot.robot import Robot

GAUSS = legendre.leggauss(16)  # of each interval of a reference, and of a continuous part
# Equal intervals of a continuous part: for a bending_stiffness(X) that is not smooth or changes locally, and a moment.
PARTS_OF_SUPPORT, PARTS_OF_MOMENT = 256, 16
BETWEEN = np.array(((1.0, -1.0), (-1.0, 1.0)))  # stiffness matrix of a unit spring between two coordinates
SAME = 1e-9  # of the length: closer places count as one


class Motor(NamedTuple):
    """A servo, the mode of its joint, and its coordinate: an own one with a series spring, else that of the mode."""

    servo: Servo
    mode: int
    coordinate: int


class MuscleTable(NamedTuple):
    """A muscle: of its modes, the generalised torque is `projection` @ moment(t, points) [N m^2]."""

    modes: np.ndarray  # (n,) int
    moment: Law  # N m in place of rad/m
    points: np.ndarray  # (P,) m
    projection: np.ndarray  # (n, P) m: integral of B_m(X) moment(X) dX


@dataclass(frozen=True, eq=False)
class ModeTable:
    """The M modes of a robot, and its C coordinates: those of the modes, then of the motors behind series springs.

    Modes of one part are neighbours; the parts are ordered along the body.
    """

    axis: np.ndarray  # (M,) int, 1: E2 (pitch), 2: E3 (yaw)
    start: np.ndarray  # (M,) m, of the support
    end: np.ndarray  # (M,) m
    degree: np.ndarray  # (M,) int, of the Legendre polynomial; `HINGE`: a joint, B = 1/(end - start)
    sign: np.ndarray  # (M,) the library's angle divided by q
    name: tuple[str, ...]  # (C,), of the part
    stiffness: np.ndarray  # (C, C) N m/rad, or N m^4 over a continuous part
    damping: np.ndarray  # (C, C) N m s/rad, or N m^4 s; with the friction of the gears
    rest: np.ndarray  # (C,) rad, or rad/m; of a motor equal to that of its joint
    armature: np.ndarray  # (C,) kg m^2, with the rotor of a stiff gear; behind a spring the rotor alone
    initial: np.ndarray  # (M,) rad, of q at the start; NaN if not given
    limits: np.ndarray  # (M, 2) rad, of q; infinite without limits
    stop_stiffness: np.ndarray  # (M,) N m/rad
    stop_damping: np.ndarray  # (M,) N m s/rad^2, damping per depth
    motors: tuple[Motor, ...]  # the servos
    torques: tuple[tuple[int, Torque], ...]  # of joints with a torque given over time: mode and torque
    muscles: tuple[MuscleTable, ...]
    points: np.ndarray  # (P,) m, at which the law is read for the servos' references
    projection: np.ndarray  # (M, P) m: reference q_m = projection @ K_axis(t, points), K in section axes
    free: tuple[tuple[int, float, float], ...]  # (axis, start, end): where the law is not imposed
    edges: tuple[float, ...]  # m, inside the body, where panels must end: ends of supports and of imposed parts

    def __len__(self) -> int:
        return len(self.axis)

    @property
    def joints(self) -> np.ndarray:
        """(M,) whether a mode is that of a joint."""
        return np.asarray(self.degree == HINGE)

    @cached_property
    def driven(self) -> dict[str, tuple[int, float, float, float]]:
        """Of each joint with a servo: the servo's number, the joint's sign, and its limits [rad] of q."""
        found = {}
        for number, motor in enumerate(self.motors):
            low, high = map(float, self.limits[motor.mode])
            found[self.name[motor.mode]] = number, float(self.sign[motor.mode]), low, high
        return found

    def shape(self, x: np.ndarray) -> np.ndarray:
        """B_m (M, n) at `x` (n,) [m]: 1/m of joints, 1 of continuous parts. The end belongs to a support."""
        rows = []
        for start, end, degree in zip(self.start, self.end, self.degree, strict=True):
            inside = (x > start) & (x <= end)
            values = 1.0 / (end - start) if degree == HINGE else _legendre(degree, start, end, x)
            rows.append(np.where(inside, values, 0.0))
        return np.array(rows).reshape(len(self), len(x))

    def imposed(self, x: np.ndarray) -> np.ndarray:
        """Whether the law is imposed in pitch and yaw (2, n) at `x` (n,) [m]."""
        result = np.ones((2, len(x)), dtype=bool)
        for axis, start, end in self.free:
            result[axis - 1, (x > start) & (x <= end)] = False
        return result


@lru_cache(maxsize=64)
def mode_table(robot: Robot, body: Body, planar: bool = False) -> ModeTable:
    """`robot` on its `body` as arrays. planar: of a planar scene, which has no pitch.

    `ValueError` names the part, the field and the value that do not fit the body.
    """
    parts = [part.located(_beside(part, robot), body) for part in robot.parts]
    _check(parts, body, planar)
    supports = _supports(parts, body)
    degrees = [part.degrees for part in parts]
    sizes = [*map(len, degrees)]
    *firsts, total = np.concatenate(([0], np.cumsum(sizes))).astype(int).tolist()
    placed = list(zip(parts, firsts, strict=True))
    motors, size = _motors(placed, total)

    def column(name: str, of_others: Any) -> np.ndarray:
        """A field of the parts, for each mode; `of_others` for None, and for parts without the field."""
        given = [getattr(part, name, None) for part in parts]
        return np.repeat([of_others if value is None else value for value in given], sizes, axis=0)

    sign = np.repeat([part.sign for part in parts], sizes)
    rest, armature = np.zeros((2, size))
    rest[:total], armature[:total] = sign * column("rest_angle", 0.0), column("armature", 0.0)
    stiffness, damping = np.zeros((2, size, size))
    for part, support, first, count in zip(parts, supports, firsts, sizes, strict=True):
        block = slice(first, first + count)
        stiffness[block, block], damping[block, block] = _springs(part, *support)
    for servo, *pair in motors:
        mode, coordinate = pair
        if servo.has_spring:  # it has no rest angle of its own
            rest[coordinate] = rest[mode]
            stiffness[np.ix_(pair, pair)] += servo.series_stiffness * BETWEEN
            damping[np.ix_(pair, pair)] += servo.series_damping * BETWEEN
        armature[coordinate] += servo.reflected_inertia
        damping[coordinate, coordinate] += servo.friction
    names = np.repeat([part.name for part in parts], sizes).tolist()
    points, projection = _references(placed, total, body)
    return ModeTable(
        axis=column("component", 0),
        start=np.repeat([start for start, _ in supports], sizes),
        end=np.repeat([end for _, end in supports], sizes),
        degree=np.concatenate(degrees),
        sign=sign,
        name=(*names, *(names[mode] for _, mode, coordinate in motors if coordinate != mode)),
        stiffness=stiffness,
        damping=damping,
        rest=rest,
        armature=armature,
        initial=sign * column("initial_angle", np.nan),
        limits=np.sort(sign[:, None] * column("limits", (-np.inf, np.inf)), axis=1),
        stop_stiffness=column("stop_stiffness", 0.0),
        stop_damping=column("stop_damping", 0.0) / STOP_DEPTH,
        motors=motors,
        torques=tuple((mode, part.actuator) for part, mode in placed if isinstance(part.actuator, Torque)),
        muscles=tuple(_muscle(part, first) for part, first in placed if part.moment is not None),
        points=points,
        projection=projection,
        free=_free(parts, supports, body),
        edges=tuple(sorted({place for support in supports for place in support if 0.0 < place < body.length})),
    )


# -- places


def _beside(part: Any, robot: Robot) -> list[float]:
    """X [m] of the other joints of its axis."""
    return [each.position for each in robot.joints if each.component == part.component and each is not part]


def _supports(parts: list[Any], body: Body) -> list[tuple[float, float]]:
    """The supports [m], with places that differ by round-off from each other, or from a kink, set equal."""
    known, snapped = [0.0, *body.panel_ends], []
    for part in parts:
        ends = []
        for place in part.support:
            near = min(known, key=lambda other: abs(other - place))
            if abs(near - place) > SAME * body.length:
                known.append(near := place)
            ends.append(near)
        snapped.append((ends[0], ends[1]))
    return snapped


def _check(parts: list[Any], body: Body, planar: bool) -> None:
    """`ValueError` unless all `parts` lie inside the body and in the scene, and their modes differ."""
    seen: dict[Any, Any] = {}
    for part in parts:
        called, (start, end) = f"{part.what} {shown(part.name)}", part.support
        if planar and part.component == 1:
            raise ValueError(f"{called} axis must be yaw in a planar scene, got {part.axis}")
        part.check_place(body)
        other = seen.setdefault((min(part.degrees), part.component, start, end), part)
        if other is not part:
            raise ValueError(
                f"{called} must have a support of its own, got {start:g} to {end:g} m, which is that of "
                f"{shown(other.name)}"
            )


# -- modes


def _springs(part: Any, start: float, end: float) -> tuple[Any, Any]:
    """Stiffness and damping (n, n) of the modes of one part, without its motor."""
    if HINGE in part.degrees:
        return part.stiffness, part.damping
    x, weight = _quadrature(start, end, PARTS_OF_SUPPORT)
    basis = np.array([_legendre(degree, start, end, x) for degree in range(part.modes)])
    matrices = [(basis * (weight * _profile(part, name, x))) @ basis.T for name in ("bending_stiffness", "damping")]
    stiffness, damping = (0.5 * (matrix + matrix.T) for matrix in matrices)
    return stiffness, damping


def _profile(part: Any, name: str, x: np.ndarray) -> np.ndarray:
    """The field `name` of a continuous part at `x` [m]. `ValueError` where it is negative or not finite."""
    given = getattr(part, name)
    if not callable(given):
        return np.full(len(x), given)
    values = values_along(given, x)
    bad = np.flatnonzero(~(np.isfinite(values) & (values >= 0.0)))
    if len(bad):
        got = f"{values[bad[0]]:g} at X = {x[bad[0]]:.6g} m"
        raise ValueError(f"{part.what} {shown(part.name)} {name} must be finite and >= 0, got {got}")
    return values


def _muscle(part: Any, first: int) -> MuscleTable:
    points, weight = _quadrature(part.start, part.end, PARTS_OF_MOMENT)
    basis = np.array([_legendre(degree, part.start, part.end, points) for degree in range(part.modes)])
    return MuscleTable(first + np.arange(part.modes), part.moment, points, basis * weight)


def _legendre(degree: int, start: float, end: float, x: np.ndarray) -> np.ndarray:
    return np.asarray(legendre.legval(2.0 * (x - start) / (end - start) - 1.0, np.eye(degree + 1)[degree]))


def _quadrature(start: float, end: float, parts: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Points (P,) [m] and weights (P,) [m] of Gauss' rule over an interval in equal parts."""
    ends = np.linspace(start, end, parts + 1)
    half = 0.5 * np.diff(ends)[:, None]
    return (ends[:-1, None] + half * (1.0 + GAUSS[0])).ravel(), (half * GAUSS[1]).ravel()


def _motors(placed: list[Any], size: int) -> tuple[tuple[Motor, ...], int]:
    """The servos of `placed` parts with their first mode, and the number of coordinates for `size` modes."""
    motors = []
    for part, mode in placed:
        if isinstance(servo := part.actuator, Servo):
            motors.append(Motor(servo, mode, size if servo.has_spring else mode))
            size += servo.has_spring
    return tuple(motors), size


# -- the law


def _references(placed: list[Any], total: int, body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Points at which the law is read, and the rows that give the servos' references from its values there.

    placed: parts with their first mode. total: of all modes.
    """
    modes, rules = [], []
    for axis in (1, 2):
        soft = [part.support for part, _ in placed if HINGE not in part.degrees and part.component == axis]
        joints = [each for each in placed if each[0].actuator and each[0].component == axis]
        middles = [0.5 * (one.position + other.position) for (one, _), (other, _) in pairwise(joints)]
        for (joint, mode), start, end in zip(joints, [0.0, *middles], [*middles, body.length], strict=False):
            start = max([start, *(last for _, last in soft if last <= joint.position)])
            end = min([end, *(first for first, _ in soft if first >= joint.position)])
            if isinstance(joint.actuator, Servo) and end > start:
                modes.append(mode)
                rules.append(_quadrature(start, end))
    points = np.concatenate([points for points, _ in rules]) if rules else np.empty(0)
    projection = np.zeros((total, len(points)))
    for index, (mode, (_, weight)) in enumerate(zip(modes, rules, strict=True)):
        projection[mode, index * len(weight) : (index + 1) * len(weight)] = weight
    return points, projection


def _free(parts: list[Any], supports: list[Any], body: Body) -> tuple[tuple[int, float, float], ...]:
    """Where the law is not imposed: an axis with motors, or the supports of its parts."""
    found: list[tuple[int, float, float]] = []
    for axis in (1, 2):
        own = [(part, place) for part, place in zip(parts, supports, strict=True) if part.component == axis]
        driven = any(part.actuator for part, _ in own)
        found += [(axis, 0.0, body.length)] if driven else [(axis, *place) for _, place in own]
    return tuple(found)
