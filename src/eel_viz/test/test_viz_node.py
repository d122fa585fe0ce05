# SPDX-License-Identifier: Apache-2.0
"""The visualiser as a process, over DDS: nothing is lost, nothing bad comes through, and it ends well."""

import re
import signal
import subprocess
import time
from dataclasses import fields
from pathlib import Path

import made_up
import numpy as np
import pytest
from eel_viz.recording.reading import read
from eel_viz.settings import BLUEPRINTS, Settings
from eel_viz.viewer import native_viewer
from fake_swimmer import TOPICS, arrived, body_message, found, messages

from eel_viz import entities

SWIMMER = str(Path(__file__).with_name("fake_swimmer.py"))
SAMPLED = (
    entities.POSITION,
    entities.SPEED,
    entities.ODOMETRY_NUMBERS,
    entities.BACKBONE,
    entities.CURVATURE_NUMBERS,
    entities.WRENCH_NUMBERS,
    entities.LOAD_NUMBERS,
    entities.POWER,
)


def verify(path):
    """Rerun's own check of a file that is complete."""
    done = subprocess.run([native_viewer(), "rrd", "verify", str(path)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stdout + done.stderr


def visualise(start, recording, *parameters, **remap):
    settings = ["sink:=[save]", f"recording:={recording}", *parameters]
    arguments = [word for setting in settings for word in ("-p", setting)]
    node = start("visualiser", "--ros-args", *arguments, *[word for rule in remap.values() for word in ("-r", rule)])
    node.wait_for_output("saving to")
    return node


def test_a_run_without_a_pace_is_complete_and_a_reset_begins_a_second_file(start, fresh_domain, tmp_path):
    count, rate = 101, 100.0
    node = visualise(start, tmp_path / "run.rrd", "stop_with_publisher:=true")
    swimmer = start("python", SWIMMER, "1.0", "100.0", "51", "1", "2")
    assert node.wait(90.0) == 0, node.output() + swimmer.output()
    for topic in TOPICS:
        assert f"{topic} {2 * count}" in node.output()
    stamps = [round(k * 1e9 / rate) for k in range(count)]
    for name in ("run.rrd", "run-2.rrd"):
        verify(tmp_path / name)
        for entity in SAMPLED:
            np.testing.assert_array_equal(read(tmp_path / name, entity).stamps, stamps, err_msg=f"{name} {entity}")
        assert read(tmp_path / name, entities.SKIN)["vertex_positions"].shape[0] == 26  # 25 Hz
        model = made_up.Swimmer()
        wrench = read(tmp_path / name, entities.WRENCH_NUMBERS)
        for field in ("torque_3", "force_1"):
            expected = [model.wrench(stamp * 1e-9)[field] for stamp in stamps]
            np.testing.assert_array_equal(wrench[field], expected)
        expected = [model.head(stamp * 1e-9)["position"] for stamp in stamps]
        np.testing.assert_array_equal(read(tmp_path / name, entities.POSITION)["scalars"], expected)
    assert "went back from 1 s to 0 s" in node.output()


@pytest.mark.fault(
    "ending",
    "SIGINT or SIGTERM while the visualiser records",
    "prompt exit, status 0; the file passes Rerun's own check",
)
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_in_mid_run_leaves_a_complete_file(start, network, tmp_path, sent):
    publishers = {topic: network.create_publisher(kind, topic, 1000) for topic, kind in TOPICS.items()}
    node = visualise(start, tmp_path / "run.rrd")
    found(*publishers.values())
    model = made_up.Swimmer(11)
    for k in range(150):
        for topic, message in messages(model, k * 10**7).items():
            publishers[topic].publish(message)
        if k == 100:
            arrived(*publishers.values())
    assert node.interrupt(sent) == 0, node.output()
    assert "Traceback" not in node.output()
    assert "received: " in node.output()
    verify(tmp_path / "run.rrd")
    stamps = read(tmp_path / "run.rrd", entities.POSITION).stamps
    assert len(stamps) > 100
    np.testing.assert_array_equal(stamps, np.arange(len(stamps)) * 10**7)


@pytest.mark.fault(
    "neighbours",
    "messages with NaN, sizes that do not fit, quaternions of another norm",
    "the visualiser says each once, leaves it out and shows the rest",
)
def test_bad_messages_are_said_once_each_and_the_rest_goes_on(start, network, tmp_path):
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    from eel_msgs.msg import BodyGeometry

    latched = QoSProfile(depth=5, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publishers = {topic: network.create_publisher(kind, topic, 100) for topic, kind in TOPICS.items()}
    body = network.create_publisher(BodyGeometry, "body", latched)
    node = visualise(start, tmp_path / "run.rrd")
    found(*publishers.values(), body)

    def send(k, stations=11, spoil=lambda sample: None):
        sample = messages(made_up.Swimmer(stations), k * 10**8)
        spoil(sample)
        for topic, message in sample.items():
            publishers[topic].publish(message)

    def nan_everywhere(sample):
        sample["head_pose"].pose.position.x = float("nan")
        sample["head_twist"].twist.angular.y = float("nan")
        sample["backbone"].position[5] = float("inf")
        sample["internal_wrench"].torque_3[2] = float("nan")
        sample["energy"].residual = float("nan")

    def sizes_that_do_not_fit(sample):
        sample["backbone"].orientation = sample["backbone"].orientation[:-1]
        sample["hydrodynamic_load"].force_2 = []
        sample["curvature"].yaw = [1.0] * 12

    def no_unit_quaternions(sample):
        sample["head_pose"].pose.orientation.w = 3.0

    send(0)  # profiles before the body is known
    for k, spoil in enumerate((nan_everywhere, sizes_that_do_not_fit, no_unit_quaternions), start=1):
        for _ in range(3):
            send(k, spoil=spoil)
    node.wait_for_output("no body has come: the backbone is drawn as a line, without skin")
    bad, worse = body_message(11), body_message(11)
    bad.half_width[3] = -1.0
    worse.half_height[3] = -1.0
    for each in (bad, body_message(11), worse):
        body.publish(each)
    node.wait_for_output("half_height has negative values")  # by then it has the good one
    send(4, stations=2)
    send(5, stations=101)
    send(6)
    arrived(*publishers.values())
    assert node.interrupt() == 0, node.output()
    output = node.output()
    for words in (
        "head_pose: position has values that are not finite",
        "head_pose: orientation must have quaternions of unit norm",
        "head_twist: angular has values that are not finite",
        "backbone: position has values that are not finite",
        "backbone: orientation must have 44 numbers to fit x, got 43",
        "internal_wrench: torque_3 has values that are not finite",
        "hydrodynamic_load: force_2 must have 11 numbers to fit x, got 0",
        "curvature: yaw must have 11 numbers to fit x, got 12",
        "energy: residual is nan",
        "backbone has 2 stations: the shape between them is a guess",
        "backbone has 2 stations and had 11: it is drawn, its envelope begins anew",
        "internal_wrench has 2 stations and had 11",
        "no body has come",
        "body: half_width has negative values, the least is -1 m",
        "body: half_height has negative values, the least is -1 m",
    ):
        assert output.count(words) == 1, f"{words}\n{output}"
    assert "Traceback" not in output
    for entity in (entities.POSITION, entities.SPEED, entities.BACKBONE, entities.WRENCH_NUMBERS, entities.POWER):
        columns = read(tmp_path / "run.rrd", entity)
        assert {0, 4 * 10**8, 5 * 10**8, 6 * 10**8} <= set(columns.stamps.tolist()), entity
        for name, rows in columns.values.items():
            assert all(np.all(np.isfinite(row)) for row in rows), f"{entity} {name}"
    skins = read(tmp_path / "run.rrd", entities.SKIN)
    assert {4 * 10**8, 5 * 10**8, 6 * 10**8} <= set(skins.stamps_of["vertex_positions"].tolist())
    verify(tmp_path / "run.rrd")


@pytest.mark.fault("parameters", "a bad parameter of the visualiser", "one line, status 2")
def test_what_cannot_be_is_refused_in_one_line_with_status_2(start_in_turn, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    cannot_be = {
        "sink:=[floppy]": "sink must be some of spawn, connect, serve, save or auto, got 'floppy'",
        "sink:=7": "sink must be a list of texts, got 7",
        "rate:=0": "rate must be >= 0.1 Hz",
        "rate:=0.0": "rate",
        "rate:=often": "rate must be a number, got 'often'",
        "port:=1": "port",
        "compare:=/": "compare must be another namespace than the swimmer's own, got '/'",
        "blueprint:=mine": f"blueprint must be one of {', '.join(BLUEPRINTS)}, got 'mine'",
    }
    lines = [["--ros-args", "-p", "sink:=[save]", "-p", setting] for setting in cannot_be]
    for words, (status, said) in zip(cannot_be.values(), start_in_turn("eel_viz.ros.node", lines), strict=True):
        assert status == 2 and said.count("\n") == 1 and words in said, said


@pytest.mark.fault("names", "words for the visualiser that are no ROS arguments", "one line, status 2; --help: a usage")
@pytest.mark.parametrize(
    ("word", "status", "beginning", "rows"),
    [
        ("--help", 0, "usage: visualiser [--ros-args -p NAME:=VALUE ...]\n", len(fields(Settings))),
        ("--rosargs", 2, "visualiser: unknown argument '--rosargs' (parameters come after --ros-args", 0),
    ],
)
def test_words_that_are_no_ros_arguments(start, tmp_path, monkeypatch, word, status, beginning, rows):
    folder = tmp_path / "empty"
    folder.mkdir()
    monkeypatch.chdir(folder)
    node = start("visualiser", word, "--ros-args", "-p", "sink:=[save]")
    assert node.wait(90.0) == status
    assert node.output().startswith(beginning)
    assert len(re.findall(r"^  \w", node.output(), re.MULTILINE)) == rows
    assert list(folder.iterdir()) == []


def test_parameters_take_integers_and_describe_themselves(start, network, tmp_path):
    from rclpy.parameter_client import AsyncParameterClient

    node = visualise(
        start, tmp_path / "run.rrd", "rate:=10", "torque_limit:=2", "stop_with_publisher:=false", "ratio:=3"
    )
    assert "not parameters of this node, ignored: 'ratio'\n" in node.output()
    client = AsyncParameterClient(network, "visualiser")
    assert client.wait_for_services(timeout_sec=90.0)

    def ask(future):
        network.executor_of_test.spin_until_future_complete(future, timeout_sec=90.0)
        return future.result()

    described = {one.name: one for one in ask(client.describe_parameters(["rate", "sink", "port"])).descriptors}
    assert described["rate"].read_only
    assert "samples per second" in described["rate"].description
    assert described["rate"].floating_point_range[0].from_value == 0.1
    assert described["port"].integer_range[0].to_value == 65535
    assert "spawn (a viewer window)" in described["sink"].description
    values = ask(client.get_parameters(["use_sim_time", "blueprint"])).values
    assert values[0].bool_value
    assert values[1].string_value == "overview"
    assert node.interrupt() == 0


def test_a_namespace_keeps_swimmers_apart(start, network, tmp_path):
    node = visualise(start, tmp_path / "run.rrd", space="__ns:=/second")
    mine = network.create_publisher(TOPICS["head_pose"], "/second/head_pose", 100)
    other = network.create_publisher(TOPICS["head_pose"], "/head_pose", 100)
    found(mine)
    for k in range(5):
        message = messages(made_up.Swimmer(5), k * 10**8)["head_pose"]
        other.publish(messages(made_up.Swimmer(5), (k + 50) * 10**8)["head_pose"])
        mine.publish(message)
    arrived(mine)
    assert node.interrupt() == 0
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.POSITION).stamps, np.arange(5) * 10**8)


def test_a_law_that_is_received_from_either_kind_of_publisher_is_shown_once(start, network, tmp_path):
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    from eel_msgs.msg import CurvatureLaw

    latched = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    early = network.create_publisher(CurvatureLaw, "curvature_law", latched)
    early.publish(CurvatureLaw(name="before the start"))
    node = visualise(start, tmp_path / "run.rrd")
    volatile = network.create_publisher(CurvatureLaw, "curvature_law", 10)
    deadline = time.monotonic() + 90
    while (early.get_subscription_count(), volatile.get_subscription_count()) != (2, 1):
        assert time.monotonic() < deadline, "its two subscriptions were not found"
        time.sleep(0.02)
    for name in ("one", "two", "one"):
        early.publish(CurvatureLaw(name=name))
    volatile.publish(CurvatureLaw(name="volatile"))
    arrived(early, volatile)
    assert node.interrupt() == 0
    texts = [row[0] for row in read(tmp_path / "run.rrd", entities.LOG)["text"]]
    from_early = ["before the start", "one", "two", "one"]
    assert sorted(texts) == sorted(f"law {name!r} published" for name in (*from_early, "volatile"))
    live = [text for text in texts if "'one'" in text or "'two'" in text]
    assert live == [f"law {name!r} published" for name in from_early[1:]]


def test_served_data_reaches_a_viewer_that_comes_later(start, network, tmp_path, can_draw):
    from eel_viz.viewer import free_port, viewer

    port, web = free_port(), free_port()
    settings = ["sink:=[serve, save]", f"recording:={tmp_path / 'run.rrd'}", f"port:={port}", f"web_port:={web}"]
    node = start("visualiser", "--ros-args", *[word for setting in settings for word in ("-p", setting)])
    node.wait_for_output(f"http://127.0.0.1:{web}/")
    publisher = network.create_publisher(TOPICS["head_twist"], "head_twist", 100)
    found(publisher)
    for k in range(20):
        publisher.publish(messages(made_up.Swimmer(5), k * 10**8)["head_twist"])
    arrived(publisher)
    with viewer((640, 360)) as client:
        client.open([f"rerun+http://127.0.0.1:{port}/proxy"])
        deadline = time.monotonic() + 90
        ends = []
        while time.monotonic() < deadline and 19 * 10**8 not in ends:
            time.sleep(0.3)
            recordings = client.get_state().recordings
            ends = [
                timeline.end for one in recordings for timeline in one.timelines if timeline.name == entities.TIMELINE
            ]
        assert 19 * 10**8 in ends
        titles = {"Internal torque C(X)", "Speed of the head [m/s]", "Log"}
        while not titles <= {view.name for view in client.get_state().views}:
            assert time.monotonic() < deadline, "our arrangement is not shown"
            time.sleep(0.3)
    assert node.interrupt() == 0, node.output()
    verify(tmp_path / "run.rrd")
    assert len(read(tmp_path / "run.rrd", entities.SPEED).stamps) == 20


@pytest.mark.parametrize(("own", "compare"), [("", "second"), ("/second", "/")])
def test_another_swimmer_is_laid_over_the_first(own, compare, start, network, tmp_path):
    node = visualise(
        start,
        tmp_path / "run.rrd",
        f"compare:={compare}",
        "blueprint:=compare",
        **({"space": f"__ns:={own}"} if own else {}),
    )
    mine, others = (
        {topic: network.create_publisher(kind, f"{space}/{topic}", 100) for topic, kind in TOPICS.items()}
        for space in (own, "" if own else "/second")
    )
    found(*mine.values(), *others.values())
    count = 20
    for k in range(count):
        for publishers, offset in ((mine, 0.0), (others, 0.25)):
            swimmer = made_up.Swimmer(11, offset=(0.0, offset, 0.0))
            for topic, message in messages(swimmer, k * 10**7).items():
                publishers[topic].publish(message)
    arrived(*mine.values(), *others.values())
    assert node.interrupt() == 0, node.output()
    distance = read(tmp_path / "run.rrd", entities.DISTANCE)
    np.testing.assert_array_equal(distance.stamps, np.arange(count) * 10**7)
    np.testing.assert_allclose(distance["scalars"], 0.25, rtol=1e-12)
    difference = read(tmp_path / "run.rrd", entities.TORQUE_DIFFERENCE_MOST)
    np.testing.assert_array_equal(difference["scalars"], np.zeros((count, 1)))
    assert "went back" not in node.output()
