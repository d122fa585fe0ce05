# SPDX-License-Identifier: Apache-2.0
"""The subscriptions to commands of joints and fins: they are there while the swimmer has such parts."""

from collections.abc import Callable

from eel_ros.qos import keep_all
from eel_ros.serving import ServedNode
from rclpy.subscription import Subscription
from sensor_msgs.msg import JointState

from eel_dynamics.ros.loop.command_queue import CommandQueue
from eel_dynamics.ros.loop.run_loop import RunLoop


class CommandSubscriptions:
    """The subscriptions of `node` for a `run`. What a message says is read and checked in the run loop's thread."""

    def __init__(self, node: ServedNode, run: RunLoop) -> None:
        self._node, self._run = node, run
        self._made: dict[str, Subscription] = {}
        self.look()

    def look(self) -> None:
        """Subscribe, or end a subscription, as the present swimmer asks; call this now and then."""
        for queue in (self._run.inputs.joints, self._run.inputs.fins):
            if queue.names and queue.topic not in self._made:
                receive, quality = self._receiver(queue), keep_all(reliable=True)
                self._made[queue.topic] = self._node.create_subscription(JointState, queue.topic, receive, quality)
            elif not queue.names and queue.topic in self._made:
                self._node.destroy_subscription(self._made.pop(queue.topic))

    def _receiver(self, queue: CommandQueue) -> Callable[[JointState], None]:
        run = self._run
        return lambda message: (run.requests.put(run.take_command, queue, message), None)[1]
