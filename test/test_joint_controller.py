# SPDX-License-Identifier: Apache-2.0
"""The template of a controller that commands joints, docs/examples/joint_controller.py, with the dynamics node."""

import math
import sys
from pathlib import Path

import pytest
from nav_msgs.msg import Odometry
from swim_client import LIMIT, SwimClient, nanoseconds

from eel_dynamics import Robot, Simulation
from eel_gaits import Law

EXAMPLE = Path(__file__).resolve().parents[1] / "docs" / "examples" / "joint_controller.py"
ROBOT = ("robot:=sixteen_servos", "rate:=50", "duration:=14", "estimate_error:=false", "stations:=21")


@pytest.fixture
def control(monkeypatch):
    monkeypatch.syspath_prepend(EXAMPLE.parent)
    from joint_controller import HeadingAndDepth

    return HeadingAndDepth(0.6, 0.3)


def swim_with(start, domain, *parameters):
    """Poses of the head by stamp [s], of a run with the controller, and what the dynamics node said."""
    swim = SwimClient(domain=domain, topics=())
    swim.listen("odom", Odometry)
    node = start("dynamics", "--ros-args", *(word for each in (*ROBOT, *parameters) for word in ("-p", each)))
    start(sys.executable, EXAMPLE, "--ros-args", "-p", "heading:=0.6", "-p", "depth:=0.3")
    swim.until(lambda: swim.received["odom"] and swim.received["odom"][-1].header.stamp.sec >= 14, "the end", 2 * LIMIT)
    assert node.wait(LIMIT) == 0 and "ERROR" not in node.output(), node.output()
    poses = {round(1e-9 * nanoseconds(each.header.stamp), 6): each.pose.pose for each in swim.received["odom"]}
    swim.close()
    return poses, node.output()


def holds(pose):
    yaw = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
    return yaw == pytest.approx(0.6, abs=0.15) and pose.position.z == pytest.approx(-0.3, abs=0.1)


def test_it_holds_heading_and_depth_in_lockstep_as_in_one_process(start, fresh_domain, control):
    words = ("real_time_factor:=0", "wait_for:=joint_commands", "wait_for_subscribers:=2", "subscriber_timeout:=60")
    poses, said = swim_with(start, fresh_domain, *words)
    assert "WARN" not in said and holds(poses[14.0]), said
    library = Simulation(robot=Robot.named("sixteen_servos"), law=Law(), stations=21)
    for k in range(101):
        now = library.observe(wrench=False, load=False)
        seen = poses[round(0.02 * k, 6)]
        assert (seen.position.x, seen.position.y, seen.position.z) == pytest.approx(now.position.tolist(), abs=1e-9)
        for joint, angle in control.angles(k / 50.0, now.position, now.orientation).items():
            library.command(joint, position=angle)
        library.advance((k + 1) / 50.0)


@pytest.mark.soak
def test_it_holds_heading_and_depth_where_nobody_waits(start, fresh_domain):
    poses, said = swim_with(start, fresh_domain, "real_time_factor:=3", "accuracy:=draft")
    assert holds(poses[14.0]), said
