# SPDX-License-Identifier: Apache-2.0
"""What a run is told: body, fins, robot, scene and flow. Set-up in NumPy; `eel_dynamics` marches it in time."""

from eel_model.body.appendages import Appendage
from eel_model.body.body import Body
from eel_model.fins.fins import Fin, RollHold
from eel_model.flow.flow import Flow, FlowSample
from eel_model.flow.functions import FlowField
from eel_model.flow.gridded import GriddedFlow
from eel_model.flow.sources import Gust, Shear, Uniform, Vortex, VortexStreet, Wave
from eel_model.robot.actuators import Servo, Torque
from eel_model.robot.continuous import Muscle, PassiveTail
from eel_model.robot.joint import Joint
from eel_model.robot.robot import Robot
from eel_model.scene import Scene

__all__ = [
    "Appendage",
    "Body",
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
    "Vortex",
    "VortexStreet",
    "Wave",
]
