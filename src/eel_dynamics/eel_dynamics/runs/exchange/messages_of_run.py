# SPDX-License-Identifier: Apache-2.0
"""Converts a run to the messages that the node would publish: same topics and fields, as plain objects without ROS."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
from eel_base.topics import ENERGY_FIELDS
from eel_model.fins.fins import SIDES
from eel_model.flow.lattice import lattice_around, velocities_at
from eel_model.robot.actuators import most_torque
from eel_model.robot.part import AXES

SECOND = 1_000_000_000  # ns


def messages_of_run(run) -> Iterator[tuple[str, SimpleNamespace]]:
    """Yield topic and message in the order of time: body and law, then all samples, then the diagnostics."""
    run = run.in_axes("rep103")
    start, end = (_stamp(run.time[k]) for k in (0, -1))
    yield "body", _body_of(run)
    yield "curvature_law", SimpleNamespace(name=run.law.name)
    yield "diagnostics", _status(run, start, "computed", {})
    for k, time in enumerate(run.time):
        header = SimpleNamespace(stamp=_stamp(time))
        for topic, fields in _sample(run, k).items():
            yield topic, SimpleNamespace(header=header, **fields)
    yield "diagnostics", _status(run, end, "computed", _checks(run))


def outline(body, x: np.ndarray) -> dict[str, np.ndarray]:
    """Abscissae and half axes of the body [m], each (N,), by the field names of BodyGeometry.

    The abscissae are `x` (M,) [m] and points in between, which are denser at the nose.
    """
    x = np.array(sorted({*x, *(body.length * np.linspace(0.0, 1.0, 101) ** 2)}))
    return {
        "x": x,
        "half_width": np.asarray(body.half_width(x), dtype=float),
        "half_height": np.asarray(body.half_height(x), dtype=float),
    }


def fields_of_fins(fins) -> list[dict[str, Any]]:
    """The fields of a FinGeometry of each of the `fins`."""
    own = ("name", "station", "area", "span", "dihedral")
    return [{"side": int(SIDES[fin.side]), **{name: getattr(fin, name) for name in own}} for fin in fins]


def fields_of_joints(robot) -> list[dict[str, Any]]:
    """The fields of a JointGeometry of each joint of the `robot`; none without one."""
    joints = () if robot is None else robot.joints
    return [{"name": joint.name, "station": joint.position, "axis": AXES[joint.axis][0] + 1} for joint in joints]


def _body_of(run) -> SimpleNamespace:
    """The body as a BodyGeometry."""
    return SimpleNamespace(
        length=float(run.body.length),
        mass=float(run.body_mass),
        **outline(run.body, run.x),
        fins=[SimpleNamespace(**fields) for fields in fields_of_fins(run.fins)],
        joints=[SimpleNamespace(**fields) for fields in fields_of_joints(run.robot)],
    )


def _sample(run, k: int) -> dict[str, dict]:
    """Fields of each topic at sample `k`."""
    pose = SimpleNamespace(
        position=_named("xyz", run.position[k]),
        orientation=_named("xyzw", run.orientation[k]),
    )
    twist = SimpleNamespace(angular=_named("xyz", run.twist[k, :3]), linear=_named("xyz", run.twist[k, 3:]))
    curvature, rate = run.curvature[k], run.curvature_rate[k]
    found = {
        "head_pose": {"pose": pose},
        "head_twist": {"twist": twist},
        "odom": {"pose": SimpleNamespace(pose=pose), "twist": SimpleNamespace(twist=twist)},
        "backbone": {
            "x": run.x,
            "position": run.backbone[k].ravel() + 0.0,
            "orientation": run.section_orientation[k].ravel() + 0.0,
        },
        "curvature": {
            "x": run.x,
            "pitch": curvature[:, 1],
            "pitch_rate": rate[:, 1],
            "yaw": curvature[:, 2],
            "yaw_rate": rate[:, 2],
        },
    }
    if run.torque is not None:
        found["internal_wrench"] = {"x": run.x, **_by_axis(torque=run.torque[k], force=run.force[k])}
    if run.fluid_force is not None:
        found["hydrodynamic_load"] = {
            "x": run.x,
            **_by_axis(force=run.fluid_force[k], resistive=run.resistive_force[k]),
            "tail_force": _named("xyz", run.tail_force[k]),
            "nose_force": _named("xyz", run.nose_force[k]),
            "fin_force": np.zeros(0) if run.fin_force is None else run.fin_force[k].ravel(),
        }
        if run.wake_momentum_rate is not None:  # a file of an older version has none
            found["hydrodynamic_load"]["wake_momentum_rate"] = _named("xyz", run.wake_momentum_rate[k])
    if run.fin_angle is not None:
        found["fin_states"] = {"name": [fin.name for fin in run.fins], "position": run.fin_angle[k]}
    if run.flow is not None:
        points = lattice_around(run.backbone[k].mean(axis=0), run.body.length, run.flow)
        velocity = velocities_at(run.flow, points, run.time[k]) + run.scene.current
        found["flow_vectors"] = {"position": points.ravel(), "velocity": velocity.ravel()}
    if run.fin_angle is not None:
        found["fin_states"] = {"name": [fin.name for fin in run.fins], "position": run.fin_angle[k]}
    if run.joint_angle is not None and run.robot.joints:
        rows = {"position": run.joint_angle[k], "velocity": run.joint_rate[k], "effort": run.joint_torque[k]}
        found["joint_states"] = {"name": [joint.name for joint in run.robot.joints], **rows}
        torque, power = run.motor_torque[k], run.motor_power[k]
        limit = most_torque(run.robot.servos, torque, power)
        found["motor_states"] = {"torque": torque, "limit": limit, "power": power}
    if run.energy is not None:
        found["energy"] = {name: float(run.energy[name][k]) for name in ENERGY_FIELDS}
    return found


def _checks(run) -> dict[str, float]:
    """Greatest residual and closure of the run, by their names in the node's diagnostics."""
    found = {}
    if run.energy is not None:
        found["energy_residual_worst"] = np.max(np.abs(run.energy.residual))
    if run.closure_torque is not None and np.any(run.torque):
        found["closure_torque_relative"] = np.max(run.closure_torque) / np.max(np.abs(run.torque))
    return found


def _status(run, stamp: SimpleNamespace, text: str, values: dict[str, float]) -> SimpleNamespace:
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


def _named(names: str, values: np.ndarray) -> SimpleNamespace:
    return SimpleNamespace(**dict(zip(names, (values + 0.0).tolist(), strict=True)))  # + 0.0: no minus zero


def _by_axis(**vectors: np.ndarray) -> dict[str, np.ndarray]:
    """name_1, name_2, name_3 (M,) of each vector (M, 3)."""
    return {f"{name}_{axis}": values[:, axis - 1] for name, values in vectors.items() for axis in (1, 2, 3)}
