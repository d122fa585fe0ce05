# SPDX-License-Identifier: Apache-2.0
"""Receives the angles that fins are asked for, and puts them into the queue of the run loop."""

from eel_ros.loop.diagnostics import ERROR, Report
from eel_ros.serving import ServedNode
from sensor_msgs.msg import JointState

from eel_dynamics.ros.loop.run_loop import RunLoop
from eel_dynamics.ros.messages import fin_command_from_message

DEPTH = 10  # commands


class FinSubscription:
    """The subscription of `node` to fin_command, for a `run`: commands act between two samples."""

    def __init__(self, node: ServedNode, run: RunLoop, report: Report) -> None:
        self._run, self._report = run, report
        node.create_subscription(JointState, "fin_command", self.receive, DEPTH)

    def receive(self, message: JointState) -> None:
        """Pass on the command in the `message`."""
        try:
            commands = fin_command_from_message(message)
        except ValueError as error:
            self._report.event("fin command", f"fin_command refused: {error}", ERROR)
        else:
            self._run.requests.put(self._run.command_fins, commands)
