# SPDX-License-Identifier: Apache-2.0
"""Holds heading and depth of sixteen_servos by an IMU and a pressure gauge at the head: it never sees the truth.

python docs/examples/sensor_controller.py --ros-args -p heading:=0.6 -p depth:=0.3
"""

import contextlib

import numpy as np
import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped
from joint_controller import HeadingAndDepth
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Imu, JointState

STILL = 1.0  # s, in which the swimmer rests, and the filter finds gravity and the bias of the gyroscopes


class ComplementaryFilter:
    """Attitude and height of the head: gyroscopes and accelerometer in the short run, gravity and pressure in the long.

    The heading is that of the gyroscopes alone, from 0 at the start; no gravity tells it.
    """

    RIGHTING = 0.15  # rad/s of a turn towards the measured vertical, by its sine
    CLIMB, PLACE = 1.0, 1.5  # 1/s^2, 1/s: of the error of the height, into its rate and itself

    def __init__(self):
        self.time = self.start = None  # s
        self.still, self.count = np.zeros(6), 0
        self.orientation = np.array([0.0, 0.0, 0.0, 1.0])  # x y z w, world from head
        self.height = self.climb = 0.0  # m, m/s

    def feel(self, time, force, turning, height):
        """Take a reading at `time` [s]: specific force (3,) [m/s^2], angular velocity (3,) [rad/s], height [m]."""
        if time == self.time:
            return  # the same again: the run stands at its start
        self.start = time if self.start is None else self.start
        reading = np.array([*force, *turning])
        if time < self.start + STILL:
            self.still, self.count = self.still + reading, self.count + 1
            self.time, self.height = time, self.height + (height - self.height) / self.count
            return
        rest = self.still / self.count
        step, self.time = time - self.time, time
        force, turning = reading[:3], reading[3:] - rest[3:]
        up = self.turned((0.0, 0.0, 1.0), -1.0)  # in axes of the head
        turning += self.RIGHTING * np.cross(force / np.linalg.norm(force), up)
        self.orientation += 0.5 * step * self.product(self.orientation, (*turning, 0.0))
        self.orientation /= np.linalg.norm(self.orientation)
        error = height - self.height
        self.height += step * (self.climb + self.PLACE * error)
        self.climb += step * (self.turned(force)[2] - np.linalg.norm(rest[:3]) + self.CLIMB * error)

    def turned(self, vector, sense=1.0):
        """A vector (3,) from head to world, or with `sense` -1 back."""
        x, y, z, w = self.orientation
        about = sense * np.array([x, y, z])
        return vector + 2.0 * np.cross(about, np.cross(about, vector) + w * np.array(vector))

    @staticmethod
    def product(p, q):
        """Of quaternions x y z w."""
        a, b = np.array(p[:3]), np.array(q[:3])
        return np.array([*(p[3] * b + q[3] * a + np.cross(a, b)), p[3] * q[3] - a @ b])


class BySensors:
    """Angles of joints from readings: the controller of joint_controller.py behind the filter."""

    def __init__(self, heading, depth):
        self.filter, self.control = ComplementaryFilter(), HeadingAndDepth(heading, depth)

    def angles(self, time, force, turning, height):
        """Angles [rad] by joints for a reading, as of `ComplementaryFilter.feel`."""
        if self.filter.time is not None and time < self.filter.time:  # the run has begun again
            self.filter = ComplementaryFilter()
        self.filter.feel(time, force, turning, height)
        place = 0.0, 0.0, self.filter.height
        return self.control.angles(max(0.0, time - self.filter.start - STILL), place, self.filter.orientation)


class SensorController(Node):
    """Answers each reading of `imu` and `depth` with commands for all joints, which have its stamp."""

    def __init__(self):
        super().__init__("sensor_controller")
        goals = (self.declare_parameter(name, value).value for name, value in (("heading", 0.6), ("depth", 0.3)))
        self.control, self.waiting = BySensors(*goals), {}
        self.commands = self.create_publisher(JointState, "joint_commands", 10)
        self.create_subscription(Imu, "imu", self.take, 10)
        self.create_subscription(PoseWithCovarianceStamped, "depth", self.take, 10)

    def take(self, message):
        """A reading; once both of a stamp have come, in whatever order, the joints are commanded."""
        stamp = message.header.stamp.sec, message.header.stamp.nanosec
        both = self.waiting.setdefault(stamp, {})
        both[type(message)] = message
        if len(both) == 2:
            time, last = stamp[0] + 1e-9 * stamp[1], self.control.filter.time or 0.0
            kept = {later: each for later, each in self.waiting.items() if later > stamp}
            self.waiting = kept if time >= last else {}  # the run has begun again
            imu, depth = both[Imu], both[PoseWithCovarianceStamped]
            force, turning = imu.linear_acceleration, imu.angular_velocity
            readings = (force.x, force.y, force.z), (turning.x, turning.y, turning.z), depth.pose.pose.position.z
            angles = self.control.angles(time, *readings)
            signed = [-angle if name.startswith("yaw") else angle for name, angle in angles.items()]
            self.commands.publish(JointState(header=imu.header, name=[*angles], position=signed))


if __name__ == "__main__":
    rclpy.init()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(SensorController())
