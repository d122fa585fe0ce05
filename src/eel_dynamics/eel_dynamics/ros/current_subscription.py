# SPDX-License-Identifier: Apache-2.0
"""Receives samples of a current, checks each, and puts it into the queue of the run loop."""

from eel_ros.loop.diagnostics import ERROR, Report
from eel_ros.serving import ServedNode
from geometry_msgs.msg import Vector3Stamped
from rclpy.qos import QoSProfile, ReliabilityPolicy

from eel_dynamics.ros.loop.run_loop import RunLoop
from eel_dynamics.ros.messages import current_from_message

DEPTH = 100  # samples


class CurrentSubscription:
    """The subscription of `node` to current, for a `run`. Best-effort, as sensors are, it matches any publisher."""

    def __init__(self, node: ServedNode, run: RunLoop, world_frame: str, report: Report) -> None:
        self._run, self._world_frame, self._report = run, world_frame, report
        quality = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
        node.create_subscription(Vector3Stamped, "current", self.receive, quality)

    def receive(self, message: Vector3Stamped) -> None:
        """Pass on the sample in the `message`."""
        try:
            sample = current_from_message(message, self._run.time, self._world_frame)
        except ValueError as error:
            self._report.event("current", f"current refused: {error}", ERROR)
        else:
            self._run.requests.put(self._run.take_current, *sample)
