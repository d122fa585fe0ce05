# SPDX-License-Identifier: Apache-2.0
"""Checks the arguments of `simulate_batch`, and broadcasts them to its swimmers."""

from typing import Any

import numpy as np
from eel_base.quantity import checked_instance, checked_row, numbers, positive
from eel_base.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw
from eel_model.body.body import Body
from eel_model.flow.flow import Flow
from eel_model.initial_state import InitialState
from eel_model.robot.robot import Robot
from eel_model.scene import Scene

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.runs.motions import LAWS
from eel_dynamics.simulation.simulation_setup import SimulationSetup, check_planar_law, checked_stations

Swimmer = tuple[Law | SampledLaw, SimulationSetup]


def swimmers_of(
    laws,
    bodies,
    scenes,
    accuracy,
    stations,
    positions,
    orientations,
    twists,
    most_evaluations=MOST_EVALUATIONS,
    flows=None,
    robots=None,
    fins=None,
) -> list[Swimmer]:
    """Laws and set-ups of B swimmers, with `stations` on each body, and `most_evaluations` per simulated second.

    flows, robots, fins: None for none. Each other argument is one for all, or a sequence of B (for the last three the
    rows of an array (B, .)); a sequence of length 1 counts as one for all. `ValueError` names what does not fit, and
    the swimmer's number.
    """
    laws, bodies, scenes, settings, flows, robots, fins, *states = _broadcast(
        laws=_several("laws", laws, LAWS),
        bodies=_several("bodies", Body.boyer2010() if bodies is None else bodies, Body),
        scenes=_several("scenes", Scene() if scenes is None else scenes, Scene),
        accuracy=[Accuracy.of(each) for each in (accuracy if isinstance(accuracy, (list, tuple)) else [accuracy])],
        flows=[None] if flows is None else _several("flows", flows, (Flow, type(None))),
        robots=[None] if robots is None else _several("robots", robots, (Robot, type(None))),
        fins=_lists(fins),
        positions=_rows("positions", positions, 3),
        orientations=_rows("orientations", orientations, 4),
        twists=_rows("twists", twists, 6),
    )
    most = positive("most_evaluations", most_evaluations, "per simulated second")
    x = {length: checked_stations(stations, length) for length in dict.fromkeys(body.length for body in bodies)}
    names = "body", "scene", "accuracy", "flow", "robot", "fins"
    swimmers = []
    for index, (law, *own) in enumerate(zip(laws, bodies, scenes, settings, flows, robots, fins, strict=True)):
        more: dict[str, Any] = dict(zip(names, own, strict=True)) | {"stations": x[own[0].length]}
        more |= dict(zip(InitialState._fields, (rows[index] for rows in states), strict=True))
        swimmers.append(numbered(index, law, more | {"most_evaluations": most}))
    return swimmers


def numbered(index: int, law: Law | SampledLaw, arguments: dict[str, Any]) -> Swimmer:
    """Swimmer `index`, with its law and these `arguments` of `Simulation`. `ValueError` has its number."""
    try:
        setup = SimulationSetup.of(**arguments)
        check_planar_law(law, setup.scene)
    except ValueError as error:
        raise ValueError(f"swimmer {index}: {error}") from None
    return law, setup


def _broadcast(**given) -> list[list]:
    count = max((len(values) for values in given.values() if len(values) != 1), default=1)
    longest = next((name for name, values in given.items() if len(values) == count), "")
    for name, values in given.items():
        if len(values) == 0:
            raise ValueError(f"{name} must hold one or more, got none")
        if len(values) not in (1, count):
            raise ValueError(f"{name} must be one, or as many as {longest} ({count}), got {len(values)}")
    return [values * count if len(values) == 1 else values for values in given.values()]


def _several(name: str, values, kind: type | tuple[type, ...]) -> list:
    values = [values] if isinstance(values, kind) else values
    try:
        values = list(values)
    except TypeError:
        one = kind[0] if isinstance(kind, tuple) else kind
        raise ValueError(f"{name} must be a {one.__name__} or a sequence of them, got {shown(values)}") from None
    return [checked_instance(f"{name}[{index}]", value, kind) for index, value in enumerate(values)]


def _lists(fins) -> list:
    """The fins of each swimmer: where all items are lists, or None, each is one swimmer's; pairs are tuples."""
    several = isinstance(fins, (list, tuple)) and fins and all(isinstance(each, (list, type(None))) for each in fins)
    return list(fins) if several else [fins]


def _rows(name: str, values, size: int) -> list[np.ndarray]:
    array = numbers(name, values)
    if array.ndim == 1:
        return [checked_row(name, array, size)]
    return [checked_row(f"{name}[{index}]", row, size) for index, row in enumerate(np.atleast_1d(array))]
