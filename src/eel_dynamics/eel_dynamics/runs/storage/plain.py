# SPDX-License-Identifier: Apache-2.0
"""Laws, bodies, scenes, settings, flows, fins, wrenches, errors and their estimates as values for JSON, and back.

A body whose half-axes are the user's functions is stored with polynomials through their squares, as no file holds code.
Everything else comes back equal.
"""

import warnings
from base64 import b64decode, b64encode
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.accuracy import ANY, Accuracy
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.model.body.appendages import Appendage, plain_appendages
from eel_dynamics.model.body.body import MASSES, PROFILES, Body
from eel_dynamics.model.body.links import LinkHalfAxis
from eel_dynamics.model.body.shapes import (
    NamedHalfAxis,
    PolynomialAlong,
    PolynomialHalfAxis,
    coefficients_of,
    polynomials_through,
)
from eel_dynamics.model.fins.fins import Fin, RollHold
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.flow.plain import flow_of, plain_of_flow
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.robot.robot_file import plain_of_robot, robot_arguments
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench, plain_wrench
from eel_dynamics.simulation.stopping import SimulationStopped

HALF_AXES = ("half_width", "half_height")
FUNCTIONS = {"named": NamedHalfAxis, "polynomial": PolynomialHalfAxis, "links": LinkHalfAxis}
ROWS, OF_ROWS = ("time", "x", "values"), ("name", "transition", "about")  # arrays of a `SampledLaw`; its other fields
OF_STOP = "time", "quantity", "value", "hint"  # arguments of `SimulationStopped`
AS_EXACT = 1e-9  # of the body's length: a larger error of a half-axis's polynomial causes a warning


def plain_of(value: Any) -> Any:
    """A field of a run, or an error, as plain values; a tuple as a list; None unchanged.

    The rows of a `SampledLaw` become text: numbers of 8 bytes in base 64. A half-axis that no polynomial represents to
    `AS_EXACT` causes a warning.
    """
    if value is None:
        return None
    if isinstance(value, SampledLaw):
        rows = {name: b64encode(getattr(value, name).astype("<f8").tobytes()).decode() for name in ROWS}
        return {"rows": rows, "points": len(value.x)} | {name: getattr(value, name) for name in OF_ROWS}
    if isinstance(value, Body):
        return _plain_body(value)
    if isinstance(value, Flow):
        return plain_of_flow(value)
    if isinstance(value, ExternalWrench):
        return plain_wrench(value)
    if isinstance(value, tuple):
        return [plain_of(each) for each in value]
    if isinstance(value, SimulationStopped):
        return {name: getattr(value, name) for name in (*OF_STOP, "diverged")}
    return asdict(value)


def law_of(plain: dict[str, Any]) -> Law | SampledLaw:
    """The law from its plain values."""
    if "rows" in plain:
        rows: dict[str, Any] = {name: np.frombuffer(b64decode(text), "<f8") for name, text in plain["rows"].items()}
        rows["values"] = rows["values"].reshape(-1, 2, 3, plain["points"])
        return SampledLaw(**rows, **{name: plain[name] for name in OF_ROWS})
    terms = [Term(**term | {"envelope": tuple(Ramp(**ramp) for ramp in term["envelope"])}) for term in plain["terms"]]
    return Law(*terms, name=plain["name"], transition=plain["transition"])


def _plain_body(body: Body) -> dict[str, Any]:
    plain, bounds = body.arguments, (0.0, *body.panel_ends)
    for name, value in plain.items():
        if isinstance(value, np.ndarray):
            plain[name] = value.tolist()
        elif name in HALF_AXES:
            kind = next((kind for kind, each in FUNCTIONS.items() if type(value) is each), None)
            function = _polynomial(body, name) if kind is None else value
            plain[name] = {"kind": kind or "polynomial", **asdict(function)}
        elif name in (*MASSES, *PROFILES) and callable(value):
            plain[name] = asdict(PolynomialAlong(bounds, coefficients_of(value, bounds)))
        elif name == "appendages":
            plain[name] = plain_appendages(value)
    return plain


