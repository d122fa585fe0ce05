# SPDX-License-Identifier: Apache-2.0
"""A ROS node: a policy of train_policy.py steers the dynamics node, in lockstep, over odom and curvature_samples.

dynamics --ros-args -p real_time_factor:=0 -p rate:=10 -p duration:=20 -p scene.planar:=true
python docs/examples/policy_controller.py --ros-args -p heading:=0.6
"""

import array
import json
import sys
from pathlib import Path

import numpy as np
import rclpy
from eel_ros.qos import keep_all
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from row_policy import actions_of, file_of

from eel_gym import HeadingEnv, HeadMotion
from eel_msgs.msg import CurvatureSamples

FIELDS = "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel"


class PolicyController(Node):
    """Answers each sample on `odom` with the curvature one control step on. The rate of the run is that of training."""

    def __init__(self):
        super().__init__("policy_controller")
        found = json.loads(Path(self.declare_parameter("policy", str(file_of("heading"))).value).read_text())
        self.weights, self.step = np.array(found["weights"]), found["task"]["control_period"]
        self.env = HeadingEnv(control_period=self.step)
        self.declare_parameter("heading", 0.0, ParameterDescriptor(dynamic_typing=True))  # an integer will do
        self.last, self.answers = np.inf, []
        self.publisher = self.create_publisher(CurvatureSamples, "curvature_samples", keep_all())
        self.create_subscription(Odometry, "odom", self.receive, keep_all())

    def receive(self, odometry):
        """Answer one sample. A stamp that goes back is a start; one that is repeated gets the same answers."""
        now = odometry.header.stamp.sec + 1e-9 * odometry.header.stamp.nanosec
        if now != self.last:
            self.answers = []
            if not now > self.last:
                self.answers.append(self.message(now, self.env.restart()))
            self.env.target = float(self.get_parameter("heading").value)
            observation = self.env.see(head_motion(odometry))
            action = actions_of(self.weights, observation[np.newaxis])[0]
            self.answers.append(self.message(now + self.step, self.env.action.advance(action, self.step)))
            self.last = now
        for answer in self.answers:
            self.publisher.publish(answer)

    def message(self, time, rows):
        """The curvature `rows` (6, points) at `time` [s]."""
        message = CurvatureSamples(x=array.array("d", self.env.action.x.tobytes()))
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(time * 1e9), 1_000_000_000)
        for name, row in zip(FIELDS, rows, strict=True):
            setattr(message, name, array.array("d", row.tobytes()))
        return message


def head_motion(odometry) -> HeadMotion:
    """The head's motion in a message, which has the axes that the policy knows."""
    pose, twist = odometry.pose.pose, odometry.twist.twist
    q = pose.orientation
    vectors = (np.array((v.x, v.y, v.z)) for v in (pose.position, twist.angular, twist.linear))
    position, angular_velocity, velocity = vectors
    return HeadMotion(position, np.array((q.x, q.y, q.z, q.w)), angular_velocity, velocity)


def main() -> int:
    """Run until a signal comes. Status 2 for a policy that cannot be read."""
    rclpy.init()
    try:
        rclpy.spin(PolicyController())
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    except (OSError, ValueError, KeyError) as error:
        print(f"policy_controller: the policy cannot be read: {error}", file=sys.stderr)
        return 2
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
