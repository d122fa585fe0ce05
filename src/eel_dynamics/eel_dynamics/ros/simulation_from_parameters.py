# SPDX-License-Identifier: Apache-2.0
"""Makes the simulation from the node's parameters."""

from eel_common.wording import shown

from eel_dynamics.model.body.body import checked_body
from eel_dynamics.model.body.text import body_of
from eel_dynamics.model.fins.text import fins_from_text
from eel_dynamics.model.flow.text import flow_from_text
from eel_dynamics.model.robot.robot import Robot, robot_of
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.text import wrenches_from_text
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.wrench_frames import stations_of, wrench_frames
from eel_dynamics.sensors.sensor import SensorSettings
from eel_dynamics.sensors.suite import check_settings, places_of
from eel_dynamics.simulation.simulation import Simulation

Sensors = tuple[SensorSettings, ...]


def simulation_from_parameters(parameters: DynamicsParameters, scene: Scene, sensors: Sensors = ()) -> Simulation:
    """The simulation at t = 0, with the robot's own limits. `ValueError` names an invalid parameter."""
    robot, places = robot_from_parameters(parameters), check_sensors(parameters, sensors)
    own, frames = has_own_body(robot, parameters), wrench_frames(parameters)
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
        sensors=tuple(sorted({*places, *[*frames.values()][1:]})),  # the head's frame is the first
        wrenches=(*wrenches_from_text(parameters.wrenches), *stations_of(frames)),
    )


def has_own_body(robot: Robot | None, parameters: DynamicsParameters) -> bool:
    """Whether the simulation uses the body of the `robot`."""
    return robot is not None and robot.body is not None and parameters.body == DynamicsParameters.body


def check_sensors(parameters: DynamicsParameters, sensors: Sensors) -> tuple[float, ...]:
    """The stations [m] of the `sensors` that are on. `ValueError` names an invalid one."""
    if not any(each.rate for each in sensors):
        return ()
    robot = robot_from_parameters(parameters)
    body = robot.body if robot is not None and has_own_body(robot, parameters) else body_of(parameters.body)
    for each in sensors:
        check_settings(each, checked_body(body), robot, parameters.rate)
    return places_of(sensors)


def robot_from_parameters(parameters: DynamicsParameters) -> Robot | None:
    """The robot with its own limits. `ValueError` for an invalid robot, and for servo_torque_limit without servos."""
    robot, limit = robot_of(parameters.robot), parameters.servo_torque_limit
    if limit > 0.0 and (robot is None or not has_servos(robot)):
        given = f"{limit:g} N m with robot {shown(parameters.robot)}"
        raise ValueError(f"servo_torque_limit must be 0 without servos, got {given}")
    return robot


def has_servos(robot: Robot) -> bool:
    """Whether a joint of the robot has a servo."""
    return any(servo is not None for servo in robot.servos)
