# SPDX-License-Identifier: Apache-2.0
"""Makes the fields of a run from the messages of a node: the reverse of `messages_of_run`.

What messages do not carry is computed from them: the head's acceleration by splines in time, the centre of mass by
splines along the body.
"""

import os
import warnings
from collections.abc import Iterable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from eel_common.files.input_file import reading
from eel_common.quantity import checked_instance, is_finite
from eel_common.topics import ENERGY_FIELDS, LATER_ENERGY_FIELDS
from eel_common.wording import one_line, shown
from eel_gaits.laws.law import Law
from eel_gaits.laws.law_message import law_from_message

from eel_dynamics.accuracy.accuracy import STANDARD, Accuracy
from eel_dynamics.model.body.body import Body, checked_body
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.body.moments import with_moments
from eel_dynamics.model.body.panels import panels_of
from eel_dynamics.model.robot.joint_signs import message_sign, message_signs
from eel_dynamics.model.robot.robot import Robot, checked_robot, robot_of
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.exchange.eel_viz_functions import function_of_eel_viz
from eel_dynamics.runs.exchange.message_fields import FIELDS, OF_JOINTS, SIGNED, quantities_of
from eel_dynamics.simulation.energy import WORKS, EnergyLedger

NEEDED = ("head_pose", "head_twist", "backbone", "curvature")
FURTHER = ("internal_wrench", "hydrodynamic_load", "energy", "fin_states")
FEWEST = 4  # samples, for splines through them


def fields_of_bag(
    path: str | os.PathLike[str],
    namespace: str | None,
    body: Body | None,
    scene: Scene | None,
    robot: Robot | str | None = None,
) -> dict[str, Any]:
    """The fields of `Run.from_bag`, with the same arguments, `ValueError` and `ImportError`."""
    if body is not None:
        checked_body(body)
    if scene is not None:
        checked_instance("scene", scene, Scene)
    found = checked_robot(robot_of(robot) if isinstance(robot, str) else robot)
    messages = function_of_eel_viz("messages")
    try:
        with reading(""):
            joints = () if found is None else found.joints
            turned = None if found is None else {each.name for each in joints if message_sign(each.axis) < 0}
            return fields_of_messages(messages(path, namespace, turned), body, scene, found)
    except ValueError as error:
        named = "" if shown(os.fspath(path)) in str(error) else f"bag {shown(os.fspath(path))} holds no run: "
        raise ValueError(one_line(f"{named}{error}")) from None


def fields_of_messages(
    messages: Iterable[tuple[str, object]], body: Body | None, scene: Scene | None, robot: Robot | None = None
) -> dict[str, Any]:
    """The fields of the `Run` in `messages` (pairs of topic and message).

    body, scene, robot: they are not in the messages; None: the body of the topic `body`, `Scene()`, no robot.
    `ValueError` if topics are missing.
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
    for topic in OF_JOINTS:
        if (
            topic in rows and robot is not None and hasattr(rows[topic][0], "name")
        ):  # an older motor_states has no names
            rows[topic] = [_in_order(topic, message, robot) for message in rows[topic]]
    scene = replace(
        Scene() if scene is None else scene, internal_wrench="internal_wrench" in rows, ledger="energy" in rows
    )
    found: dict[str, Any] = {"time": 1e-9 * np.array(stamps), "law": _law(once), "scene": scene}
    found["accuracy"] = _accuracy(once, scene)
    found["x"] = np.array(rows["backbone"][0].x, dtype=float)
    fins = len(rows["fin_states"][0].position) if "fin_states" in rows else 0
    joints = 0 if robot is None else len(robot.joints)
    found |= quantities_of(rows, station=len(found["x"]), fin=fins, joint=joints)
    found |= {name: found[name] * message_signs(robot) + 0.0 for name in SIGNED if found[name] is not None}
    # No message holds the angle of a motor behind a series spring, or the bending of tails.
    stiff = robot is not None and not any(servo and servo.has_spring for servo in robot.servos)
    found |= {"robot": robot, "motor_angle": found["joint_angle"] if stiff else None}
    found["head_acceleration"] = _acceleration(found["time"], found["twist"])
    found["body"] = _body(once, scene) if body is None else body
    found["center_of_mass"] = _center_of_mass(found["body"], found["x"], found["backbone"])
    found |= dict.fromkeys(("closure_torque", "closure_force")) | dict.fromkeys(("steps", "evaluations", "nodes"), 0)
    return found | {"energy": _energy(rows, found["time"])}


def _collected(messages: Iterable[tuple[str, Any]]) -> tuple[dict[str, Any], dict[str, dict[int, Any]]]:
    """Messages of topics that come once (the last one; of laws all), and for each topic the samples by stamp [ns].

    The last of several messages with one stamp counts: a node that waits at its start repeats them.
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
                warnings.warn(f"time falls back to {1e-9 * stamp:g} s: a reset; the run has what follows", stacklevel=5)
                samples = {name: {} for name in samples}
            samples[topic][stamp] = message
        else:
            once[topic] = message
    return once, samples


