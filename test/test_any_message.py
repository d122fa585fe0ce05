# SPDX-License-Identifier: Apache-2.0
"""No message and no call ends a node, or keeps it from ending, whatever it holds: every subscription and every service
receives the extremes of each field, over DDS."""

import signal
import time
from itertools import islice

import pytest
import rclpy
from builtin_interfaces.msg import Time
from eel_common.ros.testing.node_process import PROMPT
from eel_common.ros.testing.service_call import answer_of
from eel_common.topics import OWN
from eel_gaits.ros.messages import law_to_message
from eel_viz.recording.reading import read
from extreme_messages import broken, extremes, for_names, get_message, get_service, huge, stamped
from fake_swimmer import TOPICS, body_message, messages
from gait_client import GaitClient
from geometry_msgs.msg import Vector3Stamped, WrenchStamped
from made_up import Swimmer
from nav_msgs.msg import Odometry, Path
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from swim_client import LIMIT, SwimClient, is_finite, nanoseconds
from visualization_msgs.msg import MarkerArray

from eel_gaits import falling
from eel_msgs.msg import BodyGeometry, CurvatureSamples
from eel_viz import entities

# every subscription goes with it; more deep than there are messages
ANYBODY = QoSProfile(depth=5000, durability=DurabilityPolicy.TRANSIENT_LOCAL)


NODES = {  # name: topics that it subscribes to, at least
    "gait_generator": {"/clock"},
    "heading_controller": {"/odom"},
    "pilot": {"/odom", "/goal_path", "/goal_pose", "/clock"},
    "dynamics": {"/curvature_law", "/curvature_samples", "/clock"},
    "visualiser": {f"/{topic}" for topic in TOPICS} | {"/body", "/curvature_law", "/goal", "/diagnostics", "/clock"},
    "markers": {"/body", "/backbone", "/internal_wrench", "/hydrodynamic_load"},
}
CALLED = "dynamics", "gait_generator"  # whose calls are tried one by one; they share the code with all others


class Network:
    """Somebody who sends to any node whatever messages and calls can hold. node: of rclpy."""

    def __init__(self, domain):
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.node = rclpy.create_node("stranger", context=self.context, start_parameter_services=False)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)

    def until(self, condition, what, node=None):
        """Wait for `condition()`, as long as the process `node` lives; returns its value."""
        deadline = time.monotonic() + LIMIT
        while not (value := condition()):
            assert node is None or node.status is None, f"{node.name} has ended:\n{node.output()[-3000:]}"
            assert time.monotonic() < deadline, f"no {what} within {LIMIT} s"
            self.executor.spin_once(timeout_sec=0.02)
        return value

    def publisher(self, kind, topic, quality=10):
        """A publisher that has a subscriber."""
        publisher = self.node.create_publisher(kind, topic, quality)
        self.until(publisher.get_subscription_count, f"subscriber of {topic}")
        return publisher

    def topics(self, name, least):
        """Type by name of all topics that the node `name` subscribes to, at least those in `least`."""

        def received():
            found = {}
            if name in self.node.get_node_names():
                found = dict(self.node.get_subscriber_names_and_types_by_node(name, "/"))
            return set(least) <= found.keys() and {topic: get_message(kind) for topic, (kind, *_) in found.items()}

        return self.until(received, f"{name} that subscribes to {least}")

    def send(self, topic, kind, messages, node):
        """Send `messages` to the process `node`, and wait until it has them."""
        publisher = self.publisher(kind, topic, ANYBODY)
        for message in messages:
            publisher.publish(message)
        publisher.wait_for_all_acked(Duration(seconds=LIMIT))
        assert node.status is None, f"{topic} ended {node.name}:\n{node.output()[-3000:]}"
        self.node.destroy_publisher(publisher)

    def call(self, kind, name, requests, node):
        """Call a service of the process `node` with one of the `requests` after the other, each of which it answers."""
        service = self.node.create_client(kind, name)
        self.until(service.service_is_ready, f"service {name}")
        for request in requests:
            self.until(answer_of(service, request), f"answer from {name} to {str(request)[:300]}", node)
        self.node.destroy_client(service)


