# SPDX-License-Identifier: Apache-2.0
"""Experiments over DDS that change without a restart: parameters for the next reset, steps, a state of the head."""

import math

import pytest
import yaml
from eel_common.wording import shown
from eel_gaits.ros.messages import law_to_message
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from rcl_interfaces.srv import ListParameters, SetParameters
from rclpy.parameter import parameter_dict_from_yaml_file
from swim_client import LIMIT, nanoseconds

from eel_gaits import Law, Term, falling
from eel_msgs.srv import SetState, Step

AHEAD = Quaternion(w=1.0)


def seconds(message):
    return nanoseconds(message.header.stamp) / 1e9


def state(swim, position=(0.0, 0.0, 0.0), orientation=AHEAD, linear=(0.0, 0.0, 0.0), angular=(0.0, 0.0, 0.0)):
    pose = Pose(position=Point(**dict(zip("xyz", position, strict=True))), orientation=orientation)
    velocities = {"linear": linear, "angular": angular}
    twist = Twist(**{name: Vector3(**dict(zip("xyz", values, strict=True))) for name, values in velocities.items()})
    return swim.call(SetState, "dynamics/set_state", pose=pose, twist=twist)


@pytest.mark.fault(
    "parameters",
    "a body, a scene, a rate or a pose that is set while it runs",
    "checked, with the answer that it acts at the next reset; then the run has it",
)
def test_parameters_that_act_at_the_next_reset(start, client, tmp_path):
    path = tmp_path / "fish.csv"
    rows = [(0, 0, 0), (0.2, 0.02, 0.04), (0.6, 0.02, 0.03), (1.0, 0.01, 0.02), (1.2, 0.005, 0.01)]
    path.write_text("x,half_width,half_height\n" + "\n".join(",".join(map(str, row)) for row in rows) + "\n")
    swim = client(topics=("head_pose", "backbone", "internal_wrench", "energy"))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args")
    swim.until_time(0.2, "internal_wrench")
    changes = {"body": str(path), "rate": 50, "stations": 21, "accuracy": 1e-3, "initial_position": [1.0, 2.0, -3.0]}
    changes |= {"scene.internal_wrench": False, "scene.density": 900, "initial_linear_velocity": [0.1, 0.0, 0.0]}
    changes |= {"scene.metacentric_height": 0.01, "initial_orientation": [0.6, 0.0, 0.0, 0.8]}
    answers = swim.set(**changes)
    assert [(each.successful, each.reason) for each in answers] == [(True, "acts at the next reset")] * len(changes)
    bad = {
        "scene.metacentric_height": float("nan"),
        "body": "whale",
        "initial_orientation": [0.0] * 4,
        "stations": 1,
        "scene.friction": "sticky",
        "rate": 0.0,
    }
    for name, value in bad.items():
        (answer,) = swim.set(**{name: value})
        assert not answer.successful and name.removeprefix("scene.") in answer.reason, answer.reason
    assert len(swim.latest("backbone").x) == 51 and swim.latest("body").length == 1.0
    assert swim.reset().success
    swim.until(
        lambda: len(swim.received["backbone"][-1].x) == 21 and seconds(swim.received["backbone"][-1]) > 0.1, "new run"
    )
    swim.until(lambda: swim.received["body"][-1].length == 1.2, "the new body")
    late = client(topics=())
    assert late.latest("body").length == late.received["body"][0].length == 1.2, "the body of an earlier run"
    swim.until(lambda: any(each.pose.position.y == 2.0 for each in swim.received["head_pose"]), "the new pose")
    first = next(each for each in swim.received["head_pose"] if each.pose.position.y == 2.0)
    assert (first.pose.position.x, first.pose.position.z, seconds(first)) == (1.0, -3.0, 0.0)
    poses = swim.received["head_pose"]
    swim.until(lambda: len(poses) > poses.index(first) + 5, "samples at 50 Hz")
    stamps = [nanoseconds(each.header.stamp) for each in poses[-5:]]
    assert all(stamp % 20_000_000 == 0 for stamp in stamps) and swim.diagnosis()[2]["accuracy"]
    swim.until(lambda: any(each.potential > 0.0 for each in swim.received["energy"]), "energy of the new scene")
    swim.until(lambda: swim.node.count_publishers("internal_wrench") == 0, "the end of a topic")
    assert "ERROR" not in node.output()

    path.unlink()
    assert swim.set(rate=100.0)[0].successful
    before = seconds(swim.latest("head_pose"))
    answer = swim.reset()
    assert not answer.success and f"body file {shown(str(path))}: there is no such file" in answer.message, (
        answer.message
    )
    swim.until_time(before + 0.3)
    assert swim.set(body="boyer2010")[0].successful and swim.reset().success
    swim.until(lambda: swim.received["body"][-1].length == 1.0, "the first body")


def test_a_law_that_the_next_scene_does_not_allow_is_a_refused_reset(start, client):
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    start("dynamics", "--ros-args")
    swim.until_time(0.2)
    assert swim.set(**{"scene.planar": True})[0].reason == "acts at the next reset"
    answer = swim.reset()
    assert not answer.success and "pitch" in answer.message, answer.message
    swim.until_time(seconds(swim.latest("head_pose")) + 0.2)
    swim.laws.publish(law_to_message(Law(Term(amplitude=(1.0,), period=1.0), name="flat")))
    swim.until(lambda: swim.diagnosis()[2]["law"] == "flat", "a planar law")
    assert swim.reset().success


