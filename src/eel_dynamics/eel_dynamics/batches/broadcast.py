# SPDX-License-Identifier: Apache-2.0
"""Checks the arguments of `simulate_batch`, and broadcasts them to its swimmers."""

from typing import Any

import numpy as np
from eel_common.quantity import checked_instance, checked_row, numbers
from eel_common.wording import shown

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.motions import LAWS
from eel_dynamics.runs.storage.run_contents import OF_EACH
from eel_dynamics.runs.swim import Swim

KINDS: dict[str, Any] = {
    "laws": LAWS,
    "bodies": Body,
    "scenes": Scene,
    "flows": (Flow, type(None)),
    "robots": (Robot, type(None)),
}
STATES = {"positions": 3, "orientations": 4, "twists": 6}  # sizes of rows
ONE = {several: one for one, several in OF_EACH.items()} | {name: name[:-1] for name in STATES}


def swims_of(shared: dict[str, Any], accuracy: Any, parts: dict[str, Any], **given: Any) -> list[Swim]:
    """The B swims from these arguments of `simulate_batch`, with the `shared` fields of a `Swim`.

    parts: fins and wrenches; given: the others of `KINDS` and `STATES`.

    A value is for all swimmers, or a sequence of B values (for `STATES` the rows of an array (B, .)). A sequence of
    length 1 counts as one for all. `ValueError` names a bad argument and the swimmer's number.
    """
    accuracy = accuracy.tolist() if isinstance(accuracy, np.ndarray) else accuracy
    own_bodies = {"bodies": [None]} if given["bodies"] is None else {}  # the robots', or the paper's
    kinds = {name: kind for name, kind in KINDS.items() if name not in own_bodies}
    Swim(**{name: value for name, value in shared.items() if name != "stations"})  # their errors name no swimmer
    rows = _broadcast(
        own_bodies
        | {name: _several(name, given[name], kind) for name, kind in kinds.items()}
        | {"accuracy": [*map(Accuracy.of, accuracy if isinstance(accuracy, (list, tuple)) else [accuracy])]}
        | {name: _lists(each) for name, each in parts.items()}
        | {name: _rows(name, given[name], size) for name, size in STATES.items()}
    )
    swims = []
    for index, row in enumerate(zip(*rows.values(), strict=True)):
        own = {ONE.get(name, name): each for name, each in zip(rows, row, strict=True)}
        try:
            swims.append(Swim.of(**shared, **own))
        except ValueError as error:
            raise ValueError(f"swimmer {index}: {error}") from None
    return swims


def _broadcast(given: dict[str, list]) -> dict[str, list]:
    count = max((len(values) for values in given.values() if len(values) != 1), default=1)
    longest = next((name for name, values in given.items() if len(values) == count), "")
    for name, values in given.items():
        if len(values) == 0:
            raise ValueError(f"{name} must hold one or more, got none")
        if len(values) not in (1, count):
            raise ValueError(f"{name} must be one, or as many as {longest} ({count}), got {len(values)}")
    return {name: values * count if len(values) == 1 else values for name, values in given.items()}


def _several(name: str, values, kind: type | tuple[type, ...]) -> list:
    values = [values] if isinstance(values, kind) else values
    try:
        values = list(values)
    except TypeError:
        one = kind[0] if isinstance(kind, tuple) else kind
        raise ValueError(f"{name} must be a {one.__name__} or a sequence of them, got {shown(values)}") from None
    return [checked_instance(f"{name}[{index}]", value, kind) for index, value in enumerate(values)]


def _lists(parts) -> list:
    """The parts of each swimmer. If all items are lists or None, each is one swimmer's; pairs of fins are tuples."""
    several = isinstance(parts, (list, tuple)) and parts and all(isinstance(each, (list, type(None))) for each in parts)
    return list(parts) if several else [parts]


def _rows(name: str, values, size: int) -> list[np.ndarray]:
    array = numbers(name, values)
    if array.ndim == 1:
        return [checked_row(name, array, size)]
    return [checked_row(f"{name}[{index}]", row, size) for index, row in enumerate(np.atleast_1d(array))]
