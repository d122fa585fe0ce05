# SPDX-License-Identifier: Apache-2.0
"""No message ends a node, whatever it holds: every subscription receives the extremes of each field, over DDS."""

import time

import pytest
import rclpy
from builtin_interfaces.msg import Time
from eel_gaits.ros.messages import law_to_message
from eel_viz.recording.reading import read
from eel_viz.topics import OWN
from extreme_messages import broken, extremes, get_message
from fake_swimmer import TOPICS, messages
from gait_client import GaitClient
from made_up import Swimmer
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from swim_client import LIMIT, SwimClient, is_finite

from eel_gaits import falling
from eel_viz import entities

# every subscription goes with it; more deep than there are messages
ANYBODY = QoSProfile(depth=5000, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def network(fresh_domain):
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=fresh_domain)
    node = rclpy.create_node("stranger", context=context, start_parameter_services=False)
    yield node
    node.destroy_node()
    rclpy.try_shutdown(context=context)


def wait_for_subscriber(publisher) -> None:
    """Until there is one."""
    deadline = time.monotonic() + LIMIT
    while not publisher.get_subscription_count():
        assert time.monotonic() < deadline, f"nobody subscribes to {publisher.topic_name}"
        time.sleep(0.02)


def send_extremes(network, node, name, least) -> None:
    """To each topic that the node `name`, the process `node`, subscribes to; to those in `least` at least."""
    deadline = time.monotonic() + LIMIT
    received = {}
    while not set(least) <= received.keys():
        assert time.monotonic() < deadline, f"{name} does not subscribe to {least}: {received}"
        if name in network.get_node_names():
            received = dict(network.get_subscriber_names_and_types_by_node(name, "/"))
        time.sleep(0.1)
    for topic, (kind, *_) in received.items():
        publisher = network.create_publisher(get_message(kind), topic, ANYBODY)
        wait_for_subscriber(publisher)
        for message in [*extremes(get_message(kind)), *broken(get_message(kind))]:
            publisher.publish(message)
        publisher.wait_for_all_acked(Duration(seconds=LIMIT))
        assert node.status is None, f"{topic} ended {name}:\n{node.output()[-3000:]}"
        network.destroy_publisher(publisher)
    assert "Traceback" not in node.output()


