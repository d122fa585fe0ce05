# SPDX-License-Identifier: Apache-2.0
"""A robot on its body as arrays, for the mechanics: modes, actuators, and how the law acts on them.

Curvature = imposed curvature + sum_m q_m(t) B_m(X), each B_m along E2 (pitch) or E3 (yaw): 1/width on the support of a
joint, a Legendre polynomial P_n(z), z from -1 to 1, on that of a continuous part. Everything here is in the paper's
section axes: q of a joint is the bend of the curvature, which the library's angle is times `sign`.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
from eel_base.wording import shown
from eel_gaits.laws.law import Law
from numpy.polynomial import legendre

from eel_model.body.body import Body
from eel_model.robot.actuators import Servo, Torque
from eel_model.robot.continuous import Muscle, PassiveTail
from eel_model.robot.joint import Joint
from eel_model.robot.part import AXES
from eel_model.robot.robot import Robot

HINGE = -1  # degree of a joint's mode
GAUSS = legendre.leggauss(16)  # of each interval of a reference, and of a continuous part
PARTS_OF_SUPPORT = 4  # equal intervals of a continuous part, for bending_stiffness(X) that is not smooth
LONE_WIDTH = 0.05  # of the length: of a joint that is alone in its axis
SAME = 1e-9  # of the length: places that are nearer are the same


@dataclass(frozen=True, eq=False)
class ActuatorTable:
    """The A actuators, in the joints' own sign times `sign` of their modes: as q. Infinite where there is no limit.

    Of a stiff gear, inertia and friction are part of the mode's `armature` and `damping` already.
    """

    mode: np.ndarray  # (A,) int, index of the joint's mode
    kind: tuple[str, ...]  # "servo" or "torque"
    kp: np.ndarray  # (A,) N m/rad
    kd: np.ndarray  # (A,) N m s/rad
    torque_limit: np.ndarray  # (A,) N m
    speed_limit: np.ndarray  # (A,) rad/s
    gear: np.ndarray  # (A,)
    rotor_inertia: np.ndarray  # (A,) kg m^2, ahead of the gear
    inertia: np.ndarray  # (A,) kg m^2, behind it: gear^2 rotor_inertia
    friction: np.ndarray  # (A,) N m s/rad, behind it
    series: np.ndarray  # (A,) bool: with a spring, so the motor has an angle of its own
    series_stiffness: np.ndarray  # (A,) N m/rad, 0 without
    series_damping: np.ndarray  # (A,) N m s/rad
    torque: tuple[Torque | None, ...]  # (A,), of the kind "torque": N m in the joint's sign

    def __len__(self) -> int:
        return len(self.kind)


@dataclass(frozen=True, eq=False)
class MuscleTable:
    """A muscle: of its modes, the generalised torque is `projection` @ moment(t, points) [N m^2]."""

    name: str
    modes: np.ndarray  # (n,) int
    moment: Law  # N m in place of rad/m
    points: np.ndarray  # (P,) m
    projection: np.ndarray  # (n, P) m: integral of B_m(X) moment(X) dX


@dataclass(frozen=True, eq=False)
class ModeTable:
    """The M modes of a robot. Those of one part are neighbours; the parts are ordered along the body."""

    axis: np.ndarray  # (M,) int, 1: E2 (pitch), 2: E3 (yaw)
    start: np.ndarray  # (M,) m, of the support
    end: np.ndarray  # (M,) m
    degree: np.ndarray  # (M,) int, of the Legendre polynomial; `HINGE`: a joint, B = 1/(end - start)
    sign: np.ndarray  # (M,) the library's angle over q
    name: tuple[str, ...]  # (M,), of the part
    stiffness: np.ndarray  # (M, M) N m/rad, or N m^4 over a continuous part
    damping: np.ndarray  # (M, M) N m s/rad, or N m^4 s
    rest: np.ndarray  # (M,) rad, or rad/m
    initial: np.ndarray  # (M,) rad, of q at the start; NaN where it is not given
    limits: np.ndarray  # (M, 2) rad, of q, infinite where there are none
    stop_stiffness: np.ndarray  # (M,) N m/rad
    stop_damping: np.ndarray  # (M,) N m s/rad
    armature: np.ndarray  # (M,) kg m^2
    actuators: ActuatorTable
    muscles: tuple[MuscleTable, ...]
    points: np.ndarray  # (P,) m, at which the law is read for the servos' references
    projection: np.ndarray  # (M, P) m: reference q_m = projection @ K_axis(t, points), K in section axes
    free: tuple[tuple[int, float, float], ...]  # (axis, start, end): where the law is not imposed
    edges: tuple[float, ...]  # m, inside the body, where a panel must end: of supports, and jumps of what is imposed

    def __len__(self) -> int:
        return len(self.axis)

    def shape(self, x: np.ndarray) -> np.ndarray:
        """B_m (M, n) at `x` (n,) [m]: 1/m of joints, 1 of continuous parts. An end belongs to the support."""
        rows = []
        for start, end, degree in zip(self.start, self.end, self.degree, strict=True):
            inside = (x >= start) & (x <= end)
            values = 1.0 / (end - start) if degree == HINGE else _legendre(degree, start, end, x)
            rows.append(np.where(inside, values, 0.0))
        return np.array(rows).reshape(len(self), len(x))

    def imposed(self, x: np.ndarray) -> np.ndarray:
        """Whether the law is imposed in pitch and yaw (n, 2) at `x` (n,) [m]."""
        result = np.ones((len(x), 2), dtype=bool)
        for axis, start, end in self.free:
            result[:, axis - 1] &= ~((x >= start) & (x <= end))
        return result


@lru_cache(maxsize=64)
def mode_table(robot: Robot, body: Body, planar: bool = False) -> ModeTable:
    """`robot` on its `body` as arrays. planar: of a planar scene, which has no pitch.

    `ValueError` names the part, the field and the value that do not fit the body.
    """
    parts = [_located(part, robot, body) for part in robot.parts]
    for part in parts:
        _check(part, body, planar)
    _check_distinct(parts)
    supports = _supports(parts, body)
    modes = [_modes(part, support) for part, support in zip(parts, supports, strict=True)]
    counts = [len(each["degree"]) for each in modes]
    firsts = np.concatenate(([0], np.cumsum(counts))).astype(int)
    columns = {
        name: np.concatenate([np.asarray(each[name]) for each in modes]) if modes else np.empty(0)
        for name in ("start", "end", "sign", "rest", "initial", "stop_stiffness", "stop_damping", "armature")
    }
    total = int(firsts[-1])
    stiffness, damping = np.zeros((total, total)), np.zeros((total, total))
    for first, count, each in zip(firsts, counts, modes, strict=False):
        block = slice(first, first + count)
        stiffness[block, block], damping[block, block] = each["stiffness"], each["damping"]
    points, projection = _references(parts, firsts, body)
    free = _free(parts, supports, body)
    return ModeTable(
        **columns,
        axis=np.array([axis for each in modes for axis in each["axis"]], dtype=int),
        degree=np.array([degree for each in modes for degree in each["degree"]], dtype=int),
        name=tuple(part.name for part, count in zip(parts, counts, strict=True) for _ in range(count)),
        stiffness=stiffness,
        damping=damping,
        limits=np.array([limits for each in modes for limits in each["limits"]]).reshape(total, 2),
        actuators=_actuators(parts, firsts),
        muscles=tuple(_muscle(part, first) for part, first in zip(parts, firsts, strict=False) if _is_muscle(part)),
        points=points,
        projection=projection,
        free=free,
        edges=tuple(sorted({place for support in supports for place in support if 0.0 < place < body.length})),
    )


# -- places


def _located(part: Any, robot: Robot, body: Body) -> Any:
    """`part` with the width, or the end, that follows from its neighbours and the body."""
    if isinstance(part, PassiveTail):
        return part if part.end is not None else replace(part, end=body.length)
    if isinstance(part, Muscle) or part.width is not None:
        return part
    others = [each.position for each in robot.joints if _component(each) == _component(part) and each is not part]
    distances = [abs(place - part.position) for place in others]
    nearest = min(distances, default=2.0 * LONE_WIDTH * body.length)
    if nearest == 0.0:
        raise ValueError(f"joints of one axis must have positions of their own, got {part.position:g} m twice")
    return replace(part, width=0.5 * nearest)


def _support(part: Any) -> tuple[float, float]:
    if isinstance(part, Joint):
        assert part.width is not None
        return part.position - 0.5 * part.width, part.position + 0.5 * part.width
    return part.start, part.end


def _supports(parts: list[Any], body: Body) -> list[tuple[float, float]]:
    """The supports [m], where places that differ by round-off, from one another or from a kink, are one."""
    known, snapped = [0.0, *body.panel_ends], []
    for part in parts:
        ends = []
        for place in _support(part):
            near = min(known, key=lambda other: abs(other - place))
            if abs(near - place) > SAME * body.length:
                known.append(near := place)
            ends.append(near)
        snapped.append((ends[0], ends[1]))
    return snapped


def _component(part: Any) -> int:
    return AXES[part.axis][0]


def _is_muscle(part: Any) -> bool:
    return isinstance(part, Muscle)


def _check(part: Any, body: Body, planar: bool) -> None:
    """`ValueError` unless `part` lies inside the body and in the scene."""
    called, (start, end) = f"{part.what} {shown(part.name)}", _support(part)
    if planar and _component(part) == 1:
        raise ValueError(f"{called} axis must be yaw in a planar scene, got {part.axis}")
    if isinstance(part, Joint):
        said = f"got {start:g} to {end:g} m (position {part.position:g}, width {part.width:g})"
        if start <= 0.0 or end >= body.length:
            raise ValueError(f"{called} position and width must lie inside (0, {body.length:g}) m, {said}")
        if start < body.panel_ends[0] - 1e-12 * body.length:
            raise ValueError(
                f"{called} position and width must lie behind the nose's first panel, from {body.panel_ends[0]:g} m on "
                f"(there is almost no inertia ahead), {said}"
            )
    elif end > body.length or start >= body.length:
        raise ValueError(f"{called} start and end must lie in 0 to {body.length:g} m, got {start:g} to {end:g}")


def _check_distinct(parts: list[Any]) -> None:
    """`ValueError` for two parts of one kind and axis on equal supports: their modes would be the same."""
    seen: dict[Any, Any] = {}
    for part in parts:
        key = isinstance(part, Joint), _component(part), *_support(part)
        if key in seen:
            start, end = _support(part)
            raise ValueError(
                f"{part.what} {shown(part.name)} must have a support of its own, got {start:g} to {end:g} m, which is "
                f"that of {shown(seen[key].name)}"
            )
        seen[key] = part


# -- modes


def _modes(part: Any, support: tuple[float, float]) -> dict[str, Any]:
    """The columns of the modes of one part."""
    axis, sign = AXES[part.axis]
    start, end = support
    if isinstance(part, Joint):
        low, high = part.limits or (-np.inf, np.inf)
        servo = part.actuator if isinstance(part.actuator, Servo) and part.actuator.series_stiffness is None else None
        return {
            "axis": [axis],
            "start": [start],
            "end": [end],
            "degree": [HINGE],
            "sign": [float(sign)],
            "stiffness": [[part.stiffness]],
            "damping": [[part.damping + (servo.friction if servo else 0.0)]],
            "rest": [sign * part.rest_angle],
            "initial": [np.nan if part.initial_angle is None else sign * part.initial_angle],
            "limits": [sorted((sign * low, sign * high))],
            "stop_stiffness": [part.stop_stiffness],
            "stop_damping": [part.stop_damping],
            "armature": [part.armature + (servo.inertia if servo else 0.0)],
        }
    count = part.modes
    x, weight = _quadrature(start, end, PARTS_OF_SUPPORT)
    basis = np.array([_legendre(degree, start, end, x) for degree in range(count)])
    matrices = {
        name: (basis * (weight * _profile(part, name, x))) @ basis.T for name in ("bending_stiffness", "damping")
    }
    symmetric = {name: 0.5 * (matrix + matrix.T) for name, matrix in matrices.items()}
    return {
        "axis": [axis] * count,
        "start": [start] * count,
        "end": [end] * count,
        "degree": list(range(count)),
        "sign": [1.0] * count,
        "stiffness": symmetric["bending_stiffness"],
        "damping": symmetric["damping"],
        "rest": np.zeros(count),
        "initial": np.full(count, np.nan),
        "limits": [(-np.inf, np.inf)] * count,
        "stop_stiffness": np.zeros(count),
        "stop_damping": np.zeros(count),
        "armature": np.zeros(count),
    }


def _profile(part: Any, name: str, x: np.ndarray) -> np.ndarray:
    """The field `name` of a continuous part at `x` [m]. `ValueError` where it is negative or not finite."""
    given = getattr(part, name)
    if not callable(given):
        return np.full(len(x), given)
    try:
        values = np.broadcast_to(np.asarray(given(x), dtype=float), x.shape)
    except (TypeError, ValueError):  # a function of one number at a time
        values = np.array([float(given(float(each))) for each in x])
    bad = np.flatnonzero(~(np.isfinite(values) & (values >= 0.0)))
    if len(bad):
        got = f"{values[bad[0]]:g} at X = {x[bad[0]]:.6g} m"
        raise ValueError(f"{part.what} {shown(part.name)} {name} must be finite and >= 0, got {got}")
    return values


def _muscle(part: Muscle, first: int) -> MuscleTable:
    points, weight = _quadrature(part.start, part.end, PARTS_OF_SUPPORT)
    basis = np.array([_legendre(degree, part.start, part.end, points) for degree in range(part.modes)])
    return MuscleTable(part.name, first + np.arange(part.modes), part.moment, points, basis * weight)


def _legendre(degree: int, start: float, end: float, x: np.ndarray) -> np.ndarray:
    return np.asarray(legendre.legval(2.0 * (x - start) / (end - start) - 1.0, np.eye(degree + 1)[degree]))


def _quadrature(start: float, end: float, parts: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Points (P,) [m] and weights (P,) [m] of Gauss' rule over an interval in equal parts."""
    ends = np.linspace(start, end, parts + 1)
    half = 0.5 * np.diff(ends)[:, None]
    return (ends[:-1, None] + half * (1.0 + GAUSS[0])).ravel(), (half * GAUSS[1]).ravel()