def _in_order(topic: str, message: Any, robot: Robot) -> Any:
    """A message of joints, sorted in the robot's order. `ValueError` if a joint is missing."""
    missing = [joint.name for joint in robot.joints if joint.name not in message.name]
    if missing:
        raise ValueError(f"{topic} must have the robot's joints, got none of {', '.join(missing)}")
    order = [list(message.name).index(joint.name) for joint in robot.joints]
    names = FIELDS[topic]
    return SimpleNamespace(**{name: np.array(getattr(message, name))[order] for name in names})


def _acceleration(time: np.ndarray, twist: np.ndarray) -> np.ndarray:
    """(T, 6), by splines through the head's `twist` (T, 6) at `time` (T,) [s]."""
    rate = _spline(time, twist)(time, 1)
    rate[:, 3:] += np.cross(twist[:, :3], twist[:, 3:])
    return np.asarray(rate)


def _energy(rows: dict[str, list[Any]], time: np.ndarray) -> EnergyLedger | None:
    """The ledger. An older bag has fewer powers, or no works: these are integrated from its first sample."""
    if "energy" not in rows:
        return None
    first = rows["energy"][0]
    ledger = dict.fromkeys(LATER_ENERGY_FIELDS, np.zeros_like(time)) | {
        name: np.array([getattr(each, name) for each in rows["energy"]])
        for name in ENERGY_FIELDS
        if hasattr(first, name) or name not in LATER_ENERGY_FIELDS
    }
    if not hasattr(first, "drag_work"):
        for part in WORKS:
            total = _spline(time, ledger[f"{part}_power"]).antiderivative()
            ledger[f"{part}_work"] = total(time) - total(time[0])
    return EnergyLedger(**ledger)


def _law(once: dict[str, Any]) -> Law:
    """The last law, in the time of the simulation."""
    laws = once["curvature_law"]
    if not laws:
        warnings.warn("there is no message on curvature_law: the run's law is the straight body's", stacklevel=5)
        return Law(name="unknown")
    if len(laws) > 1:
        warnings.warn(f"there are {len(laws)} laws: the run's law is the last one", stacklevel=5)
    message = laws[-1]
    origin = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
    return law_from_message(message).delayed(origin)


def _body(once: dict[str, Any], scene: Scene) -> Body:
    """The body of the topic `body`: its half-axes at the points of the message, its mass at the scene's density."""
    message = once.get("body")
    if message is None:
        raise ValueError("there is no message on body: give the body")
    x, width, height = (np.array(getattr(message, name), dtype=float) for name in ("x", "half_width", "half_height"))
    body = Body(x=x, half_width=width, half_height=height, name="bag")
    return body.changed(density=message.mass / body.volume) if is_finite(message.mass) and message.mass > 0.0 else body


def _accuracy(once: dict[str, Any], scene: Scene) -> Accuracy:
    """The accuracy that the diagnostics name, or `standard`."""
    statuses = getattr(once.get("diagnostics"), "status", ())
    names = [pair.value for status in statuses for pair in status.values if pair.key == "accuracy"]
    try:
        wanted = Accuracy.of(names[-1] if names else STANDARD)
    except ValueError as error:
        warnings.warn(f"the accuracy is not known: {one_line(error)}", stacklevel=5)
        wanted = Accuracy.of(STANDARD)
    return wanted.in_scene(scene)


def _center_of_mass(body: Body, x: np.ndarray, backbone: np.ndarray) -> np.ndarray:
    """(T, 3) [m], from the backbone (T, M, 3) [m] at the stations x (M,) [m]."""
    grid = Grid.of(panels_of(body, resolution=40))
    areas = with_moments(lambda at: body.half_width(at)[None] * body.half_height(at), grid, body.breaks)
    weight = grid.weight * areas[0]
    inside = np.clip(grid.x, x[0], x[-1])
    return np.asarray(np.einsum("n,tnk->tk", weight / weight.sum(), _spline(x, backbone, axis=1)(inside)))


def _spline(x: np.ndarray, values: np.ndarray, axis: int = 0) -> Any:
    from scipy.interpolate import CubicSpline

    return CubicSpline(x, values, axis=axis)
