# SPDX-License-Identifier: Apache-2.0
"""The optional terms of the model, and how each is switched off. A new one is a line of `TERMS`.

A scene's terms exclude those that are already off in it, or whose switch changes nothing.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from eel_dynamics.model.body.hull import BY_SHAPE, EDGE_ON, PLATE
from eel_dynamics.model.initial_state import AT_REST
from eel_dynamics.runs.swim import Swim

from eel_dynamics import Gust, Robot, Uniform
from eel_gaits import Law

Off = Callable[[Swim], Swim]  # a swim -> the same without the term


def _scene(**fields: Any) -> Off:
    return lambda swim: swim.unchecked(scene=replace(swim.scene, **fields))


def _body(**fields: Any) -> Off:
    def off(swim: Swim) -> Swim:
        changed = swim.body.changed(**fields)
        return swim if changed == swim.body else swim.unchecked(body=changed)

    return off


def _as_plates(swim: Swim) -> Swim:
    """The `swim` of a body whose cross-flow drag by shape becomes that of plates."""
    plates = {"lateral_drag": PLATE, "vertical_drag": EDGE_ON}
    return _body(**{name: value for name, value in plates.items() if getattr(swim.body, name) is BY_SHAPE})(swim)


def _joints(**fields: Any) -> Off:
    """Switches off the effect of these fields of a robot's joints, or of their servos."""

    def off(swim: Swim) -> Swim:
        robot = swim.robot
        for joint in robot.joints if robot is not None else ():
            known = {*vars(joint), *(vars(joint.actuator) if joint.actuator is not None else ())}
            own = {name: value for name, value in fields.items() if name in known}
            robot = robot.changed(joint.name, **own) if own and robot is not None else robot
        return swim.unchecked(robot=robot)

    return off


def _one_mode(swim: Swim) -> Swim:
    """The `swim` of a robot whose tails and muscles bend in one mode only."""
    if swim.robot is None:
        return swim
    parts = [replace(part, modes=1) if hasattr(part, "modes") else part for part in swim.robot.parts]
    return swim.unchecked(robot=Robot(parts, name=swim.robot.name, body=swim.robot.body, notes=swim.robot.notes))


def _on_the_axis(swim: Swim) -> Swim:
    """The `swim` of a body whose mass lies on its axis."""
    given = swim.body.arguments["centre_of_mass_offset"]
    off = callable(given) or np.any(given)
    return swim.unchecked(body=swim.body.changed(centre_of_mass_offset=0.0)) if off else swim


def planar(swim: Swim) -> Swim:
    """The `swim` in the plane z = const, without fins: law, start and current without their parts out of it."""
    law = swim.law
    if isinstance(law, Law) and not law.in_plane:
        law = Law(*(term for term in law.terms if term.axis == "yaw"), name=law.name, transition=law.transition)
    _, _, z, w = swim.start.orientation
    orientation = np.array([0.0, 0.0, z, w]) / np.hypot(z, w) if np.hypot(z, w) > 0.0 else AT_REST.orientation
    start = swim.start._replace(orientation=orientation, twist=swim.start.twist * (0, 0, 1, 1, 1, 0))
    scene = replace(swim.scene, planar=True, current=(*swim.scene.current[:2], 0.0))
    return swim.unchecked(law=law, start=start, scene=scene, fins=())


TERMS: dict[str, Off] = {
    "inertia of the water": _scene(reactive=False),
    "momentum of the added mass": _scene(added_inertia=False),
    "wake": _scene(wake=False),
    "cross-flow drag": _scene(cross_flow=False),
    "friction": _scene(friction="none"),
    "turbulence of the friction": _scene(friction="laminar"),
    "nose": _scene(nose=False),
    "cross flow by shape": _as_plates,
    "separation of the added mass": _body(round_added_mass=1.0),
    "drag of the links": _body(joint_drag=0.0),
    "drag of the base": _body(base_drag=0.0),
    "appendages": _body(appendages=()),
    "righting moment": _scene(metacentric_height=0.0),
    "weight": _scene(weight=False),
    "mass off the axis": _on_the_axis,
    "current": _scene(current=(0.0, 0.0, 0.0)),
    "flow": lambda swim: swim.unchecked(flow=None),
    "gradient of the flow": _scene(flow_gradient=False),
    "fins": lambda swim: swim.unchecked(fins=()),
    "added mass of the fins": lambda swim: swim.unchecked(
        fins=tuple(replace(fin, added_mass=0.0) for fin in swim.fins)
    ),
    "third dimension": planar,
    "compliance of the robot": lambda swim: swim.unchecked(robot=None),
    "limits of the servos": _joints(torque_limit=None, speed_limit=None),
    "rotors": _joints(rotor_inertia=0.0),
    "hard stops": _joints(limits=None),
    "higher modes": _one_mode,
}
WITHIN = {  # terms that vanish with a term
    "cross-flow drag": ("cross flow by shape",),
    "friction": ("turbulence of the friction",),
    "inertia of the water": ("wake", "momentum of the added mass", "gradient of the flow", "added mass of the fins"),
    "flow": ("gradient of the flow",),
    "fins": ("added mass of the fins",),
    "compliance of the robot": ("limits of the servos", "rotors", "hard stops", "higher modes"),
}


def terms_of(swim: Swim) -> dict[str, Swim]:
    """The terms of the `swim`: for each name, the swim without that term."""
    found = {name: off(swim) for name, off in TERMS.items()}
    return {name: without for name, without in found.items() if _physics(without) != _physics(swim)}


def without(swim: Swim, names: list[str]) -> Swim:
    """The `swim` without all of these terms."""
    covered = {part for name in names for part in WITHIN.get(name, ())}
    for name in TERMS:
        swim = TERMS[name](swim) if name in names and name not in covered else swim
    return swim


def _physics(swim: Swim) -> tuple[Any, ...]:
    """All that a switch may change, as comparable values: equal values mean that a switch has no effect."""
    scene = swim.scene
    if not scene.reactive:
        scene = replace(scene, wake=False, added_inertia=False)
    if swim.flow is None or isinstance(swim.flow, (Uniform, Gust)):
        scene = replace(scene, flow_gradient=True)
    if not scene.resistive:
        scene = replace(scene, cross_flow=False, friction="none")
        swim = _body(joint_drag=0.0, base_drag=0.0, appendages=())(swim)
    if not (scene.resistive and scene.cross_flow):
        swim = _body(lateral_drag=PLATE, vertical_drag=EDGE_ON)(swim)
    if not scene.reactive:
        swim = _body(round_added_mass=1.0)(swim)
    if not (scene.reactive or scene.resistive):
        scene = replace(scene, nose=False)
    if scene.planar:
        scene = replace(scene, metacentric_height=0.0)
    parts = swim.flow, swim.robot, swim.fins, swim.wrenches
    return scene, swim.law, swim.body, *parts, *(row.tobytes() for row in swim.start)
