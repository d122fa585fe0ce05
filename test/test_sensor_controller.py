# SPDX-License-Identifier: Apache-2.0
"""By sensors alone: docs/examples/sensor_controller.py, its filter against the truth, and ekf.yaml beside the node."""

import inspect
import math
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from eel_common.topics import OWN
from geometry_msgs.msg import PoseStamped
from swim_client import LIMIT, SwimClient, nanoseconds

from eel_dynamics import Imu, Pressure, Robot, SensorSuite, Simulation
from eel_gaits import Law

EXAMPLES = Path(__file__).resolve().parents[1] / "docs" / "examples"
NOISE = {"accelerometer_noise": 0.05, "gyroscope_noise": 0.005, "gyroscope_bias": (0.01, -0.02, 0.015)}
GAUGE = {"noise": 50.0, "bias": 100.0}  # Pa: 5 mm, and 1 cm
LENGTH = 14.0  # s


@pytest.fixture
def example(monkeypatch):
    monkeypatch.syspath_prepend(EXAMPLES)
    import sensor_controller

    return sensor_controller


def swum(control, seconds=LENGTH, rate=50.0):
    """Truth and estimate of heading, roll, pitch [rad] and height [m], (n, 2, 4); the poses of the head."""
    swimmer = Simulation(robot=Robot.named("sixteen_servos"), law=Law(), stations=21, sensors=[0.0])
    suite = SensorSuite([Imu(rate=rate, seed=1, **NOISE), Pressure(rate=rate, seed=1, **GAUGE)], swimmer)
    rows, poses = [], []
    for k in range(round(seconds * rate) + 1):
        swimmer.advance(k / rate)
        now = swimmer.observe(wrench=False, load=False)
        read = suite.read(now)
        imu, height = read["imu"], -read["pressure"].depth
        angles = control.angles(now.time, imu.specific_force, imu.angular_velocity, height)
        for joint, angle in angles.items():
            swimmer.command(joint, position=angle)
        told = control.filter.orientation, control.filter.height
        rows.append([[*attitude(q), z] for q, z in ((now.orientation, now.position[2]), told)])
        poses.append(np.concatenate((now.position, now.orientation)))
    return np.array(rows), np.array(poses)


def attitude(q):
    """Heading, roll and pitch [rad]."""
    x, y, z, w = q
    heading = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    roll = math.atan2(2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))
    return heading, roll, math.asin(2.0 * (w * y - z * x))


def test_the_filter_has_fewer_than_60_lines(example):
    assert len(inspect.getsource(example.ComplementaryFilter).splitlines()) < 60


def test_it_holds_heading_and_depth_by_an_imu_and_a_pressure_gauge(example):
    """With noise, and with biases that the filter finds at rest (gyroscopes) or cannot know (1 cm of the gauge)."""
    rows, _ = swum(example.BySensors(0.6, 0.3))
    error = rows[:, 1] - rows[:, 0]
    heading, roll, pitch, height = np.sqrt(np.mean(np.square(error), axis=0))
    print(f"rms errors: heading {heading:.4f} rad, roll {roll:.4f} rad, pitch {pitch:.4f} rad, height {height:.4f} m")
    assert heading < 0.03 and roll < 0.05 and pitch < 0.03 and height < 0.03
    assert rows[-1, 0, 0] == pytest.approx(0.6, abs=0.15) and rows[-1, 0, 3] == pytest.approx(-0.3, abs=0.1)


@pytest.mark.soak
def test_over_topics_it_swims_as_in_one_process(example, start, fresh_domain):
    """To 1e-5 m after 4 s: servos at their limits make round-off grow, 1e-7 m was seen."""
    swim = SwimClient(domain=fresh_domain, topics=())
    swim.listen("head_pose", PoseStamped)
    settings = {f"imu.{name}": value for name, value in NOISE.items()} | {"imu.seed": 1, "imu.rate": 50.0}
    settings |= {f"pressure.{name}": value for name, value in GAUGE.items()}
    settings |= {"pressure.seed": 1, "pressure.rate": 50.0, "real_time_factor": 0, "wait_for": "joint_commands"}
    settings |= {"robot": "sixteen_servos", "rate": 50, "duration": 4, "estimate_error": "false", "stations": 21}
    settings |= {"wait_for_subscribers": 1, "subscriber_timeout": 60}
    words = [f"{name}:={list(value) if isinstance(value, tuple) else value}" for name, value in settings.items()]
    node = start("dynamics", "--ros-args", *(word for each in words for word in ("-p", each)))
    start(sys.executable, EXAMPLES / "sensor_controller.py", "--ros-args", "-p", "heading:=0.6", "-p", "depth:=0.3")
    poses = swim.received["head_pose"]
    swim.until(lambda: poses and poses[-1].header.stamp.sec >= 4, "the end", 120)
    assert node.wait(LIMIT) == 0 and "WARN" not in node.output(), node.output()
    seen = {nanoseconds(each.header.stamp): each.pose.position for each in poses}
    swim.close()
    _, expected = swum(example.BySensors(0.6, 0.3), 4.0)
    for k in range(0, 201, 10):
        place = seen[20_000_000 * k]
        assert (place.x, place.y, place.z) == pytest.approx(expected[k, :3].tolist(), abs=1e-5)


def test_the_configuration_for_robot_localization_fits_the_topics():
    """Kinds of inputs by their names, 15 truths each, the truth's transform left alone."""
    node = yaml.safe_load((EXAMPLES / "ekf.yaml").read_text())["ekf_filter_node"]["ros__parameters"]
    kinds = {"imu0": "Imu", "pose0": "PoseWithCovarianceStamped", "twist0": "TwistWithCovarianceStamped"}
    for name, kind in kinds.items():
        assert OWN[node[name]].rpartition("/")[2] == kind and len(node[f"{name}_config"]) == 15
    assert [k for k, used in enumerate(node["pose0_config"]) if used] == [2]
    assert [k for k, used in enumerate(node["twist0_config"]) if used] == [6, 7, 8]
    assert node["publish_tf"] is False and node["imu0_remove_gravitational_acceleration"] is True
    assert node["world_frame"] == node["odom_frame"] == "odom" and node["base_link_frame"] == "base_link"
