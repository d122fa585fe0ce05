# SPDX-License-Identifier: Apache-2.0
"""Inputs of a run: body, fins, robot, wrenches, scene and flow. They are set up in NumPy; the core marches them."""

from eel_dynamics.model.body.appendages import Appendage
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.fins.fins import Fin, RollHold
from eel_dynamics.model.flow.flow import Flow, FlowSample
from eel_dynamics.model.flow.functions import FlowField
from eel_dynamics.model.flow.gridded import GriddedFlow
from eel_dynamics.model.flow.sources import Gust, Shear, Uniform, Vortex, VortexStreet, Wave
from eel_dynamics.model.robot.actuators import Servo, Torque
from eel_dynamics.model.robot.continuous import Muscle, PassiveTail
from eel_dynamics.model.robot.joint import Joint
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.robot.urdf_writer import Urdf, urdf_of
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench

__all__ = [
    "Appendage",
    "Body",
    "ExternalWrench",
    "Fin",
    "Flow",
    "FlowField",
    "FlowSample",
    "GriddedFlow",
    "Gust",
    "Joint",
    "Muscle",
    "PassiveTail",
    "Robot",
    "RollHold",
    "Scene",
    "Servo",
    "Shear",
    "Torque",
    "Uniform",
    "Urdf",
    "Vortex",
    "VortexStreet",
    "Wave",
    "urdf_of",
]
