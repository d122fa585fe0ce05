# SPDX-License-Identifier: Apache-2.0
"""Errors of simpler models: the difference of a model that leaves physics out, solved exactly, from the full model.

A discretisation error far below the error of the model has no benefit. This sets the accuracy that a scene requires.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from eel_dynamics.runs.run import Run
from eel_dynamics.runs.swim import Swim
from eel_dynamics.simulation.simulation import SimulationStopped
from eel_gaits.laws.law import Law

from eel_studies.tradeoff.measuring import errors_of, swim_with
from eel_studies.tradeoff.settings import REFERENCE

VARIANTS: dict[str, dict[str, Any]] = {  # what differs in the scene
    "planar": {"planar": True},
    "reactive only (no drag)": {"resistive": False},
    "resistive only (no added mass, no wake)": {"reactive": False},
    "no wake": {"wake": False},
    "no friction": {"friction": "none"},
    "laminar friction": {"friction": "laminar"},
    "blended friction": {"friction": "blended"},
    "no loads on the nose": {"nose": False},
    "added mass as printed": {"added_mass": "printed"},
    "half the perimeter, as printed": {"perimeter": "printed"},
}


@dataclass(frozen=True)
class Model:
    """Relative errors of a simpler model, compared with the full model; infinite where it stopped."""

    name: str
    pose_error: float
    torque_error: float
    stopped: str = ""


def compare(
    swim: Swim, reference: Run, duration: float, say: Callable[[str], object] = lambda text: None
) -> list[Model]:
    """Compare every variant that changes the scene of the `swim` with its `reference`, over `duration` [s].

    say(text): called with a line of progress.
    """
    found = []
    for name, changes in VARIANTS.items():
        if replace(swim.scene, **changes) == swim.scene:
            continue
        say(f"the model without: {name}")
        law = flattened(swim.law) if "planar" in changes else swim.law
        try:
            errors = errors_of(swim_with(swim._replace(law=law), duration, REFERENCE, **changes), reference)
            found.append(Model(name, *errors))
        except SimulationStopped as stopped:
            found.append(Model(name, float("inf"), float("inf"), str(stopped)))
    return found


def flattened(law: Law) -> Law:
    """`law` with its terms in yaw alone, which bend the body in the plane."""
    return Law(*(term for term in law.terms if term.axis == "yaw"), name=law.name, transition=law.transition)
