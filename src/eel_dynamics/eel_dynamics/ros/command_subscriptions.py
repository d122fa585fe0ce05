# SPDX-License-Identifier: Apache-2.0
"""The subscriptions to commands of joints and fins, to currents, and to external wrenches."""

from collections.abc import Callable
from typing import Any

from eel_common.ros.qos import keep_all
from eel_common.ros.serving import ServedNode
from geometry_msgs.msg import Vector3Stamped, WrenchStamped
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from eel_dynamics.ros.inputs.command_queue import CommandQueue
from eel_dynamics.ros.loop.run_loop import RunLoop

DEPTH = 100  # messages of currents
SENSOR = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)  # matches any publisher


def subscribe_to_commands(node: ServedNode, run: RunLoop) -> None:
    """Subscribe the `node` to the commands for a `run`. The run loop's thread reads and checks the messages.

    The node also subscribes without joints or fins to command, so that it can log why it refuses a command.
    """

    def receiver(queue: CommandQueue) -> Callable[[Any], None]:
        return lambda message: (run.requests.put(run.take_command, queue, message), None)[1]

    inputs = run.inputs
    for queue in (inputs.joints, inputs.fins):
        node.create_subscription(JointState, queue.topic, receiver(queue), keep_all(reliable=True))
    node.create_subscription(WrenchStamped, inputs.wrenches.topic, receiver(inputs.wrenches), keep_all(reliable=True))
    node.create_subscription(Vector3Stamped, inputs.current.topic, receiver(inputs.current), SENSOR)
