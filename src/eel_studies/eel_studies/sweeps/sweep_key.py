# SPDX-License-Identifier: Apache-2.0
"""The key of a sweep: a hash of its arguments, and of the software's version."""

import hashlib
import inspect
import sys
from typing import Any

import numpy as np
from eel_common.version import VERSION
from eel_common.wording import shown
from eel_dynamics.model.body.body import DRAGS, MASSES, PROFILES, Body
from eel_dynamics.model.body.shapes import NamedHalfAxis
from eel_dynamics.model.flow.flow import Flow, parts_of
from eel_dynamics.model.flow.functions import FlowField
from eel_dynamics.model.flow.plain import plain_of_flow
from eel_dynamics.model.robot.actuators import Torque
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.runs.storage.plain import plain_of, plain_robot
from eel_dynamics.runs.storage.tables import needed
from eel_dynamics.runs.swim import Swim

from eel_studies.points import Measure


def key_of(points: list[Swim], measure: Measure | tuple[str, ...]) -> str:
    """The key, 32 hexadecimal digits.

    It is a hash of the points, the measure's code and closure, and the software's version.
    `ValueError` for a function that cannot be hashed.
    """
    content = hashlib.sha256(VERSION.encode())
    content.update(_content_of_function("measure", measure) if callable(measure) else repr(measure).encode())
    bodies = {}
    for point in points:
        if id(point.body) not in bodies:
            bodies[id(point.body)] = _content_of_body(point.body)
        content.update(bodies[id(point.body)])
        own = plain_of(point.law), point.scene, point.accuracy, point.duration, point.sample_period
        how = point.estimate, point.load, point.most_evaluations, point.sensors, point.default_transition
        content.update(repr((own, how)).encode())
        content.update(np.asarray(point.stations, dtype=float).tobytes())
        content.update(_content_of_flow(point.flow) + repr(point.fins).encode())
        content.update(repr(plain_of(point.wrenches)).encode() if point.wrenches else b"")
        content.update(_content_of_robot(point.robot, point.body))
        content.update(np.concatenate(point.start).tobytes())
    return content.hexdigest()[:32]


def _content_of_function(argument: str, function: Any) -> bytes:
    """The code and closure of `function`, with its module's whole file if that can be imported.

    `ValueError` names an argument whose function cannot be hashed.
    """
    if isinstance(function, NamedHalfAxis):
        return repr(function).encode()
    needed("dask", f"the key of a sweep with a {argument} of your own")
    from dask.tokenize import TokenizationError, tokenize

    try:
        content = tokenize(function, ensure_deterministic=True)
    except TokenizationError:
        raise ValueError(
            f"{argument} must be a function that worker processes can be given, got {shown(function)}"
        ) from None
    home = sys.modules.get(getattr(function, "__module__", None) or "")
    if home is not None and home.__name__ != "__main__" and getattr(home, "__file__", None):
        content += inspect.getsource(home)
    return content.encode()


def _content_of_robot(robot: Robot | None, body: Body) -> bytes:
    """The robot's numbers, with the code of torques given as functions."""
    content = b""
    for joint in robot.joints if robot is not None else ():
        if isinstance(joint.actuator, Torque) and joint.actuator.time is None:
            content += _content_of_function(f"joint {joint.name} torque", joint.actuator.torque)
            robot = robot.changed(joint.name, actuator=None) if robot is not None else None
    return content + repr(plain_robot(robot, body)).encode()


def _content_of_flow(flow: Flow | None) -> bytes:
    """The flow's numbers, and the functions of a `FlowField`."""
    content = repr(plain_of_flow(flow)).encode()
    for part in () if flow is None else parts_of(flow):
        for name in ("function", "jacobian", "rate") if isinstance(part, FlowField) else ():
            if (function := getattr(part, name)) is not None:
                content += _content_of_function(f"flow {name}", function)
    return content


def _content_of_body(body: Body) -> bytes:
    """The body's numbers, half-axes, and their values at 201 points, as a function may depend on other data."""
    x = np.linspace(0.0, body.length, 201)
    numbers = body.length, body.density, *body.nose, body.nose_added_mass, body.nose_drag
    drags = [getattr(body, name) for name in DRAGS]
    content = np.concatenate((body.half_width(x), body.half_height(x), body.kinks, numbers, drags)).tobytes()
    content += repr((body.blunt_nose, body.link_length, body.appendages)).encode()
    masses = {name: body.arguments[name] for name in MASSES if np.any(body.arguments[name])}
    for name in masses:
        content += np.asarray(getattr(body, name)(x)).tobytes()
    content += np.concatenate((*body.cross_flow(x), *body.added_mass_factors(x))).tobytes()
    given_along = masses | {name: body.arguments[name] for name in PROFILES}
    of_functions = {name: given for name, given in given_along.items() if callable(given)}
    for name, given in (body.half_axes | of_functions).items():
        content += given.tobytes() if isinstance(given, np.ndarray) else _content_of_function(f"body {name}", given)
    return content