# -- actuators and the law


def _actuators(parts: list[Any], firsts: np.ndarray) -> ActuatorTable:
    driven = [
        (first, part) for part, first in zip(parts, firsts, strict=False) if isinstance(part, Joint) and part.actuator
    ]
    servos = [part.actuator if isinstance(part.actuator, Servo) else None for _, part in driven]

    def column(name: str, none: float = 0.0) -> np.ndarray:
        values = [none if servo is None or getattr(servo, name) is None else getattr(servo, name) for servo in servos]
        return np.array(values, dtype=float)

    return ActuatorTable(
        mode=np.array([first for first, _ in driven], dtype=int),
        kind=tuple("torque" if servo is None else "servo" for servo in servos),
        kp=column("kp"),
        kd=column("kd"),
        torque_limit=column("torque_limit", np.inf),
        speed_limit=column("speed_limit", np.inf),
        gear=column("gear", 1.0),
        rotor_inertia=column("rotor_inertia"),
        inertia=column("inertia"),
        friction=column("friction"),
        series=np.array([servo is not None and servo.series_stiffness is not None for servo in servos], dtype=bool),
        series_stiffness=column("series_stiffness"),
        series_damping=column("series_damping"),
        torque=tuple(part.actuator if isinstance(part.actuator, Torque) else None for _, part in driven),
    )


