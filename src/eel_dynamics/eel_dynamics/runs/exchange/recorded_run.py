# SPDX-License-Identifier: Apache-2.0
"""Makes the fields of a run from the messages of a node: the reverse of `messages_of_run`.

What messages do not carry is computed from them: the head's acceleration by splines in time, the centre of mass by
splines along the body.
"""

import os
import warnings
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from eel_base.files.input_file import reading
from eel_base.quantity import checked_instance, is_finite
from eel_base.topics import ENERGY_FIELDS, LATER_ENERGY_FIELDS
from eel_base.wording import one_line, shown
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import SECTION_COLUMN, Term
from eel_model.body.body import Body, checked_body
from eel_model.body.grid import Grid
from eel_model.body.moments import with_moments
from eel_model.body.panels import panels_of
from eel_model.robot.robot import Robot, checked_robot, robot_of
from eel_model.scene import Scene

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.budget import Budget
from eel_dynamics.runs.exchange.eel_viz_functions import messages_of_bag
from eel_dynamics.simulation.energy import WORKS, EnergyLedger

NEEDED = ("head_pose", "head_twist", "backbone", "curvature")
FURTHER = ("internal_wrench", "hydrodynamic_load", "energy", "fin_states")
OF_JOINTS = ("joint_states", "motor_states")
ENDS = ("tail_force", "nose_force", "wake_momentum_rate")
FEWEST = 4  # samples, for splines through them
AXIS_OF_NUMBER = {column + 1: name for name, column in SECTION_COLUMN.items()}  # as in CurvatureTerm


def fields_of_bag(
    path, namespace: str | None, body: Body | None, scene: Scene | None, robot: Robot | str | None = None
) -> dict:
    """The fields of `Run.from_bag`, whose arguments these are. `ValueError` and `ImportError` as there."""
    if body is not None:
        checked_body(body)
    if scene is not None:
        checked_instance("scene", scene, Scene)
    found = checked_robot(robot_of(robot) if isinstance(robot, str) else robot)
    messages = messages_of_bag()
    try:
        with reading(""):
            return fields_of_messages(messages(path, namespace), body, scene, found)
    except ValueError as error:
        named = "" if shown(os.fspath(path)) in str(error) else f"bag {shown(os.fspath(path))} holds no run: "
        raise ValueError(one_line(f"{named}{error}")) from None


def fields_of_messages(
    messages: Iterable[tuple[str, object]], body: Body | None, scene: Scene | None, robot: Robot | None = None
) -> dict:
    """The fields of the `Run` that `messages` (topic and message) tell of.

    body, scene, robot: what the messages do not tell; None for the body of the topic `body`, `Scene()` and no robot.
    `ValueError` where topics are missing.
    """
    once, samples = _collected(messages)
    missing = [topic for topic in NEEDED if not samples[topic]]
    if missing:
        raise ValueError(f"there is no message on {', '.join(missing)}, which a run needs")
    further = [topic for topic in FURTHER if samples[topic]]
    if robot is not None and robot.joints:
        further += [topic for topic in OF_JOINTS if samples[topic]]
        if OF_JOINTS[0] not in further:
            raise ValueError(f"there is no message on {OF_JOINTS[0]}, which a run of a robot needs")
    stamps = sorted(set.intersection(*(set(samples[topic]) for topic in (*NEEDED, *further))))
    if len(stamps) < FEWEST:
        raise ValueError(f"there must be {FEWEST} instants or more with a message on each topic, got {len(stamps)}")
    rows = {topic: [samples[topic][stamp] for stamp in stamps] for topic in (*NEEDED, *further)}
    scene = replace(
        Scene() if scene is None else scene, internal_wrench="internal_wrench" in rows, ledger="energy" in rows
    )
    found: dict[str, Any] = {"time": 1e-9 * np.array(stamps), "law": _law(once), "scene": scene}
    found["accuracy"] = _accuracy(once, scene)
    found |= _motion(rows, found["time"]) | ({} if robot is None else _joints(rows, robot))
    found["body"] = _body(once, scene) if body is None else body
    found["center_of_mass"] = _center_of_mass(found["body"], found["x"], found["backbone"])
    found |= dict.fromkeys(("closure_torque", "closure_force")) | dict.fromkeys(("steps", "evaluations", "nodes"), 0)
    if "fin_states" in rows:
        found["fin_angle"] = np.array([each.position for each in rows["fin_states"]])
    return found | _wrench(rows) | _load(rows) | {"energy": _energy(rows, found["time"])}


