# SPDX-License-Identifier: Apache-2.0
"""Makes the simulation from the node's parameters."""

from eel_model.body.body import body_of
from eel_model.fins.text import fins_from_text
from eel_model.flow.text import flow_from_text
from eel_model.robot.robot import robot_of
from eel_model.scene import Scene

from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.simulation.simulation import Simulation


def simulation_from_parameters(parameters: DynamicsParameters, scene: Scene) -> Simulation:
    """The simulation at t = 0; `ValueError` names what does not fit."""
    robot = robot_of(parameters.robot)
    own = robot is not None and robot.body is not None and parameters.body == DynamicsParameters.body
    return Simulation(
        body=None if own else body_of(parameters.body),
        robot=robot,
        scene=scene,
        accuracy=parameters.accuracy,
        stations=parameters.stations,
        position=parameters.initial_position,
        orientation=parameters.initial_orientation,
        twist=(*parameters.initial_angular_velocity, *parameters.initial_linear_velocity),
        default_transition=parameters.default_transition,
        most_evaluations=parameters.most_evaluations,
        measure_error=parameters.estimate_error,
        flow=flow_from_text(parameters.flow),
        fins=fins_from_text(parameters.fins),
    )
