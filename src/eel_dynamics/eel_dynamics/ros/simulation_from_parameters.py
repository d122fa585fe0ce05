# SPDX-License-Identifier: Apache-2.0
"""Makes the simulation (in the library's frames) from the node's parameters (in REP-103 frames)."""

from dataclasses import replace
from pathlib import Path

from eel_dynamics.model.axes import turn_quaternion, turn_vector
from eel_dynamics.model.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.simulation.simulation import Simulation


def simulation_from_parameters(parameters: DynamicsParameters, scene: Scene) -> Simulation:
    """The simulation at t = 0; the scene's current is in the ROS world frame. `ValueError` names what does not fit."""
    twist = (*parameters.initial_angular_velocity, *parameters.initial_linear_velocity)
    return Simulation(
        body=body_of(parameters.body),
        scene=replace(scene, current=tuple(turn_vector(scene.current).tolist())),
        accuracy=parameters.accuracy,
        stations=parameters.stations,
        position=turn_vector(parameters.initial_position),
        orientation=turn_quaternion(parameters.initial_orientation),
        twist=turn_vector([twist[:3], twist[3:]]).ravel(),
        default_transition=parameters.default_transition,
        most_evaluations=parameters.most_evaluations,
        measure_error=parameters.estimate_error,
    )


def body_of(name: str) -> Body:
    """The body of this name, or from this file. `ValueError` or `OSError` if there is none."""
    return Body.from_file(name) if Path(name).suffix in (".csv", ".npz") else Body.named(name)
