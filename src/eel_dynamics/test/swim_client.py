# SPDX-License-Identifier: Apache-2.0
"""A ROS node for tests: receives a dynamics node's topics without loss, publishes laws and samples, calls services."""

import re
import time
from collections import defaultdict

from diagnostic_msgs.msg import DiagnosticArray
from eel_common.ros.testing.service_call import answer_of
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParameters
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from eel_msgs.msg import (
    Backbone,
    BodyGeometry,
    Curvature,
    CurvatureLaw,
    CurvatureSamples,
    EnergyLedger,
    HydrodynamicLoad,
    InternalWrench,
    SwimState,
)

LIMIT = 90.0  # s; discovery was seen to take 2.75 s on a machine at rest, and this is for busy ones
MOST_AT_ONCE = 1000  # messages of a topic
LOSSLESS = QoSProfile(history=HistoryPolicy.KEEP_ALL)
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)

SAMPLES = {
    "head_pose": PoseStamped,
    "head_twist": TwistStamped,
    "odom": Odometry,
    "backbone": Backbone,
    "curvature": Curvature,
    "internal_wrench": InternalWrench,
    "hydrodynamic_load": HydrodynamicLoad,
    "energy": EnergyLedger,
}
FURTHER = {"joint_states": JointState, "swim_state": SwimState}


def nanoseconds(stamp) -> int:
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def is_finite(message) -> bool:
    """Whether no number of the message is NaN or infinite."""
    return not re.search(r"\b(nan|inf)\b", repr(message))


