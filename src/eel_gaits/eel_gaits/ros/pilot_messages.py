# SPDX-License-Identifier: Apache-2.0
"""Conversion of messages for the pilot, and the goal as a message."""

import numpy as np
from eel_common.attitude import unit_quaternion
from eel_common.head_motion import HeadMotion
from eel_common.ros.headers import FieldReader
from eel_common.ros.serving import read_message
from eel_common.wording import shown
from geometry_msgs.msg import Point, Pose, PoseStamped
from nav_msgs.msg import Odometry, Path
from std_msgs.msg import Header

from eel_gaits.pilot.goals import FARTHEST, check_count

GREATEST = 10.0 * FARTHEST  # m, m/s, rad/s: beyond any goal, but safe from overflow


def point_of(point: Point) -> tuple[float, float, float]:
    """(x, y, z) [m]."""
    return point.x, point.y, point.z


def read_path(data: bytes) -> Path:
    """The path serialised in `data`. `ValueError` for too many points, which are counted first; bytes that are no
    message raise another error."""
    check_count(FieldReader(data).number())
    return read_message(data, Path)


def path_message(points: np.ndarray, frame: str) -> Path:
    """The `points` (n, 3) [m] in this `frame`, without a time."""
    header = Header(frame_id=frame)
    positions = [Point(x=x, y=y, z=z) for x, y, z in points.tolist()]
    return Path(header=header, poses=[PoseStamped(header=header, pose=Pose(position=each)) for each in positions])


def head_motion(odometry: Odometry) -> HeadMotion:
    """The head's motion. `ValueError` if it is not finite, too far, too fast, or has no orientation."""
    pose, twist = odometry.pose.pose, odometry.twist.twist
    q = pose.orientation
    orientation = np.array((q.x, q.y, q.z, q.w))
    vectors = (np.array(point_of(each)) for each in (pose.position, twist.angular, twist.linear))
    position, angular_velocity, velocity = vectors
    for name, values in (
        ("position", position),
        ("orientation", orientation),
        ("angular velocity", angular_velocity),
        ("velocity", velocity),
    ):
        if not np.isfinite(values).all():
            raise ValueError(f"{name} must be finite, got {shown(values.tolist())}")
        if np.abs(values).max() > GREATEST:
            raise ValueError(f"{name} must be at most {GREATEST:g} in size, got {shown(values.tolist())}")
    orientation = np.array(unit_quaternion("orientation", orientation.tolist()))
    return HeadMotion(position, orientation, angular_velocity, velocity)
