# SPDX-License-Identifier: Apache-2.0
"""The nodes `pilot` and `dynamics` together, over topics, as fast as possible and in lockstep."""

import math
import re

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from eel_common.attitude import heading, roll
from eel_studies.roll_hold.study import PAIR
from geometry_msgs.msg import Point, Pose, PoseStamped
from nav_msgs.msg import Path
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
from swim_client import LATCHED, LIMIT, SwimClient

from eel_msgs.msg import SwimState

NAMESPACE = "eel1"


def path_message(*points, frame=f"{NAMESPACE}/odom"):
    poses = [PoseStamped(pose=Pose(position=Point(x=x, y=y, z=z))) for x, y, z in points]
    return Path(header=Header(frame_id=frame), poses=poses)


def test_a_short_course_is_swum_and_goals_that_do_not_fit_are_refused(start, fresh_domain):
    swim = SwimClient(domain=fresh_domain, topics=(), namespace=NAMESPACE)
    space = ("--ros-args", "-r", f"__ns:=/{NAMESPACE}", "-p")
    pilot = start(
        "pilot", *space, "torque_limit:=5.0", "-p", "lead:=0.02", "-p", "patience:=2.0", "-p", "headings:=1.0"
    )
    goals = swim.node.create_publisher(Path, "goal_path", 10)
    swim.until(lambda: goals.get_subscription_count(), "subscriber of goal_path")
    assert "ignored: 'headings' (did you mean 'heading'?)" in pilot.output()
    for message, said in (
        (path_message((5.0, 0.0, 0.0), frame="map"), "frame_id must be 'eel1/odom', got 'map'"),
        (path_message((5.0, math.nan, 0.0)), "path point 1 must be finite"),
        (path_message((5.0, 0.0, 0.0), (6.0, 0.0, 3.0)), "climb or dive by at most 17.2 degrees"),
        (path_message((5.0, 0.0, 0.0), (9.0, 0.0, 0.0), (9.0, 1.0, 0.0)), "outside the turning circle of 0.95 m"),
    ):
        goals.publish(message)
        pilot.wait_for_output(said, LIMIT)
    answer = swim.call(
        SetParameters, "pilot/set_parameters", parameters=[Parameter("speed", value=5.0).to_parameter_msg()]
    )
    assert not answer.results[0].successful and "<= 0.9795 m/s" in answer.results[0].reason
    goals.publish(path_message((4.0, 1.0, -0.2), (8.0, -1.0, 0.1)))
    pilot.wait_for_output("swim through 2 points", LIMIT)
    swim.listen("goal", Path, LATCHED)  # late
    swim.until(lambda: swim.received["goal"], "the goal in force")
    goal = swim.received["goal"][0]
    assert goal.header.frame_id == f"{NAMESPACE}/odom"
    places = [each.pose.position for each in goal.poses]
    assert [(place.x, place.y, place.z) for place in places] == [(4.0, 1.0, -0.2), (8.0, -1.0, 0.1)]

    states = swim.node.create_publisher(SwimState, "swim_state", 10)
    swim.until(lambda: states.get_subscription_count(), "subscriber of swim_state")
    states.publish(SwimState(greatest_torque=math.nan))
    pilot.wait_for_output("torque_limit is not kept: swim_state holds no torque", LIMIT)
    swim.node.destroy_publisher(states)

    swim.listen("/diagnostics", DiagnosticArray)
    pace = ("real_time_factor:=0", "-p", "rate:=50", "-p", "duration:=24", "-p", "subscriber_timeout:=60")
    dynamics = start("dynamics", *space, "torque_limit:=0.05", "-p", *pace, "-p", "estimate_error:=false")
    assert dynamics.wait(2 * LIMIT) == 0 and "ERROR" not in dynamics.output(), dynamics.output()
    pilot.wait_for_output("way point 2 of 2", LIMIT)
    misses = re.findall(r"way point (\d) of 2 reached: (\S+) m from it", pilot.output())
    assert [number for number, _ in misses] == ["1", "2"] and all(float(miss) < 0.25 for _, miss in misses), misses
    pilot.wait_for_output("cannot be reached: no nearer", LIMIT)  # it has no brake, and coasts past the last point
    assert re.search(r"WARN.* the goal .* cannot be reached", pilot.output()), pilot.output()
    assert re.search(r"INFO.* way point 2 of 2 reached", pilot.output()), pilot.output()
    assert "ERROR" not in pilot.output(), pilot.output()
    assert re.search(r"exceeds torque_limit 0.05 N m at X = \S+ m, t = \S+ s", dynamics.output()), dynamics.output()
    swim.close()


@pytest.mark.soak
def test_fins_in_place_of_a_keel_hold_the_roll_of_a_piloted_swim(start, fresh_domain):
    """A course with a turn and a dive; the fins follow the roll, and both nodes end without a word of error."""
    swim = SwimClient(domain=fresh_domain, topics=("head_pose", "odom"))
    swim.listen("fin_states", JointState)
    pilot = start("pilot", "--ros-args", "-p", "lead:=0.02", "-p", "heading:=0.8", "-p", "depth:=0.3")
    swim.until(lambda: swim.node.count_publishers("curvature_samples"), "the pilot")
    pace = ("real_time_factor:=0", "-p", "rate:=50", "-p", "duration:=30", "-p", "subscriber_timeout:=60")
    everything = ("-p", "wait_for_subscribers:=2")  # of odom: the pilot and this client
    bare = ("-p", "scene.internal_wrench:=false", "-p", "estimate_error:=false")
    dynamics = start("dynamics", "--ros-args", "-p", f"fins:={PAIR}", "-p", *pace, *everything, *bare)
    assert dynamics.wait(2 * LIMIT) == 0 and "ERROR" not in dynamics.output(), dynamics.output()
    swim.until(lambda: len(swim.received["head_pose"]) > 1500, "the last pose")
    last = [pose.pose for pose in swim.received["head_pose"][-50:]]  # a period
    assert np.mean([pose.position.z for pose in last]) == pytest.approx(-0.3, abs=0.03)
    quaternions = [(q.x, q.y, q.z, q.w) for q in (pose.orientation for pose in last)]
    assert np.mean([heading(q) for q in quaternions]) == pytest.approx(0.8, abs=0.05)
    assert np.abs([roll(q) for q in quaternions]).max() < 0.02
    angles = np.array([state.position for state in swim.received["fin_states"]])
    assert np.array_equal(angles[:, 0], -angles[:, 1]) and 0.05 < np.abs(angles).max() < 0.6
    assert np.abs(angles[-50:]).max() < 0.05 and "ERROR" not in pilot.output(), pilot.output()
    swim.close()
