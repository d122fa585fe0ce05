# SPDX-License-Identifier: Apache-2.0
"""The terms of the model that a scene may do without, and how each is switched off. A further one is a line of `TERMS`.

A term that is off in a scene, or whose switch changes nothing in it, is not among those of that scene.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from eel_dynamics.runs.swim import AT_REST, Swim
from eel_gaits.laws.law import Law

Off = Callable[[Swim], Swim]  # a swim -> the same without the term


def _scene(**fields: Any) -> Off:
    return lambda swim: swim._replace(scene=replace(swim.scene, **fields))


def planar(swim: Swim) -> Swim:
    """The `swim` in the plane z = const: law, start and current without their parts out of it."""
    law = swim.law
    if isinstance(law, Law) and not law.in_plane:
        law = Law(*(term for term in law.terms if term.axis == "yaw"), name=law.name, transition=law.transition)
    _, _, z, w = swim.start.orientation
    orientation = np.array([0.0, 0.0, z, w]) / np.hypot(z, w) if np.hypot(z, w) > 0.0 else AT_REST.orientation
    start = swim.start._replace(orientation=orientation, twist=swim.start.twist * (0, 0, 1, 1, 1, 0))
    scene = replace(swim.scene, planar=True, current=(*swim.scene.current[:2], 0.0))
    return swim._replace(law=law, start=start, scene=scene)


TERMS: dict[str, Off] = {
    "inertia of the water": _scene(reactive=False),
    "wake": _scene(wake=False),
    "cross-flow drag": _scene(cross_flow=False),
    "friction": _scene(friction="none"),
    "turbulence of the friction": _scene(friction="laminar"),
    "nose": _scene(nose=False),
    "righting moment": _scene(metacentric_height=0.0),
    "current": _scene(current=(0.0, 0.0, 0.0)),
    "flow": lambda swim: swim._replace(flow=None),
    "third dimension": planar,
}
WITHIN = {"friction": ("turbulence of the friction",), "inertia of the water": ("wake",)}  # what goes with a term


def terms_of(swim: Swim) -> dict[str, Swim]:
    """The terms of the `swim` by name, each with the swim without it."""
    found = {name: off(swim) for name, off in TERMS.items()}
    return {name: without for name, without in found.items() if _physics(without) != _physics(swim)}


def without(swim: Swim, names: list[str]) -> Swim:
    """The `swim` without all of these terms."""
    covered = {part for name in names for part in WITHIN.get(name, ())}
    for name in TERMS:
        swim = TERMS[name](swim) if name in names and name not in covered else swim
    return swim


def _physics(swim: Swim) -> tuple[Any, ...]:
    """What a switch may change, as values that can be compared: a switch that has no effect leaves it equal."""
    scene = swim.scene
    if not scene.reactive:
        scene = replace(scene, wake=False)
    if not scene.resistive:
        scene = replace(scene, cross_flow=False, friction="none")
    if not (scene.reactive or scene.resistive):
        scene = replace(scene, nose=False)
    if scene.planar:
        scene = replace(scene, metacentric_height=0.0)
    return scene, swim.flow, swim.law, *(row.tobytes() for row in swim.start)