class SwimClient:
    """Subscribes to `topics` of the dynamics node in `namespace`; messages are in `received[topic]`, in order."""

    def __init__(self, *, domain, topics=tuple(SAMPLES), namespace="", clock=False):
        self.context = Context()
        self.context.init(domain_id=domain)
        self.node = Node("swim_client", namespace=namespace, context=self.context, start_parameter_services=False)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.received = defaultdict(list)
        self.arrivals = defaultdict(list)  # s, steady clock
        self.starts = defaultdict(int)  # number of messages with sample 0
        self._subscriptions, self._services = [], {}
        for topic in topics:
            self.listen(topic, {**SAMPLES, **FURTHER}[topic])
        self.listen("body", BodyGeometry, LATCHED)
        self.listen("/diagnostics", DiagnosticArray)
        if clock:
            self.listen("/clock", Clock)
        self.laws = self.node.create_publisher(CurvatureLaw, "curvature_law", LATCHED)
        self.samples = self.node.create_publisher(CurvatureSamples, "curvature_samples", LOSSLESS)

    def close(self):
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()

    def listen(self, topic, kind, quality=LOSSLESS, name=None):
        """Subscribes to a topic; its messages are in `received[name]`, by default the topic's. Of those that repeat
        sample 0 while the run stands at its start, the last is kept."""
        name = name or topic

        def keep(message):
            if kind in SAMPLES.values() and nanoseconds(message.header.stamp) == 0:
                self.starts[name] += 1
                if self.received[name] and nanoseconds(self.received[name][-1].header.stamp) == 0:
                    self.received[name].pop()
                    self.arrivals[name].pop()
            self.received[name].append(message)
            self.arrivals[name].append(time.monotonic())

        self._subscriptions.append(self.node.create_subscription(kind, topic, keep, quality))

    def turn(self):
        """Serves what has come. The executor takes one message of a topic at a time, and is slower at that than a node
        that runs as fast as possible: the others that are there are taken in one go."""
        self.executor.spin_once(timeout_sec=0.02)
        for each in self._subscriptions:
            for _ in range(MOST_AT_ONCE):
                with each.handle:
                    taken = each.handle.take_message(each.msg_type, each.raw)
                if taken is None:
                    break
                each.callback(taken[0])

    def spin(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.turn()

    def until(self, condition, what, limit=LIMIT):
        """Spins until the condition holds; AssertionError, with what was awaited, after `limit`."""
        deadline = time.monotonic() + limit
        while not condition():
            assert time.monotonic() < deadline, f"no {what} within {limit} s; last /diagnostics: {self._last_status()}"
            self.turn()

    def _last_status(self):
        """What /diagnostics told last, for a test that fails."""
        return self.diagnosis(self.received["/diagnostics"][-1]) if self.received["/diagnostics"] else "none"

    def latest(self, topic):
        self.until(lambda: self.received[topic], f"message on {topic}")
        return self.received[topic][-1]

    def until_time(self, seconds, *topics):
        """Spins until each topic, by default head_pose, has a sample at that simulation time or later: what has come on
        one topic may still be on its way on another."""
        for topic in topics or ("head_pose",):
            self.until(
                lambda topic=topic: self.received[topic] and self.newest(topic) >= seconds * 1e9,
                f"{topic} at {seconds} s",
            )

    def newest(self, topic):
        """The stamp [ns] of the newest message of a topic."""
        return nanoseconds(self.received[topic][-1].header.stamp)

    def call(self, kind, name, **request):
        answer = answer_of(self._service(kind, name), kind.Request(**request))
        self.until(answer, f"answer from {name}")
        return answer()

    def acquaint(self, service, request):
        """Calls a service until it has answered: from then on the node knows its client, and drops no reply."""
        self.until(answer_of(service, request), f"answer from {service.srv_name}")

    def _call_often(self, count, kind, name, **request):
        """The answer to the last of `count` calls that are on their way together; a service's history holds ten."""
        self.acquaint(self._service(kind, name), kind.Request(**request))
        answers = [self._service(kind, name).call_async(kind.Request(**request)) for _ in range(count)]
        self.until(lambda: all(answer.done() for answer in answers), f"answer from {name}")
        return answers[-1].result()

    def _service(self, kind, name):
        if name not in self._services:
            self._services[name] = self.node.create_client(kind, name)
        self.until(self._services[name].service_is_ready, f"service {name}")
        return self._services[name]

    def _call_until_done(self, kind, name, **request):
        """As `call`; on a busy machine it may take longer than the second that the service waits for it."""
        while "still queued" in (answer := self.call(kind, name, **request)).message:
            pass
        return answer

    def reset(self):
        return self._call_until_done(Trigger, "dynamics/reset")

    def pause(self, paused):
        return self._call_until_done(SetBool, "dynamics/pause", data=paused)

    def stop_the_clock(self, *topics):
        """Pauses the run, and waits until the last sample before it has come on each topic; its time [s]."""
        answer = self.pause(True)
        assert answer.success, answer.message
        time_of = float(re.findall(r"t = (\S+) s", answer.message)[0])  # of six digits
        self.until_time(time_of - 1e-5, *topics)
        return self.newest(topics[0]) / 1e9

    def deliver(self, messages):
        """Publishes samples of a controller, and waits until the node has taken them: between two answers to questions
        its executor takes one of them."""
        for message in messages:
            self.samples.publish(message)
        assert self.samples.wait_for_all_acked(Duration(seconds=LIMIT)), "the samples did not arrive"
        for _ in range(len(messages) // 8 + 1):
            self._call_often(8, GetParameters, "dynamics/get_parameters", names=["rate"])

    def set(self, **values):
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        return self.call(SetParameters, "dynamics/set_parameters", parameters=parameters).results

    def get(self, *names):
        answer = self.call(GetParameters, "dynamics/get_parameters", names=names)
        return [parameter_value_to_python(value) for value in answer.values]

    def describe(self, *names):
        return self.call(DescribeParameters, "dynamics/describe_parameters", names=names).descriptors

    def diagnosis(self, message=None):
        """(level, message, values) of the latest /diagnostics, or of the one given."""
        status = (message or self.latest("/diagnostics")).status[0]
        return status.level[0], status.message, {pair.key: pair.value for pair in status.values}

    def is_well(self):
        """Whether the latest /diagnostics tell of no fault, but that a busy machine does not keep the pace."""
        level, text, _ = self.diagnosis()
        return level == 0 or (level == 1 and text.startswith("late by"))