def body_of(plain: dict[str, Any]) -> Body:
    """The body from its plain values."""
    arguments = dict(plain)
    arguments["appendages"] = [Appendage(*row) for row in plain.get("appendages", ())]
    for name in (*HALF_AXES, *MASSES, *PROFILES):
        if isinstance(given := plain.get(name), dict):
            numbers = {key: _tuples(value) for key, value in given.items() if key != "kind"}
            kind = FUNCTIONS[given["kind"]] if name in HALF_AXES else PolynomialAlong
            arguments[name] = kind(**numbers)
    return Body(**arguments)


def plain_robot(robot: Robot | None, body: Body) -> dict[str, Any] | None:
    """A robot on its `body` as plain values; None unchanged. `ValueError` for a torque that is a function."""
    if robot is None:
        return None
    return {"parts": plain_of_robot(robot, body.length), "own_body": robot.body is not None}


def robot_of(plain: dict[str, Any] | None, body: Body) -> Robot | None:
    """The robot from its plain values."""
    if plain is None:
        return None
    return Robot(**robot_arguments(plain["parts"]) | {"body": body if plain["own_body"] else None})


def fins_of(plain: Sequence[dict[str, Any]] | None) -> tuple[Fin, ...]:
    """The fins from their plain values."""
    angles = (each["angle"] for each in plain or ())
    held = (RollHold(**angle) if isinstance(angle, dict) else angle for angle in angles)
    return tuple(Fin(**each | {"angle": angle}) for each, angle in zip(plain or (), held, strict=True))


def wrenches_of(plain: Sequence[dict[str, Any]] | None) -> tuple[ExternalWrench, ...]:
    """The wrenches from outside that have become plain values."""
    return tuple(ExternalWrench(**each) for each in plain or ())


def stop_of(plain: dict[str, Any] | None) -> SimulationStopped | None:
    """The error from its plain values."""
    if plain is None:
        return None
    error = SimulationStopped(*(plain[name] for name in OF_STOP))
    error.diverged = plain["diverged"]
    return error


def _settings(plain: dict[str, Any]) -> dict[str, Any]:
    """The settings of an accuracy. In an older file, a swimmer that did not begin has only the name of its budget."""
    return {"name": plain["budget"], "resolution": ANY} if "budget" in plain else plain


READERS: dict[str, Callable[[Any], Any]] = {  # field of a run: reader of its plain values
    "law": law_of,
    "body": body_of,
    "scene": lambda plain: Scene(**plain),
    "accuracy": lambda plain: Accuracy(**_settings(plain)),
    "error_estimate": lambda plain: plain and ErrorEstimate(**plain),
    "flow": flow_of,
    "fins": fins_of,
    "wrenches": wrenches_of,
}


def each_once(values: tuple[Any, ...]) -> dict[str, Any]:
    """A tuple of values, many of them equal, as plain values that store each once."""
    places = {value: place for place, value in enumerate(dict.fromkeys(values))}
    return {"values": [plain_of(value) for value in places], "places": [places[value] for value in values]}


def row_of(plain: Any, made: Callable[[Any], Any]) -> tuple[Any, ...]:
    """The tuple from the result of `each_once`, or from a list of plain values."""
    if not isinstance(plain, dict):
        return tuple(map(made, plain))
    values = [made(value) for value in plain["values"]]
    return tuple(values[place] for place in plain["places"])


def _polynomial(body: Body, name: str) -> PolynomialHalfAxis:
    found = polynomials_through(getattr(body, name), (0.0, *body.panel_ends), body.blunt_nose)
    x = np.linspace(0.0, body.length, 1001)
    missed = float(np.max(np.abs(found(x) - getattr(body, name)(x))))
    if missed > AS_EXACT * body.length:
        warnings.warn(
            f"body {name} is saved as a polynomial that misses it by up to {missed:.2g} m: name its kinks, or give "
            "arrays",
            stacklevel=5,
        )
    return found


def _tuples(value: Any) -> Any:
    return tuple(_tuples(each) for each in value) if isinstance(value, list) else value
