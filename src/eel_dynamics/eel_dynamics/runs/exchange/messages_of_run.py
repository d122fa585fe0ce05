# SPDX-License-Identifier: Apache-2.0
"""Converts a run to the messages that the node would publish: same topics and fields, as plain objects without ROS."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
from eel_common.quantity import checked_row, numbers
from eel_common.topics import ENERGY_FIELDS
from eel_common.wording import shown

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.fins.fins import SIDES, Fin
from eel_dynamics.model.flow.flow import lattice_around, velocities_at
from eel_dynamics.model.robot.actuators import current_by_torque, most_torque
from eel_dynamics.model.robot.joint_signs import message_signs, sense_of
from eel_dynamics.model.robot.part import AXES
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.runs.exchange.message_fields import FIELDS, OF_JOINTS, PROFILES, SIGNED
from eel_dynamics.runs.run_data import RunData

SECOND = 1_000_000_000  # ns


def messages_of_run(run: RunData) -> Iterator[tuple[str, SimpleNamespace]]:
    """Yield topic and message in the order of time: body and law, then all samples, then the diagnostics."""
    run = run.in_axes("rep103")
    start, end = (_stamp(run.time[k]) for k in (0, -1))
    yield "body", _body_of(run)
    yield "curvature_law", SimpleNamespace(name=run.law.name)
    yield "diagnostics", _status(run, start, "computed", {})
    for k in range(len(run.time)):
        yield from _sample(run, k)
    yield "diagnostics", _status(run, end, "computed", _checks(run))


def goal_message(points: Any) -> tuple[str, SimpleNamespace]:
    """Topic and message of a goal with way `points` (n, 3) [m]. `ValueError` for others."""
    if (places := numbers("goal", points)).ndim != 2 or places.shape[1] != 3:
        raise ValueError(f"goal must be way points (n, 3), got {shown(points)}")
    checked_row("goal", places.ravel(), None)
    poses = [SimpleNamespace(pose=SimpleNamespace(position=SimpleNamespace(x=x, y=y, z=z))) for x, y, z in places]
    return "goal", SimpleNamespace(poses=poses)


def outline(body: Body, x: np.ndarray) -> dict[str, np.ndarray]:
    """Abscissae and half axes of the body [m], each (N,), by the field names of BodyGeometry.

    The abscissae are `x` (M,) [m] and points in between, which are denser at the nose.
    """
    x = np.array(sorted({*x, *(body.length * np.linspace(0.0, 1.0, 101) ** 2)}))
    return {
        "x": x,
        "half_width": np.asarray(body.half_width(x), dtype=float),
        "half_height": np.asarray(body.half_height(x), dtype=float),
    }


def numbers_of_appendages(body: Body) -> list[float]:
    """Of each appendage of a BodyGeometry its place, three numbers [m], and its greatest drag area [m^2]."""
    factor = body.appendage_factor
    return [number for each in body.appendages for number in (each.x, each.y, each.z, factor * max(each.drag))]


def fields_of_fins(fins: tuple[Fin, ...]) -> list[dict[str, Any]]:
    """The fields of a FinGeometry of each of the `fins`."""
    own = ("name", "station", "area", "span", "dihedral")
    return [{"side": int(SIDES[fin.side]), **{name: getattr(fin, name) for name in own}} for fin in fins]


def fields_of_joints(robot: Robot | None) -> list[dict[str, Any]]:
    """The fields of a JointGeometry of each joint of the `robot`; none without one."""
    joints = () if robot is None else robot.joints
    return [
        {
            "name": joint.name,
            "station": joint.position,
            "axis": AXES[joint.axis][0] + 1,
            "sense": sense_of(joint.axis),
        }
        for joint in joints
    ]


def _body_of(run: RunData) -> SimpleNamespace:
    """The body as a BodyGeometry."""
    return SimpleNamespace(
        length=float(run.body.length),
        mass=float(run.body_mass),
        **outline(run.body, run.x),
        appendages=numbers_of_appendages(run.body),
        fins=[SimpleNamespace(**fields) for fields in fields_of_fins(run.fins)],
        joints=[SimpleNamespace(**fields) for fields in fields_of_joints(run.robot)],
    )


def _sample(run: RunData, k: int) -> Iterator[tuple[str, SimpleNamespace]]:
    """Topic and message at sample `k`, of the topics whose quantities the run has."""
    header, signs = SimpleNamespace(stamp=_stamp(run.time[k])), message_signs(run.robot)
    for topic, fields in FIELDS.items():
        values = {path: getattr(run, each.quantity) for path, each in fields.items()}
        if (first := next(iter(values.values()))) is None or not first.size:
            continue
        message = SimpleNamespace(header=header, **_besides(run, k, topic))
        for path, each in fields.items():
            if values[path] is not None:  # a file of an older version may have none
                sign = signs if each.quantity in SIGNED else 1.0
                _put(message, path, sign * each.of(values[path][k]) + 0.0, each.parts)
        yield topic, message
    if run.flow is not None:
        points = lattice_around(run.backbone[k].mean(axis=0), run.body.length, run.flow)
        velocity = velocities_at(run.flow, points, run.time[k]) + run.scene.current
        yield "flow_vectors", SimpleNamespace(header=header, position=points.ravel(), velocity=velocity.ravel())
    if run.energy is not None:
        ledger = {name: float(run.energy[name][k]) for name in ENERGY_FIELDS}
        yield "energy", SimpleNamespace(header=header, **ledger)


def _besides(run: RunData, k: int, topic: str) -> dict[str, Any]:
    """What the message of a `topic` has besides the fields that `FIELDS` names."""
    if topic == "fin_states":
        return {"name": [fin.name for fin in run.fins]}
    if topic in OF_JOINTS and run.robot is not None:
        names = {"name": [joint.name for joint in run.robot.joints]}
        if topic == "joint_states" or run.motor_torque is None or run.motor_power is None:
            return names
        servos, torque = run.robot.servos, run.motor_torque[k]
        current = message_signs(run.robot) * current_by_torque(servos) * torque
        return names | {"limit": most_torque(servos, torque, run.motor_power[k]), "current": current}
    profile = {"x": run.x} if topic in PROFILES else {}
    return profile | ({"fin_name": [fin.name for fin in run.fins]} if topic == "hydrodynamic_load" else {})


def _put(message: SimpleNamespace, path: str, numbers: np.ndarray, parts: str) -> None:
    """Put `numbers` into the field at the `path` of a `message`."""
    *above, name = path.split(".")
    for each in above:
        message = vars(message).setdefault(each, SimpleNamespace())
    named = dict(zip(parts, numbers.tolist(), strict=True)) if parts else None
    setattr(message, name, numbers if named is None else SimpleNamespace(**named))


def _checks(run: RunData) -> dict[str, float]:
    """Greatest residual and closure of the run, by their names in the node's diagnostics."""
    found = {}
    if run.energy is not None:
        found["energy_residual_worst"] = np.max(np.abs(run.energy.residual))
    if run.closure_torque is not None and run.torque is not None and np.any(run.torque):
        found["closure_torque_relative"] = np.max(run.closure_torque) / np.max(np.abs(run.torque))
    return found


def _status(run: RunData, stamp: SimpleNamespace, text: str, values: dict[str, float]) -> SimpleNamespace:
    """One DiagnosticArray."""
    pairs = {"law": run.law.name, "accuracy": run.accuracy.name} | {
        name: f"{value:.9g}" for name, value in values.items()
    }
    entries = [SimpleNamespace(key=key, value=value) for key, value in pairs.items()]
    status = SimpleNamespace(name="/simulate", level=0, message=text, values=entries)
    return SimpleNamespace(header=SimpleNamespace(stamp=stamp), status=[status])


def _stamp(time: float) -> SimpleNamespace:
    seconds, nanoseconds = divmod(round(time * SECOND), SECOND)
    return SimpleNamespace(sec=seconds, nanosec=nanoseconds)
