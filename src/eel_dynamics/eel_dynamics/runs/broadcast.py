# SPDX-License-Identifier: Apache-2.0
"""Checks the arguments of `simulate` and `simulate_batch`, and broadcasts those of a batch to its swimmers."""

from typing import NamedTuple

import numpy as np
from eel_base.quantity import numbers
from eel_base.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.model.arguments import (
    check_planar,
    check_planar_law,
    checked_instance,
    checked_number,
    checked_quaternion,
    checked_row,
)
from eel_dynamics.model.body import Body, checked_body
from eel_dynamics.model.initial_state import InitialState
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.motions import LAWS


class SwimmerArguments(NamedTuple):
    """The arguments of one swimmer: law, body, scene, accuracy and initial state."""

    law: Law | SampledLaw
    body: Body
    scene: Scene
    accuracy: Accuracy
    position: np.ndarray  # (3,) m, head, world
    orientation: np.ndarray  # (4,) x y z w, world from head
    twist: np.ndarray  # (6,) (Omega, V) rad/s, m/s, head's axes
    most_evaluations: float = MOST_EVALUATIONS  # per simulated second

    @staticmethod
    def of(
        law, body, scene, accuracy, position, orientation, twist, most_evaluations=MOST_EVALUATIONS
    ) -> "SwimmerArguments":
        """Check the arguments of `simulate`. `ValueError` names what does not fit."""
        swimmer = SwimmerArguments(
            checked_instance("law", law, LAWS),
            checked_body(body),
            Scene() if scene is None else checked_instance("scene", scene, Scene),
            Accuracy.of(accuracy),
            checked_row("position", position, 3),
            checked_quaternion("orientation", orientation),
            checked_row("twist", twist, 6),
            checked_number("most_evaluations", most_evaluations, "per simulated second"),
        )
        if swimmer.scene.planar:
            check_planar(*swimmer.initial_state)
        return swimmer

    @property
    def initial_state(self) -> InitialState:
        """The head at t = 0."""
        return InitialState(self.position, self.orientation, self.twist)


def swimmers_of(
    laws, bodies, scenes, accuracy, positions, orientations, twists, most_evaluations=MOST_EVALUATIONS
) -> list[SwimmerArguments]:
    """The arguments of B swimmers, with `most_evaluations` per simulated second.

    Each other argument is one for all, or a sequence of B (for the last three the rows of an array (B, .)); a sequence
    of length 1 counts as one for all. `ValueError` names what does not fit, and the swimmer's number.
    """
    columns = _broadcast(
        laws=_several("laws", laws, LAWS),
        bodies=_several("bodies", Body.boyer2010() if bodies is None else bodies, Body),
        scenes=_several("scenes", Scene() if scenes is None else scenes, Scene),
        accuracy=[Accuracy.of(each) for each in (accuracy if isinstance(accuracy, (list, tuple)) else [accuracy])],
        positions=_rows("positions", positions, lambda name, row: checked_row(name, row, 3)),
        orientations=_rows("orientations", orientations, checked_quaternion),
        twists=_rows("twists", twists, lambda name, row: checked_row(name, row, 6)),
    )
    most_evaluations = checked_number("most_evaluations", most_evaluations, "per simulated second")
    swimmers = [SwimmerArguments(*(*row, most_evaluations)) for row in zip(*columns, strict=True)]
    for index, swimmer in enumerate(swimmers):
        if swimmer.scene.planar:
            _check_planar(index, swimmer)
    return swimmers


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


def _rows(name: str, values, check) -> list[np.ndarray]:
    array = numbers(name, values)
    if array.ndim == 1:
        return [check(name, array)]
    return [check(f"{name}[{index}]", row) for index, row in enumerate(np.atleast_1d(array))]


def _check_planar(index: int, swimmer: SwimmerArguments):
    try:
        check_planar(*swimmer.initial_state)
        check_planar_law(swimmer.law)
    except ValueError as error:
        raise ValueError(f"swimmer {index}: {error}") from None