def _collected(messages) -> tuple[dict, dict]:
    """Messages of topics that come once (the last, all laws), and by topic those of the samples by stamp [ns].

    Of several of one stamp, as a node sends them that waits at its start, the last counts.
    """
    once: dict[str, Any] = {"curvature_law": []}
    samples: dict[str, dict[int, Any]] = {topic: {} for topic in (*NEEDED, *FURTHER, *OF_JOINTS)}
    for topic, message in messages:
        if topic == "curvature_law":
            once[topic].append(message)
        elif topic in samples:
            stamp = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
            poses = samples["head_pose"]
            if topic == "head_pose" and poses and stamp < next(reversed(poses)):
                warnings.warn(f"time falls back to {1e-9 * stamp:g} s: a reset; the run has what follows", stacklevel=4)
                samples = {name: {} for name in samples}
            samples[topic][stamp] = message
        else:
            once[topic] = message
    return once, samples


def _joints(rows: dict, robot: Robot) -> dict:
    """The joints' arrays. No message tells the angle of a motor behind a series spring, nor how tails bend."""
    found: dict[str, Any] = {"robot": robot}
    if not robot.joints:
        return found
    names = [joint.name for joint in robot.joints]
    columns = []
    for message in rows["joint_states"]:
        missing = [name for name in names if name not in message.name]
        if missing:
            raise ValueError(f"joint_states must have the robot's joints, got none of {', '.join(missing)}")
        columns.append([list(message.name).index(name) for name in names])
    for name, field in (("joint_angle", "position"), ("joint_rate", "velocity"), ("joint_torque", "effort")):
        messages = zip(rows["joint_states"], columns, strict=True)
        found[name] = np.array([np.array(getattr(message, field))[column] for message, column in messages])
    if "motor_states" in rows:  # in the order of the robot's joints
        for name, field in (("motor_torque", "torque"), ("motor_power", "power")):
            found[name] = np.array([getattr(message, field) for message in rows["motor_states"]], dtype=float)
    if all(servo is None or servo.series_stiffness is None for servo in robot.servos):
        found["motor_angle"] = found["joint_angle"]
    return found


def _motion(rows: dict, time: np.ndarray) -> dict:
    pose = [message.pose for message in rows["head_pose"]]
    twist = [message.twist for message in rows["head_twist"]]
    angular = _numbers((each.angular for each in twist), "xyz")
    linear = _numbers((each.linear for each in twist), "xyz")
    whole = np.concatenate((angular, linear), axis=1)
    rate = _spline(time, whole)(time, 1)
    rate[:, 3:] += np.cross(angular, linear)
    x = np.array(rows["backbone"][0].x, dtype=float)
    bend = {name: np.array([getattr(each, name) for each in rows["curvature"]]) for name in ("pitch", "yaw")}
    bend |= {f"{name}_rate": np.array([getattr(each, f"{name}_rate") for each in rows["curvature"]]) for name in bend}
    straight = np.zeros_like(bend["pitch"])
    return {
        "position": _numbers((each.position for each in pose), "xyz"),
        "orientation": _numbers((each.orientation for each in pose), "xyzw"),
        "twist": whole,
        "head_acceleration": rate,
        "x": x,
        "backbone": _along(rows["backbone"], "position", len(x), 3),
        "section_orientation": _along(rows["backbone"], "orientation", len(x), 4),
        "curvature": np.stack((straight, bend["pitch"], bend["yaw"]), axis=2),
        "curvature_rate": np.stack((straight, bend["pitch_rate"], bend["yaw_rate"]), axis=2),
    }


def _wrench(rows: dict) -> dict:
    names = ("torque", "force")
    if "internal_wrench" not in rows:
        return dict.fromkeys(names)
    return {name: _by_axes(rows["internal_wrench"], name) for name in names}


def _load(rows: dict) -> dict:
    if "hydrodynamic_load" not in rows:
        return dict.fromkeys(("fluid_force", "resistive_force", *ENDS))
    load = rows["hydrodynamic_load"]
    ends = dict.fromkeys(ENDS) | {  # an older bag has no wake_momentum_rate
        name: _numbers((getattr(each, name) for each in load), "xyz") for name in ENDS if hasattr(load[0], name)
    }
    found = {"fluid_force": _by_axes(load, "force"), "resistive_force": _by_axes(load, "resistive"), **ends}
    if "fin_states" in rows and hasattr(load[0], "fin_force"):
        found["fin_force"] = _along(load, "fin_force", len(rows["fin_states"][0].position), 3)
    return found


