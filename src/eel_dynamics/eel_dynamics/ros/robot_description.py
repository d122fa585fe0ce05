# SPDX-License-Identifier: Apache-2.0
"""The topic `robot_description`: the swimmer as a URDF, with links and joints named as on /tf and `joint_states`."""

from typing import Any

from eel_common.ros.qos import latched
from eel_common.ros.serving import ServedNode
from eel_common.wording import one_line
from std_msgs.msg import String

from eel_dynamics.model.robot.urdf_writer import urdf_of
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.simulation.simulation import Simulation

TOPIC = "robot_description"


class RobotDescription:
    """Publishes the URDF of a simulation's swimmer when it changes. Late subscribers get it too."""

    def __init__(self, node: ServedNode) -> None:
        self._node, self._text = node, ""
        self._publisher: Any = None

    def publish(self, simulation: Simulation, parameters: DynamicsParameters) -> None:
        """Publish the URDF of a new `simulation`.

        If a URDF cannot describe the swimmer, that is logged. Late subscribers then get none, rather than the last one.
        """
        if not parameters.publish_robot_description:
            return
        try:
            text = urdf_of(
                simulation.body,
                simulation.robot,
                yaw_joints=parameters.yaw_joints,
                pitch_joints=parameters.pitch_joints,
                density=simulation.scene.density,
                fins=simulation.fins,
                base_link=parameters.head_frame,
            ).text
        except ValueError as error:
            self._node.get_logger().warning(f"{TOPIC} is not published: {one_line(error)}")
            self._withdraw()
            return
        if self._publisher is None:
            self._publisher = self._node.create_publisher(String, TOPIC, latched(1))
        if text != self._text:
            self._publisher.publish(String(data=text))
            self._text = text

    def _withdraw(self) -> None:
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
        self._publisher, self._text = None, ""
