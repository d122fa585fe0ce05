# SPDX-License-Identifier: Apache-2.0
"""The heading controller and the dynamics node together: it starts the run by itself, and steers it to its target."""

import inspect
import math
import sys
from pathlib import Path

import pytest
from eel_gaits.ros.heading_controller import HeadingController
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from swim_client import LIMIT, SwimClient, nanoseconds
from tf2_msgs.msg import TFMessage

from eel_msgs.msg import SwimState

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture
def swim(fresh_domain):
    swim = SwimClient(domain=fresh_domain, topics=())
    yield swim
    swim.close()


def heading(odometry) -> float:
    """Heading [rad] of the head, positive to the left."""
    q = odometry.pose.pose.orientation
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


def test_the_heading_controller_turns_left_and_right_and_repeats_itself(start, swim):
    """Three eels in namespaces of their own, as fast as possible, in lockstep; two of them have the same target, and
    one of these follows the clock of the other. The gait makes the head swing, so the heading is the mean over the last
    two periods."""
    targets = {"again": 0.6, "left": 0.6, "right": -0.6}
    clocks = {"again": "follow_clock:=true", "left": "clock:=true", "right": "clock:=false"}
    for name in targets:
        swim.listen(f"/{name}/odom", Odometry)
    nodes = []
    for name, target in targets.items():
        space = ("--ros-args", "-r", f"__ns:=/{name}", "-p")
        pace = (
            "real_time_factor:=0",
            "-p",
            "duration:=8",
            "-p",
            "rate:=50",
            "-p",
            "estimate_error:=false",
            "-p",
            clocks[name],
        )
        nodes.append(start("dynamics", *space, *pace, "-p", "wait_for_subscribers:=2", "-p", "subscriber_timeout:=60"))
        start("heading_controller", *space, f"heading:={target}", "-p", "period:=0.02")
        nodes[-1].wait_for_output("waiting for", LIMIT)
    runs = [swim.received[f"/{name}/odom"] for name in targets]

    def ended():
        return all(run and run[-1].header.stamp.sec >= 8 for run in runs)

    swim.until(ended, "the ends of the runs", 2 * LIMIT)
    for node in nodes:
        assert node.wait(LIMIT) == 0 and "ERROR" not in node.output() and "run out" not in node.output(), node.output()
    again, left, right = ({nanoseconds(each.header.stamp): each for each in run} for run in runs)
    assert len(left) == 401
    assert {stamp: left[stamp].pose.pose for stamp in left} == {stamp: again[stamp].pose.pose for stamp in again}
    for run, target in ((left, 0.6), (right, -0.6)):
        last = [heading(each) for stamp, each in run.items() if stamp > 6 * 10**9]
        assert sum(last) / len(last) == pytest.approx(target, abs=0.2)


def swim_with_everything_on(start, swim, seconds, pace, controller=()):
    """The dynamics node with estimate, joints and all frames on, a subscriber of each, and the heading controller at
    100 Hz; what the two have said."""
    for topic, kind in (
        ("odom", Odometry),
        ("joint_states", JointState),
        ("swim_state", SwimState),
        ("/tf", TFMessage),
    ):
        swim.listen(topic, kind)
    settings = ("yaw_joints:=10", "pitch_joints:=10", "publish_tf_stations:=true", f"duration:={seconds}", *pace)
    node = start("dynamics", "--ros-args", *(word for each in settings for word in ("-p", each)))
    steering = start("heading_controller", "--ros-args", *controller)
    swim.until(lambda: node.status is not None, "the end of the run", 2 * LIMIT + 2 * seconds)
    assert node.status == 0, node.output()
    return node.output(), steering.output()


@pytest.mark.fault(
    "samples", "estimate, joints and frames on, at 100 Hz in lockstep", "no sample is late, none is lacking"
)
def test_a_run_with_everything_on_has_every_sample_it_needs(start, swim):
    """With a period that is no multiple of 1/rate."""
    pace = ("real_time_factor:=0", "wait_for_subscribers:=1", "subscriber_timeout:=60")
    said, _ = swim_with_everything_on(start, swim, 3, pace, ("-p", "period:=0.016"))
    assert "curvature samples adopted at t = 0.01 s" in said and "finished at t = 3 s" in said, said
    assert "WARN" not in said and "ERROR" not in said, said


BUSY = "import time\nprint('busy', flush=True)\nwhile True: pass"


@pytest.mark.soak
@pytest.mark.fault(
    "load",
    "estimate, joints and frames on, at 100 Hz in real time for a minute, two busy processes beside it (`make soak`)",
    "the samples of the heading controller never run out",
)
@pytest.mark.timeout(400)
def test_a_minute_in_real_time_beside_two_busy_processes_has_no_run_out(start, swim):
    for _ in range(2):
        start(sys.executable, "-c", BUSY).wait_for_output("busy")
    said, _ = swim_with_everything_on(start, swim, 60, ())
    print(said)
    assert "finished at t = 60 s" in said and "run out" not in said and "refused" not in said, said


def test_the_page_names_the_controller():
    page = (ROOT / "docs/tutorials/own_controller.md").read_text()
    lines = len(inspect.getsource(inspect.getmodule(HeadingController)).splitlines())
    assert f"`{HeadingController.next_bend.__name__}`" in page and "ros/heading_controller.py), 100 lines" in page
    assert 90 <= lines <= 130, lines


@pytest.mark.soak
def test_a_parameter_file_for_all_nodes_makes_none_warn_of_the_others_names(start, tmp_path):
    """One file with names of each node under /**; a name that nobody has is named by the node that has one like it."""
    path = tmp_path / "all.yaml"
    recording = tmp_path / "run.rrd"
    path.write_text(
        "/**:\n  ros__parameters:\n    gait: turning\n    left_bend: 1.0\n    rate: 50.0\n    stations: 21\n"
        "    scene:\n      planar: true\n    heading: 0.3\n    periods: 2.0\n"
        f"    sink: [save]\n    recording: {recording}\n"
    )
    words = {"dynamics": "waiting for", "gait_generator": "published on", "visualiser": "saving to"}
    nodes = {name: start(name, "--ros-args", "--params-file", str(path)) for name in (*words, "heading_controller")}
    for name, text in words.items():
        nodes[name].wait_for_output(text, LIMIT)
    nodes["heading_controller"].wait_for_output("did you mean", LIMIT)
    for name in ("dynamics", "visualiser"):
        assert "not parameters of this node" not in nodes[name].output(), nodes[name].output()
    for name in ("gait_generator", "heading_controller"):
        said = [line for line in nodes[name].output().splitlines() if "not parameters of this node" in line]
        assert len(said) == 1 and said[0].endswith("ignored: 'periods' (did you mean 'period'?)"), said
