# SPDX-License-Identifier: Apache-2.0
"""A ROS node: a policy of train_policy.py steers the dynamics node, in lockstep, over odom and curvature_samples.

dynamics --ros-args -p real_time_factor:=0 -p rate:=10 -p duration:=20 -p scene.planar:=true
python docs/examples/policy_controller.py --ros-args -p heading:=0.6
"""

import json
import sys
from pathlib import Path

import numpy as np
from eel_common.ros.headers import seconds_of
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.qos import keep_all
from eel_common.ros.run_node import run_node
from eel_gaits.ros.lead import Lead
from eel_gaits.ros.messages import samples_to_message
from eel_gaits.ros.pilot_messages import head_motion
from nav_msgs.msg import Odometry
from train_policy import actions_of, file_of

from eel_gym import HeadingEnv, LawAction
from eel_msgs.msg import CurvatureSamples

NAME = "policy_controller"


class PolicyController(ParameterNode):
    """Answers each sample on `odom` with the curvature one control step on. The rate of the run is that of training."""

    def __init__(self):
        super().__init__(NAME, automatically_declare_parameters_from_overrides=False)  # they are declared below
        found = json.loads(Path(self.declare_parameter("policy", str(file_of("heading"))).value).read_text())
        self.weights, self.step = np.array(found["weights"]), found["task"]["control_period"]
        self.env, self.lead = HeadingEnv(control_period=self.step), Lead(self.step, self.step)
        self.declare_parameter("heading", 0.0)
        self.last, self.answers = np.inf, []
        self.publisher = self.create_publisher(CurvatureSamples, "curvature_samples", keep_all())
        self.create_subscription(Odometry, "odom", self.receive, keep_all())

    def receive(self, odometry):
        """Answer one sample. In a run that is under way the first answer lies ahead too; a stamp that is repeated gets
        the same answers."""
        now, head = seconds_of(odometry.header.stamp), head_motion(odometry)
        if now != self.last:
            self.last, self.answers = now, []
            if self.lead.begins(now):
                self.answers.append(self.message(self.lead.begin(now), self.env.restart()))
            self.env.target = self.get_parameter("heading").value
            observation = self.env.see(head)
            for time in self.lead.after(now):
                action = actions_of(self.weights, observation[np.newaxis])[0]
                self.answers.append(self.message(time, self.env.action.advance(action, self.step)))
        for answer in self.answers:
            self.publisher.publish(answer)

    def message(self, time, rows):
        """The curvature `rows` (6, points) at `time` [s]."""
        assert isinstance(self.env.action, LawAction)
        return samples_to_message(time, self.env.action.x, rows)


def main() -> int:
    """Run until a signal comes. Status 2 for a policy that cannot be read."""
    return run_node(NAME, sys.argv, PolicyController, lambda node: True)


if __name__ == "__main__":
    sys.exit(main())