@pytest.fixture
def network(fresh_domain):
    network = Network(fresh_domain)
    yield network
    network.executor.shutdown()
    network.node.destroy_node()
    rclpy.try_shutdown(context=network.context)


def send_extremes(network, node, name, further=()) -> None:
    """To each topic that the node `name`, the process `node`, subscribes to; also to `further` ones.

    Then to what sets its parameters, and to its own services; each call is answered.
    """
    good = {f"/{topic}": message for topic, message in messages(Swimmer(11), 10**9).items()}
    for topic, kind in network.topics(name, NODES[name] | {*further}).items():
        network.send(topic, kind, [*extremes(kind), *broken(kind), *huge(kind)], node)
        if hasattr(kind(), "header") or hasattr(kind(), "clock"):
            network.send(topic, kind, [*stamped(good.get(topic, kind())), *stamped(kind())], node)
    for service, (kind, *_) in network.node.get_service_names_and_types_by_node(name, "/"):
        if not service.rpartition("/")[2].startswith(("get_", "list_", "describe_")):
            requests = extremes(get_service(kind).Request)
            requests = requests if name in CALLED else islice(requests, 5)
            network.call(get_service(kind), service, requests, node)
    assert node.status is None and "Traceback" not in node.output(), node.output()[-3000:]


@pytest.mark.fault(
    "laws",
    "bytes that are no message, on any topic of a node",
    "left out; at most one line a second and topic, with the count; the node stays up",
)
@pytest.mark.parametrize(
    ("executable", "topics"),
    [
        ("pilot", ("odom", "goal_path", "goal_pose", "/clock")),
        pytest.param("dynamics", ("curvature_law", "curvature_samples", "/diagnostics"), marks=pytest.mark.soak),
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
        publisher = network.publisher(get_message(kind[topic]), topic, ANYBODY)
        sent, several = 0, f"/{topic.lstrip('/')} cannot be taken and is left out ("
        while sent < many or several not in node.output():  # some histories keep one message
            assert time.monotonic() - began < LIMIT, node.output()
            publisher.publish(b"\x00\x01\x00\x00" + b"\xff" * 5)
            sent += 1
            time.sleep(0.002)
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
@pytest.mark.parametrize(
    "swimmer",
    [
        (),
        pytest.param(("-p", "robot:=eight_servos"), marks=pytest.mark.soak),
        pytest.param(
            ("-p", "fins:=left station=0.5 area=0.001 aspect_ratio=2.5 angle=commanded time_constant=0.1"),
            marks=pytest.mark.soak,
        ),
    ],
    ids=["imposed", "robot", "fins"],
)
def test_the_dynamics_node_stands_any_message(start, network, fresh_domain, swimmer):
    swim = SwimClient(domain=fresh_domain, topics=("head_pose", "curvature"))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", "-p", "use_sim_time:=true", "-p", "clock:=false", *swimmer)
    swim.until_time(0.2)
    send_extremes(network, node, "dynamics")
    assert swim.pause(False).success and swim.reset().success
    swim.laws.publish(law_to_message(falling(period=0.9)))
    swim.until(lambda: node.output().count("law 'falling' adopted") > 1, "the next law")
    assert swim.reset().success  # warnings of what the laws before it did last until then
    swim.until_time(0.5)
    assert all(is_finite(message) for topic in ("head_pose", "curvature") for message in swim.received[topic])

    def own():  # there are the extreme ones too
        return [
            each for message in swim.received["/diagnostics"] for each in message.status if each.name == "/dynamics"
        ]

    good = "swimming", "late by"  # on a busy machine
    swim.until(lambda: own() and own()[-1].message.startswith(good), "good diagnostics")
    swim.close()
    assert node.interrupt() == 0 and "Traceback" not in node.output()


TAIL = """
joints:
  - {position: 0.4, name: hip, servo: {kp: 14, kd: 0.4, torque_limit: 3, speed_limit: 8}}
  - {position: 0.7, name: tail, stiffness: 0.1, damping: 0.01}
"""
FIN = "left name={} station={} area=0.001 aspect_ratio=2.5 angle=commanded time_constant=0.1"
PARTS = {  # names of what there is with each robot, and with each fin
    "joint_commands": (("joint_1", "joint_8"), ("hip", "tail"), ("joint_3", "hip")),
    "fin_command": (("rudder",), ("keel",), ("rudder", "keel")),
}


@pytest.mark.fault(
    "samples",
    "commands of joints and fins, currents and wrenches, with any extreme, wrong lengths, unknown names, bad stamps, "
    "while running, paused, and after a reset with another robot, other fins and another body",
    "refused, or acted on within the limits; the node publishes as before",
)
@pytest.mark.parametrize("factor", ["1.0", pytest.param("0.0", marks=pytest.mark.soak)])
def test_the_dynamics_node_stands_any_command(start, network, fresh_domain, tmp_path, factor):
    other = tmp_path / "tail.yaml"
    other.write_text(TAIL)
    swim = SwimClient(domain=fresh_domain, topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    words = ("robot:=eight_servos", f"fins:={FIN.format('rudder', 0.5)}", "accuracy:=draft", "estimate_error:=false")
    words = (*words, f"real_time_factor:={factor}", "subscriber_timeout:=0.2", "rate:=20")
    node = start("dynamics", "--ros-args", *(word for each in words for word in ("-p", each)))
    swim.until_time(0.2)

    def send():
        for topic, sets in PARTS.items():
            for known in sets:
                network.send(topic, JointState, for_names(JointState, known), node)
            network.send(topic, JointState, broken(JointState), node)
        for topic, kind in {"current": Vector3Stamped, "external_wrench": WrenchStamped}.items():
            network.send(topic, kind, [*extremes(kind), *stamped(kind())], node)

    def goes_on():
        swim.received["head_pose"].clear()
        swim.until(lambda: swim.received["head_pose"], "a sample")
        swim.until_time(1e-9 * swim.newest("head_pose") + 0.5)
        assert all(is_finite(message) for message in swim.received["head_pose"]), node.output()[-3000:]

    swimmers = (
        ("eight_servos", FIN.format("rudder", 0.5), "boyer2010"),
        (str(other), FIN.format("keel", 0.7), "kern2006"),
    )
    for robot, fins, body in swimmers:
        answers = swim.set(robot=robot, fins=fins, body=body)
        assert all(answer.successful for answer in answers) and swim.reset().success, answers
        goes_on()
        send()
        goes_on()
        assert swim.pause(True).success
        send()
        assert swim.pause(False).success
        goes_on()
        assert swim.reset().success
        goes_on()
    assert node.interrupt() == 0, node.output()[-3000:]
    assert not any(word in node.output() for word in ("Traceback", "FATAL", "the run stopped", "a request is refused"))
    assert "simulation stopped" not in node.output(), node.output()[-3000:]


@pytest.mark.fault(
    "time", "/clock with a negative time, or any other", "said and left out; the gait generator goes on with the next"
)
@pytest.mark.soak
def test_the_gait_generator_stands_any_message(start, network, fresh_domain):
    node = start("gait_generator")
    send_extremes(network, node, "gait_generator")
    clock, before = network.publisher(Clock, "/clock", 10), Clock(clock=Time(sec=-1))
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
@pytest.mark.soak
def test_the_visualiser_stands_any_message(start, network, tmp_path):
    node = start("visualiser", "--ros-args", "-p", "sink:=[save]", "-p", f"recording:={tmp_path}/run.rrd")
    node.wait_for_output("saving to", LIMIT)
    send_extremes(network, node, "visualiser")
    publisher = network.publisher(TOPICS["head_pose"], "head_pose")
    good = messages(Swimmer(11), 2**31 * 10**9 - 10**9)["head_pose"]  # later than any
    publisher.publish(good)
    here = good.pose.position

    def shown():
        return [here.x, here.y, here.z] in [row for path in tmp_path.glob("run*.rrd") for row in positions(path)]

    network.until(shown, "good message in a recording", node)  # it takes what came before first
    assert node.interrupt() == 0 and "Traceback" not in node.output(), node.output()[-3000:]
    assert shown()


def followed(network, name, node) -> None:
    """Whether the controller `name`, after all of that, answers an odom with finite samples ahead of it."""
    heard, odom = [], network.publisher(Odometry, "odom")
    network.node.create_subscription(CurvatureSamples, "curvature_samples", heard.append, 1000)
    good = messages(Swimmer(11), 10**9 + 10**7)["odom"]

    def answered():
        odom.publish(good)
        ahead = (nanoseconds(each.header.stamp) - nanoseconds(good.header.stamp) for each in heard)
        return any(0 < each <= 10**8 for each in ahead)  # the greatest lead is 0.1 s

    network.until(answered, f"answer of {name}")
    near = [each for each in heard if nanoseconds(each.header.stamp) < 2 * 10**9]
    assert all(is_finite(each) for each in near)
    assert node.time_to_end() < PROMPT and node.status == 0 and "Traceback" not in node.output()


@pytest.mark.fault(
    "neighbours",
    "odom, goals and swim_state with any extreme, any stamp (one that lies years ahead too), cut short, or huge",
    "said and left out, or begun with anew; the pilot answers the next odom, each call, and a signal at once",
)
@pytest.mark.soak
def test_the_pilot_stands_any_message(start, network):
    node = start("pilot", "--ros-args", "-p", "torque_limit:=1.0")
    send_extremes(network, node, "pilot", {"/swim_state"})
    network.send("/goal_path", Path, huge(Path), node)  # alone: of many messages at once the last ten are kept
    node.wait_for_output("path must have at most 10000 points, got 40000")
    followed(network, "pilot", node)
    assert "a new start" in node.output()


@pytest.mark.fault(
    "neighbours", "odom with any extreme, any stamp, or cut short", "the heading controller answers the next odom"
)
def test_the_heading_controller_stands_any_message(start, network):
    node = start("heading_controller")
    send_extremes(network, node, "heading_controller")
    followed(network, "heading_controller", node)


@pytest.mark.fault(
    "neighbours",
    "the same messages to the node `markers`",
    "it leaves out what it cannot show, and shows what comes next",
)
@pytest.mark.soak
def test_the_markers_stand_any_message(start, network):
    node = start("markers")
    send_extremes(network, node, "markers")
    heard, sample = [], messages(Swimmer(11), 3 * 10**9)
    network.node.create_subscription(MarkerArray, "markers", heard.append, 1000)
    topics = ("backbone", "internal_wrench", "hydrodynamic_load")
    publishers = {topic: network.publisher(TOPICS[topic], topic) for topic in topics}
    network.publisher(BodyGeometry, "body", ANYBODY).publish(body_message(11))

    def shown():
        for topic, publisher in publishers.items():
            publisher.publish(sample[topic])
        return any(marker.ns == "skin" and len(marker.points) > 100 for each in heard for marker in each.markers)

    network.until(shown, "skin")
    assert node.time_to_end() < PROMPT and node.status == 0 and "Traceback" not in node.output()


@pytest.mark.fault(
    "ending",
    "SIGINT or SIGTERM in the middle of a flood of huge messages and jumping stamps, to any node",
    "prompt exit, status 0, no traceback",
)
@pytest.mark.parametrize(
    "name", [name if name in CALLED else pytest.param(name, marks=pytest.mark.soak) for name in NODES]
)
def test_a_signal_ends_any_node_in_a_flood(start, network, tmp_path, name):
    number = signal.SIGINT if len(name) % 2 else signal.SIGTERM
    files = ("-p", "sink:=[save]", "-p", f"recording:={tmp_path}/run.rrd") if name == "visualiser" else ()
    clock = ("-p", "clock:=false") if name == "dynamics" else ()
    node = start(name, "--ros-args", "-p", "use_sim_time:=true", *clock, *files)
    topics = network.topics(name, NODES[name])
    if name == "dynamics":
        network.publisher(topics["/curvature_law"], "curvature_law").publish(law_to_message(falling()))
        node.wait_for_output("adopted")
    good = {f"/{topic}": message for topic, message in messages(Swimmer(11), 10**9).items()}
    for topic, kind in topics.items():
        publisher = network.publisher(kind, topic, ANYBODY)
        flood = [*huge(kind)][:1]
        if hasattr(kind(), "header") or hasattr(kind(), "clock"):
            flood += [*stamped(good.get(topic, kind()))] * 10
        for message in flood:
            publisher.publish(message)
    assert node.time_to_end(number) < PROMPT and node.status == 0, node.output()[-3000:]
    assert "Traceback" not in node.output()