def _energy(rows: dict, time: np.ndarray) -> EnergyLedger | None:
    """The ledger. An older bag has no powers of flow and fins, and no works: they are those since its first sample."""
    if "energy" not in rows:
        return None
    older = not hasattr(rows["energy"][0], "drag_work")
    ledger = dict.fromkeys(LATER_ENERGY_FIELDS, np.zeros_like(time)) | {
        name: np.array([getattr(each, name) for each in rows["energy"]])
        for name in ENERGY_FIELDS
        if not (older and name in LATER_ENERGY_FIELDS)
    }
    if older:
        for part in WORKS:
            total = _spline(time, ledger[f"{part}_power"]).antiderivative()
            ledger[f"{part}_work"] = total(time) - total(time[0])
    return EnergyLedger(**ledger)


def _law(once: dict) -> Law:
    """The last law, in the time of the simulation."""
    laws = once["curvature_law"]
    if not laws:
        warnings.warn("there is no message on curvature_law: the run's law is the straight body's", stacklevel=4)
        return Law(name="unknown")
    if len(laws) > 1:
        warnings.warn(f"there are {len(laws)} laws: the run's law is the last one", stacklevel=4)
    message = laws[-1]
    origin = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
    law = Law(*map(_term, message.terms), name=message.name, transition=message.transition)
    return law.delayed(origin)


def _term(term) -> Term:
    ramps = (Ramp(ramp.start, ramp.end, ramp.delta, getattr(ramp, "factor", 0)) for ramp in term.envelope)
    return Term(
        axis=AXIS_OF_NUMBER[term.axis],
        amplitude=tuple(term.amplitude),
        knots=tuple(term.knots),
        wavelength=term.wavelength,
        period=term.period,
        phase=term.phase,
        envelope=tuple(ramps),
    )


def _body(once: dict, scene: Scene) -> Body:
    """The body of the topic `body`: its half-axes at the points of the message, its mass at the scene's density."""
    message = once.get("body")
    if message is None:
        raise ValueError("there is no message on body: give the body")
    x, width, height = (np.array(getattr(message, name), dtype=float) for name in ("x", "half_width", "half_height"))
    body = Body(x=x, half_width=width, half_height=height, name="bag")
    return body.changed(density=message.mass / body.volume) if is_finite(message.mass) and message.mass > 0.0 else body


def _accuracy(once: dict, scene: Scene) -> Accuracy:
    """The accuracy that the diagnostics name, or `standard`."""
    statuses = getattr(once.get("diagnostics"), "status", ())
    names = [pair.value for status in statuses for pair in status.values if pair.key == "accuracy"]
    try:
        wanted = Accuracy.of(names[-1] if names else "standard")
    except ValueError as error:
        warnings.warn(f"the accuracy is not known: {one_line(error)}", stacklevel=4)
        wanted = Accuracy.of("standard")
    return (Accuracy.of("standard") if isinstance(wanted, Budget) else wanted).in_scene(scene)


def _center_of_mass(body: Body, x: np.ndarray, backbone: np.ndarray) -> np.ndarray:
    """(T, 3) [m], from the backbone (T, M, 3) [m] at the stations x (M,) [m]."""
    grid = Grid.of(panels_of(body, resolution=40))
    areas = with_moments(lambda at: body.half_width(at)[None] * body.half_height(at), grid, body.breaks)
    weight = grid.weight * areas[0]
    inside = np.clip(grid.x, x[0], x[-1])
    return np.einsum("n,tnk->tk", weight / weight.sum(), _spline(x, backbone, axis=1)(inside))


def _spline(x: np.ndarray, values: np.ndarray, axis: int = 0):
    from scipy.interpolate import CubicSpline

    return CubicSpline(x, values, axis=axis)


def _numbers(parts, names: str) -> np.ndarray:
    return np.array([[getattr(each, name) for name in names] for each in parts], dtype=float)


def _along(messages: list, name: str, stations: int, size: int) -> np.ndarray:
    return np.array([np.reshape(getattr(each, name), (stations, size)) for each in messages], dtype=float)


def _by_axes(messages: list, name: str) -> np.ndarray:
    return np.array([np.stack([getattr(each, f"{name}_{axis}") for axis in (1, 2, 3)], axis=-1) for each in messages])
