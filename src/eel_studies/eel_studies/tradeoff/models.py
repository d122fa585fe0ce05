# SPDX-License-Identifier: Apache-2.0
"""Errors of simpler models: the difference of a model that leaves physics out, solved exactly, from the full model.

A discretisation error far below the error of the model has no benefit. This sets the accuracy that a scene requires.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

from eel_dynamics.model.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.run import Run
from eel_dynamics.simulation.simulation import SimulationStopped
from eel_gaits.laws.law import Law

from eel_studies.tradeoff.measuring import errors_of, swim
from eel_studies.tradeoff.settings import REFERENCE

VARIANTS: dict[str, dict] = {
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
    """Relative errors of a simpler model, compared with the full model; NaN where it stopped."""

    name: str
    pose_error: float
    torque_error: float
    run: Run | None  # None where the simulation stopped
    stopped: str = ""


def compare(
    law: Law,
    reference: Run,
    *,
    duration: float,
    body: Body,
    scene: Scene,
    say: Callable[[str], None] = lambda text: None,
) -> list[Model]:
    """Compare every variant that changes `scene` with the `reference` run in `scene`, over `duration` [s].

    say(text): called with a line of progress.
    """
    found = []
    for name, changes in VARIANTS.items():
        changed = replace(scene, **changes)
        if changed == scene:
            continue
        say(f"the model without: {name}")
        driven = flattened(law) if changed.planar else law
        try:
            run = swim(driven, duration, body, changed, REFERENCE)
        except SimulationStopped as stopped:
            found.append(Model(name, float("nan"), float("nan"), None, str(stopped)))
            continue
        found.append(Model(name, *errors_of(run, reference), run))
    return found


def flattened(law: Law) -> Law:
    """`law` with its terms in yaw alone, which bend the body in the plane."""
    return Law(*(term for term in law.terms if term.axis == "yaw"), name=law.name, transition=law.transition)