def _motors(parts: list[Any], axis: int) -> list[Any]:
    return [part for part in parts if isinstance(part, Joint) and part.actuator and _component(part) == axis]


def _references(parts: list[Any], firsts: np.ndarray, body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Points of the law, and the rows that make the servos' references of its values there."""
    intervals: list[tuple[int, float, float]] = []
    for axis in (1, 2):
        soft = [_support(part) for part in parts if not isinstance(part, Joint) and _component(part) == axis]
        joints = _motors(parts, axis)
        middles = [0.5 * (one.position + other.position) for one, other in pairwise(joints)]
        for joint, start, end in zip(joints, [0.0, *middles], [*middles, body.length], strict=False):
            start = max([start, *(last for _, last in soft if last <= joint.position)])
            end = min([end, *(first for first, _ in soft if first >= joint.position)])
            if isinstance(joint.actuator, Servo) and end > start:
                intervals.append((int(firsts[parts.index(joint)]), start, end))
    rules = [_quadrature(start, end) for _, start, end in intervals]
    points = np.concatenate([points for points, _ in rules]) if rules else np.empty(0)
    projection = np.zeros((int(firsts[-1]), len(points)))
    for index, ((mode, *_), (_, weight)) in enumerate(zip(intervals, rules, strict=True)):
        projection[mode, index * len(weight) : (index + 1) * len(weight)] = weight
    return points, projection


def _free(parts: list[Any], supports: list[Any], body: Body) -> tuple[tuple[int, float, float], ...]:
    """Where the law is not imposed: an axis with motors, or the supports of its parts."""
    found: list[tuple[int, float, float]] = []
    for axis in (1, 2):
        if _motors(parts, axis):
            found.append((axis, 0.0, body.length))
        else:
            found += [(axis, *place) for part, place in zip(parts, supports, strict=True) if _component(part) == axis]
    return tuple(found)
