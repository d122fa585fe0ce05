# SPDX-License-Identifier: Apache-2.0
"""Holds the heading and the depth of the ready robot sixteen_servos by its joints: a template of one's own controller.

python docs/examples/joint_controller.py --ros-args -p heading:=0.6 -p depth:=0.3
"""

import contextlib
import math

import rclpy
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import JointState

JOINTS = 8  # in yaw, and as many in pitch


def clip(value, greatest):
    return max(-greatest, min(greatest, value))


class HeadingAndDepth:
    """heading: wanted [rad], to the left of +x. depth: wanted [m], below z = 0."""

    def __init__(self, heading, depth):
        self.heading, self.depth = heading, depth
        self.time = self.dive = 0.0  # s; rad: the nose that holds the depth

    def angles(self, time, position, orientation):
        """Angles [rad] by joints at `time` [s]; yaw: left. position: of the head (3,) [m]; orientation: x y z w."""
        step, self.time = time - self.time, time
        if step < 0.0:  # the run has begun again
            self.dive = step = 0.0
        x, y, z, w = orientation
        yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        nose_down = math.asin(clip(2.0 * (w * y - z * x), 1.0))
        too_high = position[2] + self.depth  # m
        self.dive = clip(self.dive + 0.02 * too_high * step, 0.3)
        turn = clip(0.25 * math.remainder(self.heading - yaw, math.tau), 0.15)
        pitch = clip(0.5 * (nose_down - clip(0.6 * too_high, 0.4) - self.dive), 0.12)
        begin = min(1.0, 0.5 * time) ** 2  # from rest
        angles = {}
        for k in range(JOINTS):
            along = k / (JOINTS - 1)
            wave = 0.25 * (0.3 + 0.7 * along) * math.sin(math.tau * (time - 0.8 * along))
            angles[f"yaw_{k + 1}"] = begin * (wave + turn)
            angles[f"pitch_{k + 1}"] = begin * pitch
        return angles


class JointController(Node):
    """Answers each `odom` with commands for all joints, which have its stamp."""

    def __init__(self):
        super().__init__("joint_controller")
        goals = (self.declare_parameter(name, value).value for name, value in (("heading", 0.6), ("depth", 0.3)))
        self.control = HeadingAndDepth(*goals)
        self.commands = self.create_publisher(JointState, "joint_commands", 10)
        self.create_subscription(Odometry, "odom", self.answer, 10)

    def answer(self, odom):
        place, turn = odom.pose.pose.position, odom.pose.pose.orientation
        time = odom.header.stamp.sec + 1e-9 * odom.header.stamp.nanosec
        found = self.control.angles(time, (place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w))
        angles = {name: -angle if "yaw" in name else angle for name, angle in found.items()}  # in topics about +z
        self.commands.publish(JointState(header=odom.header, name=[*angles], position=[*angles.values()]))


if __name__ == "__main__":
    rclpy.init()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(JointController())
