# SPDX-License-Identifier: Apache-2.0
"""Reads the swimmer's messages into arrays, and checks that they are finite and of consistent size.

Each `read_*` takes one message (any object with its fields) and returns arrays, or raises `BadMessage` that names the
field. Frames and units are those of the message.
"""

from dataclasses import dataclass, field
from functools import lru_cache
from math import isfinite
from typing import Any

import numpy as np
from eel_base.topics import ENERGY_FIELDS, LATER_ENERGY_FIELDS
from eel_base.wording import shown

UNIT_TOLERANCE = 1e-6  # of a quaternion's norm
MOST_STATIONS = 20_000  # of a message; the dynamics node has at most half as many


class BadMessage(ValueError):
    """A message that cannot be shown; `field` is the faulty field, so that each fault is reported once."""

    def __init__(self, field: str, problem: str) -> None:
        super().__init__(f"{field} {problem}")
        self.field = field


@dataclass(frozen=True, kw_only=True, slots=True)
class Pose:
    """`position` (3,) [m] and `orientation` (4,), x y z w, in the world frame."""

    position: np.ndarray
    orientation: np.ndarray


@dataclass(frozen=True, kw_only=True, slots=True)
class Twist:
    """`linear` (3,) [m/s] and `angular` (3,) [rad/s] in base_link."""

    linear: np.ndarray
    angular: np.ndarray


@dataclass(frozen=True, kw_only=True, slots=True)
class Fin:
    """A plate with its root on the body's side at X = `station` [m]; `side` along section axis 2: 1 right, -1 left.

    `area` [m^2], `span` [m], `dihedral` [rad].
    """

    name: str
    station: float
    side: int
    area: float
    span: float
    dihedral: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Joint:
    """A joint at X = `station` [m] that bends about the section's `axis`, 2 or 3."""

    name: str
    station: float
    axis: int


@dataclass(frozen=True, kw_only=True, slots=True)
class Body:
    """`length` [m], `mass` [kg], and half axes [m], (B,) at `x` [m], (B,); what it has of fins and joints."""

    length: float
    mass: float
    x: np.ndarray
    half_width: np.ndarray
    half_height: np.ndarray
    fins: tuple[Fin, ...] = ()
    joints: tuple[Joint, ...] = ()


@dataclass(frozen=True, kw_only=True, slots=True)
class Backbone:
    """`position` (M, 3) [m] and `orientation` (M, 4) in the world frame at stations `x` (M,) [m]."""

    x: np.ndarray
    position: np.ndarray
    orientation: np.ndarray


@dataclass(frozen=True, kw_only=True, slots=True)
class Profiles:
    """Named profiles in section axes, each (M,), at stations `x` (M,) [m]; names and units are the message's."""

    x: np.ndarray
    values: dict[str, np.ndarray]

    def together(self, *names: str) -> np.ndarray:
        """The profiles `names` side by side, (M, len(names))."""
        return np.array([self.values[name] for name in names]).T


@dataclass(frozen=True, kw_only=True, slots=True)
class Load:
    """The fluid's load: `profiles` [N/m], and the forces at `tail` and `nose`, (3,) [N], all in section axes.

    `wake` (3,) [N]: momentum that the tail gives to the wake per time, in the tail's axes; None in an older bag.
    `fins` (3 F,) [N]: the forces on F fins, in the axes of their sections.
    """

    profiles: Profiles
    tail: np.ndarray
    nose: np.ndarray
    wake: np.ndarray | None = None
    fins: np.ndarray = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, kw_only=True, slots=True)
class Status:
    """One status of a DiagnosticArray: `level` 0 OK, 1 WARN, 2 ERROR, 3 STALE."""

    name: str
    level: int
    message: str
    values: dict[str, str]


WRENCH_FIELDS = ("torque_1", "torque_2", "torque_3", "force_1", "force_2", "force_3")
CURVATURE_FIELDS = ("pitch", "pitch_rate", "yaw", "yaw_rate")
LOAD_FIELDS = ("force_1", "force_2", "force_3", "resistive_1", "resistive_2", "resistive_3")


def same(x: np.ndarray, other: np.ndarray) -> bool:
    """Whether two arrays of stations, (M,) [m], are equal; fast if they are the same object."""
    return x is other or np.array_equal(x, other)


