# SPDX-License-Identifier: Apache-2.0
"""Reads the swimmer's messages into arrays, and checks that they are finite and of consistent size.

Each `read_*` takes one message (any object with its fields) and returns arrays, or raises `BadMessage` with the name of
the field.
"""

from functools import lru_cache
from math import isfinite
from typing import Any

import numpy as np
from eel_common.topics import ENERGY_FIELDS, LATER_ENERGY_FIELDS
from eel_common.wording import shown

from eel_viz import messages
from eel_viz.messages import BadMessage

UNIT_TOLERANCE = 1e-6  # of a quaternion's norm
MOST_STATIONS = 20_000  # in a message; the dynamics node sends at most half as many
MOST_PARTS = 256  # of a kind
MOST_APPENDAGES = 1000


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


def read_pose(pose: Any) -> messages.Pose:
    """From geometry_msgs/Pose."""
    q = pose.orientation
    orientation = _unit("orientation", np.array([q.x, q.y, q.z, q.w]))
    return messages.Pose(position=_vector("position", pose.position), orientation=orientation)


def read_twist(twist: Any) -> messages.Twist:
    """From geometry_msgs/Twist."""
    return messages.Twist(linear=_vector("linear", twist.linear), angular=_vector("angular", twist.angular))


def read_backbone(message: Any) -> messages.Backbone:
    """From eel_msgs/Backbone."""
    x = _stations(message.x)
    position = _row(message, "position", 3 * len(x)).reshape(-1, 3)
    orientation = _unit("orientation", _sized(message, "orientation", 4 * len(x)).reshape(-1, 4))
    return messages.Backbone(x=x, position=position, orientation=orientation)


def read_body(message: Any) -> messages.Body:
    """From eel_msgs/BodyGeometry. In an older bag it has no parts."""
    x = _stations(message.x)
    half: dict[str, Any] = {name: _row(message, name, len(x)) for name in ("half_width", "half_height")}
    for name, values in half.items():
        if np.any(values < 0.0):
            raise BadMessage(name, f"has negative values, the least is {values.min():g} m")
    size = {name: getattr(message, name) for name in ("length", "mass")}
    for name, value in size.items():
        if not 0.0 < value < np.inf:
            raise BadMessage(name, f"must be > 0 and finite, got {shown(value)}")
    fins = tuple(_fin(each, message.length) for each in _few("fins", getattr(message, "fins", ())))
    joints = tuple(_joint(each, message.length) for each in _few("joints", getattr(message, "joints", ())))
    return messages.Body(**size, x=x, **half, fins=fins, joints=joints, appendages=_appendages(message))


def read_imu(message: Any) -> tuple[np.ndarray, np.ndarray]:
    """From sensor_msgs/Imu: specific force (3,) [m/s^2] and angular velocity (3,) [rad/s]."""
    force = _vector("linear_acceleration", message.linear_acceleration)
    return force, _vector("angular_velocity", message.angular_velocity)


def read_pressure(message: Any) -> np.ndarray:
    """From sensor_msgs/FluidPressure: (1,) [Pa]."""
    return _finite("fluid_pressure", np.array([message.fluid_pressure], dtype=float))


def read_depth(message: Any) -> np.ndarray:
    """From geometry_msgs/PoseWithCovarianceStamped of a depth gauge: (1,) [m], below z = 0."""
    return _finite("pose.pose.position.z", np.array([-message.pose.pose.position.z], dtype=float))


def read_velocity(message: Any) -> np.ndarray:
    """From geometry_msgs/TwistWithCovarianceStamped of a velocity log: (3,) [m/s]."""
    return _vector("twist.twist.linear", message.twist.twist.linear)


def read_path(message: Any) -> np.ndarray:
    """From nav_msgs/Path: the positions (n, 3) [m]."""
    points = [(each.pose.position.x, each.pose.position.y, each.pose.position.z) for each in message.poses]
    return _finite("poses", np.array(points, dtype=float).reshape(-1, 3))


