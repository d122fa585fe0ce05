# SPDX-License-Identifier: Apache-2.0
"""Reads what messages say of fins, joints and motors, as `messages` reads the rest."""

from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np
from eel_base.wording import shown

from eel_viz.messages import BadMessage, Body, Fin, Joint, finite, read_body, sized

MOST_PARTS = 256  # of a kind
AT_LIMIT = 1.0 - 1e-9  # of the torque that a motor can give, from which it counts as at its limit


@dataclass(frozen=True, kw_only=True, slots=True)
class JointStates:
    """Angles (n,) [rad] by `names`; rates [rad/s] and torques [N m] where they are known, else None."""

    names: tuple[str, ...]
    angle: np.ndarray
    rate: np.ndarray | None
    torque: np.ndarray | None

    def angles_of(self, names: tuple[str, ...]) -> np.ndarray:
        """The angles [rad] of the joints `names`, which must be there."""
        angles = dict(zip(self.names, self.angle.tolist(), strict=True))
        return np.array([angles[name] for name in names])


@dataclass(frozen=True, kw_only=True, slots=True)
class Motors:
    """Torque, greatest torque at the present speed (infinite without a limit) [N m], and power [W] of J motors."""

    torque: np.ndarray
    limit: np.ndarray
    power: np.ndarray

    @property
    def loads(self) -> np.ndarray:
        """What each gives of what it can, (J,), 0 to 1; of motors without a limit NaN."""
        torque, limited = np.abs(self.torque), np.isfinite(self.limit)
        none = np.where(limited, (torque > 0.0).astype(float), np.nan)  # at a speed at which no torque is left
        return np.asarray(np.divide(torque, self.limit, out=none, where=limited & (self.limit > 0.0)))


def read_body_with_parts(message: Any) -> Body:
    """From eel_msgs/BodyGeometry; one of an older bag has no parts."""
    body = read_body(message)
    fins = tuple(_fin(each, body.length) for each in _few("fins", getattr(message, "fins", ())))
    joints = tuple(_joint(each, body.length) for each in _few("joints", getattr(message, "joints", ())))
    return replace(body, fins=fins, joints=joints)


def read_joints(message: Any) -> JointStates:
    """From sensor_msgs/JointState, whose positions must be there."""
    names = tuple(_few("name", message.name))
    rows = {name: getattr(message, name, ()) for name in ("velocity", "effort")}
    angle = finite("position", sized("position", message.position, len(names), "name"))
    rate, torque = (
        finite(name, sized(name, row, len(names), "name")) if len(row) else None for name, row in rows.items()
    )
    return JointStates(names=names, angle=angle, rate=rate, torque=torque)


def read_motors(message: Any) -> Motors:
    """From eel_msgs/MotorStates."""
    count = len(_few("torque", message.torque))
    torque, power = (finite(name, sized(name, getattr(message, name), count, "torque")) for name in ("torque", "power"))
    limit = sized("limit", message.limit, count, "torque")
    if not (limit >= 0.0).all():  # NaN too
        raise BadMessage("limit", f"must be >= 0 N m, the least is {limit.min():g} N m")
    return Motors(torque=torque, limit=limit, power=power)


def _few(name: str, values: Any) -> Any:
    if len(values) > MOST_PARTS:
        raise BadMessage(name, f"must have at most {MOST_PARTS}, got {len(values)}")
    return values


def _fin(message: Any, length: float) -> Fin:
    values = {name: float(getattr(message, name)) for name in ("station", "area", "span", "dihedral")}
    for name, value in values.items():
        most = length if name == "station" else np.inf
        if not isfinite(value) or (name != "dihedral" and not 0.0 < value <= most):
            raise BadMessage("fins", f"must have a {name} above 0 within the body, got {shown(value)}")
    if message.side not in (-1, 1):
        raise BadMessage("fins", f"must have the side 1 or -1, got {shown(message.side)}")
    return Fin(name=message.name, side=int(message.side), **values)


def _joint(message: Any, length: float) -> Joint:
    if not 0.0 <= message.station <= length or message.axis not in (2, 3):
        raise BadMessage(
            "joints",
            f"must lie within the body and bend about axis 2 or 3, got X = {shown(message.station)} m and axis "
            f"{message.axis}",
        )
    return Joint(name=message.name, station=float(message.station), axis=int(message.axis))