def test_a_node_takes_its_own_dump(start, client, tmp_path):
    """As `ros2 param dump` writes it and `ros2 param load` reads it: every parameter, also those that are read-only.
    The viscosity of water, 1e-06, is a text by then."""
    swim = client(topics=())
    start("dynamics", "--ros-args", "-p", "accuracy:=0.001", "-p", "scene.density:=900")
    names = swim.call(ListParameters, "dynamics/list_parameters").result.names
    assert {"start_type_description_service", "duration", "scene.current", "body"} <= set(names)
    dump = {"/dynamics": {"ros__parameters": dict(zip(names, map(plain, swim.get(*names)), strict=True))}}
    path = tmp_path / "run.yaml"
    path.write_text(yaml.dump(dump))
    parameters = list(parameter_dict_from_yaml_file(str(path), target_nodes=["/dynamics"]).values())
    assert any(each.name == "scene.viscosity" and each.value.string_value == "1e-06" for each in parameters)
    answers = swim.call(SetParameters, "dynamics/set_parameters", parameters=parameters).results
    assert len(answers) == len(names) and all(each.successful for each in answers), answers
    bad = {
        "duration": (5.0, "read-only"),
        "rat": (1.0, "no parameter 'rat' (did you mean 'rate'?)"),
        "rate": ("nan", "rate must be finite, got nan"),
        "scene.planar": (1, "scene.planar must be true or false, got 1"),
        "initial_position": ("[1.0, 2, x]", "initial_position must be 3 finite numbers, got "),
    }
    for answer, (_, told) in zip(
        swim.set(**{name: value for name, (value, _) in bad.items()}), bad.values(), strict=True
    ):
        assert not answer.successful and told in answer.reason, answer.reason


def plain(value):
    """A parameter's value without arrays, which YAML does not know."""
    return value if isinstance(value, (bool, int, float, str)) else list(value)


@pytest.mark.fault(
    "parameters", "0 or 1e12 steps, or a step while it runs", "refused with the field and value; the run goes on"
)
def test_steps_of_a_paused_run(start, client):
    swim = client(topics=("odom",))
    swim.laws.publish(law_to_message(falling()))
    start("dynamics", "--ros-args", "-p", "wait_for_subscribers:=1", "-p", "rate:=50")
    swim.until_time(0.1, "odom")
    answer = swim.call(Step, "dynamics/step", samples=3)
    assert not answer.success and "the run is not paused" in answer.message
    stands = swim.stop_the_clock("odom")
    for samples in (0, 10**12):
        answer = swim.call(Step, "dynamics/step", samples=samples)
        assert not answer.success and answer.message == f"samples must be 1 to 1000000, got {samples}"
    answer = swim.call(Step, "dynamics/step", samples=7)
    assert answer.success and answer.message.startswith("7 samples published, paused at t = ")
    wanted = round((stands + 0.14) * 1e9)
    assert nanoseconds(answer.stamp) == wanted
    swim.until(lambda: nanoseconds(swim.received["odom"][-1].header.stamp) == wanted, "the last step")
    assert swim.reset().success
    answer = swim.call(Step, "dynamics/step", samples=2)
    assert answer.success and nanoseconds(answer.stamp) == 40_000_000


@pytest.mark.fault(
    "parameters", "a state of the head that is not finite, or a zero quaternion", "refused with the field and value"
)
def test_state_of_the_head_is_set_in_mid_run(start, client):
    swim = client(topics=("odom", "energy", "curvature"))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", "-p", "wait_for_subscribers:=1")
    swim.until_time(0.5, "odom")
    bad = {
        "pose.position": {"position": (math.nan, 0.0, 0.0)},
        "pose.orientation": {"orientation": Quaternion(w=0.0)},
        "twist.linear": {"linear": (0.0, math.inf, 0.0)},
        "twist.angular": {"angular": (0.0, math.nan, 0.0)},
    }
    for field, given in bad.items():
        answer = state(swim, **given)
        assert not answer.success and answer.message.startswith(field) and "got" in answer.message, answer.message
    stands = swim.stop_the_clock("odom", "energy")
    turned = Quaternion(z=math.sin(0.5), w=math.cos(0.5))
    assert state(swim, (1.0, 2.0, 3.0), turned, linear=(0.3, 0.0, 0.0)).success
    before = next(each for each in swim.received["energy"] if seconds(each) == stands)
    swim.call(Step, "dynamics/step", samples=1)
    swim.until_time(stands + 0.009, "odom", "energy")
    odometry, energy = swim.received["odom"][-1], swim.received["energy"][-1]
    position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
    assert math.dist((position.x, position.y, position.z), (1.0, 2.0, 3.0)) < 0.02
    assert abs(2.0 * math.atan2(orientation.z, orientation.w) - 1.0) < 0.2
    assert energy.kinetic_body > before.kinetic_body + 0.01  # 1.9 kg at 0.3 m/s
    assert abs(energy.residual - before.residual) < 1e-5
    assert swim.pause(False).success
    swim.until_time(stands + 0.3, "energy")
    assert abs(swim.received["energy"][-1].residual - before.residual) < 1e-4 and "ERROR" not in node.output()


@pytest.mark.fault(
    "subscribers",
    "a subscriber that comes late, at `real_time_factor:=0`",
    "the log says how many samples it has missed",
)
def test_late_subscriber_is_told_what_it_missed_and_an_early_one_misses_nothing(start, client):
    early, late = client(topics=("odom", "backbone")), client(topics=())
    early.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", "-p", "real_time_factor:=0", "-p", "subscriber_timeout:=60")
    for topic in ("odom", "backbone"):
        early.until(lambda topic=topic: len(early.received[topic]) > 300, "300 samples")
        assert [nanoseconds(each.header.stamp) for each in early.received[topic][:300]] == [
            k * 10**7 for k in range(300)
        ]
    assert "came late" not in node.output()
    from nav_msgs.msg import Odometry

    late.listen("odom", Odometry)
    early.until(lambda: "a subscriber of odom came late: it missed" in node.output(), "what it missed", LIMIT)