def read_wrench(message: Any) -> messages.Profiles:
    """From eel_msgs/InternalWrench: torques [N m], forces [N]."""
    return _profiles(message, messages.WRENCH_FIELDS)


def read_curvature(message: Any) -> messages.Profiles:
    """From eel_msgs/Curvature [rad/m], [rad/(m s)]."""
    return _profiles(message, messages.CURVATURE_FIELDS)


def read_load(message: Any) -> messages.Load:
    """From eel_msgs/HydrodynamicLoad."""
    wake = getattr(message, "wake_momentum_rate", None)
    return messages.Load(
        profiles=_profiles(message, messages.LOAD_FIELDS),
        tail=_vector("tail_force", message.tail_force),
        nose=_vector("nose_force", message.nose_force),
        wake=None if wake is None else _vector("wake_momentum_rate", wake),
        fins=_finite("fin_force", np.asarray(getattr(message, "fin_force", ()), dtype=float)),
    )


def read_flow(message: Any) -> tuple[np.ndarray, np.ndarray]:
    """From eel_msgs/FlowVectors: points (n, 3) [m] and the water's velocities (n, 3) [m/s], world."""
    count = len(message.position)
    if count % 3 or count > 3 * MOST_STATIONS:
        raise BadMessage("position", f"must have 3 numbers for each of {MOST_STATIONS} points at most, got {count}")
    position, velocity = (_row(message, name, count).reshape(-1, 3) for name in ("position", "velocity"))
    return position, velocity


def read_energy(message: Any) -> dict[str, float]:
    """From eel_msgs/EnergyLedger: one number per field [J], [W]; 0 for fields that an older bag lacks."""
    absent = {name for name in LATER_ENERGY_FIELDS if not hasattr(message, name)}
    values = {name: 0.0 if name in absent else getattr(message, name) for name in ENERGY_FIELDS}
    for name, value in values.items():
        if not np.isfinite(value):
            raise BadMessage(name, f"is {shown(value)}")
    return values


def read_joints(message: Any) -> messages.JointStates:
    """From sensor_msgs/JointState, which must have positions."""
    names = tuple(_few("name", message.name))
    angle = _row(message, "position", len(names), "name")
    rate, torque = (
        _row(message, name, len(names), "name") if len(getattr(message, name, ())) else None
        for name in ("velocity", "effort")
    )
    return messages.JointStates(names=names, angle=angle, rate=rate, torque=torque)


def read_motors(message: Any) -> messages.Motors:
    """From eel_msgs/MotorStates; an older bag has no names."""
    count = len(_few("torque", message.torque))
    torque, power = (_row(message, name, count, "torque") for name in ("torque", "power"))
    limit = _sized(message, "limit", count, "torque")
    if not (limit >= 0.0).all():  # NaN too
        raise BadMessage("limit", f"must be >= 0 N m, the least is {limit.min():g} N m")
    names = tuple(_few("name", getattr(message, "name", ())))
    if len(names) not in (0, count):
        raise BadMessage("name", f"must have as many values as torque, {count}, got {len(names)}")
    return messages.Motors(names=names, torque=torque, limit=limit, power=power)


def read_diagnostics(message: Any) -> list[messages.Status]:
    """From diagnostic_msgs/DiagnosticArray. Values without a key are left out: a recording cannot hold them."""
    return [
        messages.Status(
            name=status.name,
            level=int.from_bytes(status.level, "little") if isinstance(status.level, bytes) else int(status.level),
            message=status.message,
            values={entry.key: entry.value for entry in status.values if entry.key},
        )
        for status in message.status
    ]


def _profiles(message: Any, names: tuple[str, ...]) -> messages.Profiles:
    x = _stations(message.x)
    values = {name: _sized(message, name, len(x)) for name in names}
    if not np.isfinite(np.array([*values.values()])).all():
        for name, array in values.items():
            _finite(name, array)
    return messages.Profiles(x=x, values=values)