@pytest.mark.fault(
    "laws",
    "bytes that are no message, on any topic of a node",
    "left out; at most one line a second and topic, with the count; the node stays up",
)
@pytest.mark.parametrize(
    ("executable", "topics"),
    [
        ("pilot", ("odom", "goal_path", "goal_pose", "/clock")),
        pytest.param("dynamics", ("curvature_samples", "/diagnostics"), marks=pytest.mark.soak),
        pytest.param("visualiser", ("head_pose", "odom", "backbone"), marks=pytest.mark.soak),
        pytest.param("markers", ("backbone", "internal_wrench", "/clock"), marks=pytest.mark.soak),
        pytest.param("heading_controller", ("odom",), marks=pytest.mark.soak),
        pytest.param("gait_generator", ("/clock",), marks=pytest.mark.soak),
    ],
)
def test_bytes_that_are_no_message_are_a_line_a_second(executable, topics, start, network, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # of the visualiser's file
    began, many = time.monotonic(), 200
    node = start(executable)
    for topic in topics:
        kind = {"/clock": "rosgraph_msgs/msg/Clock", "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray"}
        kind |= {"goal_path": "nav_msgs/msg/Path", "goal_pose": "geometry_msgs/msg/PoseStamped", **OWN}
        publisher = network.create_publisher(get_message(kind[topic]), topic, ANYBODY)
        wait_for_subscriber(publisher)
        for _ in range(many):
            publisher.publish(b"\x00\x01\x00\x00" + b"\xff" * 5)
            time.sleep(0.002)  # some histories keep one message
    for topic in topics:
        node.wait_for_output(f"/{topic.lstrip('/')} cannot be taken and is left out (")
    assert node.interrupt() == 0
    said, seconds = node.output().splitlines(), time.monotonic() - began
    assert all(line.startswith(("[INFO]", "[ERROR]", "[WARN]")) for line in said), said[:20]
    for topic in topics:
        lines = [line for line in said if f"message of /{topic.lstrip('/')} cannot be taken" in line]
        assert len(lines) <= seconds + 1 and "so far)" in lines[-1], lines


@pytest.mark.fault(
    "laws",
    "laws, samples and /clock with any extreme in any field, cut short, or with text that is no UTF-8",
    "the dynamics node refuses what it cannot take, publishes finite numbers and takes the next law",
)
def test_the_dynamics_node_stands_any_message(start, network, fresh_domain):
    swim = SwimClient(domain=fresh_domain, topics=("head_pose", "curvature"))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", "-p", "use_sim_time:=true", "-p", "clock:=false")
    swim.until_time(0.2)
    send_extremes(network, node, "dynamics", {"/curvature_law", "/curvature_samples", "/clock"})
    assert swim.reset().success
    swim.laws.publish(law_to_message(falling(period=0.9)))
    swim.until(lambda: node.output().count("law 'falling' adopted") > 1, "the next law")
    assert swim.reset().success  # warnings of what the laws before it did last until then
    swim.until_time(0.5)
    assert all(is_finite(message) for topic in ("head_pose", "curvature") for message in swim.received[topic])

    def own():  # there are the extreme ones too
        return [
            each for message in swim.received["/diagnostics"] for each in message.status if each.name == "/dynamics"
        ]

    swim.until(lambda: own() and own()[-1].message == "swimming", "good diagnostics")
    swim.close()
    assert node.interrupt() == 0 and "Traceback" not in node.output()


@pytest.mark.fault(
    "time", "/clock with a negative time, or any other", "said and left out; the gait generator goes on with the next"
)
def test_the_gait_generator_stands_any_message(start, network, fresh_domain):
    node = start("gait_generator")
    send_extremes(network, node, "gait_generator", {"/clock"})
    clock, before = network.create_publisher(Clock, "/clock", 10), Clock(clock=Time(sec=-1))
    deadline = time.monotonic() + LIMIT
    while "a message of /clock cannot be taken" not in node.output():  # it looks at the newest one now and then
        assert time.monotonic() < deadline, node.output()
        clock.publish(before)
        time.sleep(0.05)
    client = GaitClient(domain=fresh_domain)
    client.listen()
    try:
        client.tick_until(7.0, lambda: client.set(gait="straight")[0].successful and client.messages, "the law")
        client.tick_until(7.0, lambda: client.set(gait="falling")[0].successful and client.latest()[1] == 7.0, "time")
    finally:
        client.close()
    assert node.interrupt() == 0 and "Traceback" not in node.output()


def positions(path) -> list:
    """The head's positions in a recording."""
    try:
        return read(path, entities.POSITION)["scalars"].tolist()
    except ValueError:  # it has none
        return []


@pytest.mark.fault(
    "neighbours",
    "any topic of a swimmer with any extreme in any field, cut short, or with text that is no UTF-8",
    "the visualiser leaves out what it cannot show, and shows what comes next",
)
def test_the_visualiser_stands_any_message(start, network, tmp_path):
    node = start("visualiser", "--ros-args", "-p", "sink:=[save]", "-p", f"recording:={tmp_path}/run.rrd")
    node.wait_for_output("saving to", LIMIT)
    others = {"/body", "/curvature_law", "/diagnostics", "/clock"}
    send_extremes(network, node, "visualiser", {f"/{topic}" for topic in TOPICS} | others)
    publisher = network.create_publisher(TOPICS["head_pose"], "head_pose", 10)
    wait_for_subscriber(publisher)
    good = messages(Swimmer(11), 2**31 * 10**9 - 10**9)["head_pose"]  # later than any
    publisher.publish(good)
    assert publisher.wait_for_all_acked(Duration(seconds=LIMIT))
    assert node.interrupt() == 0 and "Traceback" not in node.output(), node.output()[-3000:]
    here = good.pose.position
    assert [here.x, here.y, here.z] in [row for path in tmp_path.glob("run*.rrd") for row in positions(path)]