def stamp_of(message: Any) -> int:
    """header.stamp [ns], 0 or more."""
    stamp = message.header.stamp
    if stamp.sec < 0 or stamp.nanosec >= 1_000_000_000:
        raise BadMessage("header.stamp", f"must be >= 0 s with nanosec < 1e9, got {stamp.sec} s and {stamp.nanosec} ns")
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def is_at_start(message: Any) -> bool:
    """Whether header.stamp is 0; False for a message without it."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    return stamp is not None and stamp.sec == 0 and stamp.nanosec == 0


def read_pose(pose: Any) -> Pose:
    """From geometry_msgs/Pose."""
    p, q = pose.position, pose.orientation
    orientation = np.array([q.x, q.y, q.z, q.w])
    _check_unit("orientation", orientation)
    return Pose(position=_vector("position", p), orientation=orientation)


def read_twist(twist: Any) -> Twist:
    """From geometry_msgs/Twist."""
    return Twist(linear=_vector("linear", twist.linear), angular=_vector("angular", twist.angular))


def read_backbone(message: Any) -> Backbone:
    """From eel_msgs/Backbone."""
    x = _stations(message.x)
    position = finite("position", sized("position", message.position, 3 * len(x))).reshape(-1, 3)
    orientation = sized("orientation", message.orientation, 4 * len(x)).reshape(-1, 4)
    _check_unit("orientation", orientation)
    return Backbone(x=x, position=position, orientation=orientation)


def read_body(message: Any) -> Body:
    """From eel_msgs/BodyGeometry."""
    x = _stations(message.x)
    half_width, half_height = (
        finite(name, sized(name, getattr(message, name), len(x))) for name in ("half_width", "half_height")
    )
    for name, values in (("half_width", half_width), ("half_height", half_height)):
        if np.any(values < 0.0):
            raise BadMessage(name, f"has negative values, the least is {values.min():g} m")
    for name, value in (("length", message.length), ("mass", message.mass)):
        if not 0.0 < value < np.inf:
            raise BadMessage(name, f"must be > 0 and finite, got {shown(value)}")
    return Body(length=message.length, mass=message.mass, x=x, half_width=half_width, half_height=half_height)


def read_path(message: Any) -> np.ndarray:
    """From nav_msgs/Path: the positions (n, 3) [m]."""
    points = [(each.pose.position.x, each.pose.position.y, each.pose.position.z) for each in message.poses]
    return finite("poses", np.array(points, dtype=float).reshape(-1, 3))


def read_wrench(message: Any) -> Profiles:
    """From eel_msgs/InternalWrench: torques [N m], forces [N]."""
    return _profiles(message, WRENCH_FIELDS)


def read_curvature(message: Any) -> Profiles:
    """From eel_msgs/Curvature [rad/m], [rad/(m s)]."""
    return _profiles(message, CURVATURE_FIELDS)


def read_load(message: Any) -> Load:
    """From eel_msgs/HydrodynamicLoad."""
    wake = getattr(message, "wake_momentum_rate", None)
    return Load(
        profiles=_profiles(message, LOAD_FIELDS),
        tail=_vector("tail_force", message.tail_force),
        nose=_vector("nose_force", message.nose_force),
        wake=None if wake is None else _vector("wake_momentum_rate", wake),
        fins=finite("fin_force", np.asarray(getattr(message, "fin_force", ()), dtype=float)),
    )


def read_flow(message: Any) -> tuple[np.ndarray, np.ndarray]:
    """From eel_msgs/FlowVectors: points (n, 3) [m] and the water's velocities (n, 3) [m/s], world."""
    count = len(message.position)
    if count % 3 or count > 3 * MOST_STATIONS:
        raise BadMessage("position", f"must have 3 numbers for each of {MOST_STATIONS} points at most, got {count}")
    position, velocity = (
        finite(name, sized(name, getattr(message, name), count)).reshape(-1, 3) for name in ("position", "velocity")
    )
    return position, velocity


def read_energy(message: Any) -> dict[str, float]:
    """From eel_msgs/EnergyLedger: one number per field [J], [W]; 0 for those that an older bag has not."""
    older = () if hasattr(message, "drag_work") else LATER_ENERGY_FIELDS
    values = {name: 0.0 if name in older else getattr(message, name) for name in ENERGY_FIELDS}
    for name, value in values.items():
        if not np.isfinite(value):
            raise BadMessage(name, f"is {shown(value)}")
    return values


def read_diagnostics(message: Any) -> list[Status]:
    """From diagnostic_msgs/DiagnosticArray."""
    return [
        Status(
            name=status.name,
            level=int.from_bytes(status.level, "little") if isinstance(status.level, bytes) else int(status.level),
            message=status.message,
            values={entry.key: entry.value for entry in status.values},
        )
        for status in message.status
    ]


def _profiles(message: Any, names: tuple[str, ...]) -> Profiles:
    x = _stations(message.x)
    values = {name: sized(name, getattr(message, name), len(x)) for name in names}
    if not np.isfinite(np.array([*values.values()])).all():
        for name, array in values.items():
            finite(name, array)
    return Profiles(x=x, values=values)


def _stations(values: Any) -> np.ndarray:
    if len(values) > MOST_STATIONS:
        raise BadMessage("x", f"must have at most {MOST_STATIONS} stations, got {len(values)}")
    return _checked_stations(np.asarray(values, dtype=float).tobytes())


@lru_cache(maxsize=16)  # one array for all messages with equal stations
def _checked_stations(content: bytes) -> np.ndarray:
    x = finite("x", np.frombuffer(content))
    if len(x) < 2:
        raise BadMessage("x", f"must have at least 2 stations, got {len(x)}")
    if not (x[1:] > x[:-1]).all():
        raise BadMessage("x", "must increase from station to station")
    return x


def sized(name: str, values: Any, size: int, fitting: str = "x") -> np.ndarray:
    """`values` as an array, (size,), as many as the field `fitting` has; `BadMessage` for another size."""
    array = np.asarray(values, dtype=float)
    if array.shape != (size,):
        raise BadMessage(name, f"must have {size} numbers to fit {fitting}, got {array.size}")
    return array


def finite(name: str, array: np.ndarray) -> np.ndarray:
    """`array`, if all of it is finite; else `BadMessage`."""
    if not np.isfinite(array).all():
        raise BadMessage(name, "has values that are not finite")
    return array


def _vector(name: str, vector: Any) -> np.ndarray:
    values = vector.x, vector.y, vector.z
    array = np.array(values)
    return array if all(map(isfinite, values)) else finite(name, array)


def _check_unit(name: str, quaternions: np.ndarray) -> None:
    error = np.abs(np.sqrt(np.square(quaternions).sum(axis=-1)) - 1.0)
    if not (error <= UNIT_TOLERANCE).all():  # NaN too
        raise BadMessage(name, f"must have quaternions of unit norm, worst error {np.max(error):g}")