def _stations(values: Any) -> np.ndarray:
    if len(values) > MOST_STATIONS:
        raise BadMessage("x", f"must have at most {MOST_STATIONS} stations, got {len(values)}")
    return _checked_stations(np.asarray(values, dtype=float).tobytes())


@lru_cache(maxsize=16)  # messages with equal stations share one array
def _checked_stations(content: bytes) -> np.ndarray:
    x = _finite("x", np.frombuffer(content))
    if len(x) < 2:
        raise BadMessage("x", f"must have at least 2 stations, got {len(x)}")
    if not (x[1:] > x[:-1]).all():
        raise BadMessage("x", "must increase from station to station")
    return x


def _row(message: Any, name: str, size: int, fitting: str = "x") -> np.ndarray:
    """The field `name` as in `_sized`, checked to be finite."""
    return _finite(name, _sized(message, name, size, fitting))


def _sized(message: Any, name: str, size: int, fitting: str = "x") -> np.ndarray:
    """The field `name` as an array (size,), the length of the field `fitting`."""
    array = np.asarray(getattr(message, name), dtype=float)
    if array.shape != (size,):
        raise BadMessage(name, f"must have {size} numbers to fit {fitting}, got {array.size}")
    return array


def _finite(name: str, array: np.ndarray) -> np.ndarray:
    if not np.isfinite(array).all():
        raise BadMessage(name, "has values that are not finite")
    return array


def _vector(name: str, vector: Any) -> np.ndarray:
    values = vector.x, vector.y, vector.z
    array = np.array(values)
    return array if all(map(isfinite, values)) else _finite(name, array)


def _unit(name: str, quaternions: np.ndarray) -> np.ndarray:
    error = np.abs(np.sqrt(np.square(quaternions).sum(axis=-1)) - 1.0)
    if not (error <= UNIT_TOLERANCE).all():  # NaN too
        raise BadMessage(name, f"must have quaternions of unit norm, worst error {np.max(error):g}")
    return quaternions


def _few(name: str, values: Any) -> Any:
    if len(values) > MOST_PARTS:
        raise BadMessage(name, f"must have at most {MOST_PARTS}, got {len(values)}")
    return values


def _appendages(message: Any) -> np.ndarray:
    """Places [m] and drag areas [m^2], (A, 4)."""
    rows = _finite("appendages", np.asarray(getattr(message, "appendages", ()), dtype=float))
    if rows.size % 4 or rows.size > 4 * MOST_APPENDAGES:
        raise BadMessage("appendages", f"must have 4 numbers for each of {MOST_APPENDAGES} at most, got {rows.size}")
    if np.any(rows[3::4] < 0.0):
        raise BadMessage("appendages", f"has negative areas, the least is {rows[3::4].min():g} m^2")
    return rows.reshape(-1, 4)


def _fin(message: Any, length: float) -> messages.Fin:
    values = {name: float(getattr(message, name)) for name in ("station", "area", "span", "dihedral")}
    for name, value in values.items():
        most = length if name == "station" else np.inf
        if not isfinite(value) or (name != "dihedral" and not 0.0 < value <= most):
            raise BadMessage("fins", f"must have a {name} above 0 within the body, got {shown(value)}")
    if message.side not in (-1, 1):
        raise BadMessage("fins", f"must have the side 1 or -1, got {shown(message.side)}")
    return messages.Fin(name=message.name, side=int(message.side), **values)


def _joint(message: Any, length: float) -> messages.Joint:
    if not 0.0 <= message.station <= length or message.axis not in (2, 3):
        raise BadMessage(
            "joints",
            f"must lie within the body and bend about axis 2 or 3, got X = {shown(message.station)} m and axis "
            f"{message.axis}",
        )
    return messages.Joint(name=message.name, station=float(message.station), axis=int(message.axis))
