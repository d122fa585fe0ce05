# SPDX-License-Identifier: Apache-2.0
"""A ROS node for tests: receives curvature laws, ticks /clock, calls the gait generator's parameter services."""

import time

from eel_common.ros.testing.service_call import answer_of
from eel_gaits.laws.law_message import law_from_message
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

from eel_msgs.msg import CurvatureLaw

LIMIT = 90.0  # s; discovery alone was seen to take 2.75 s
LATCHED = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class GaitClient:
    def __init__(self, *, domain, generator="gait_generator"):
        self.context = Context()
        self.context.init(domain_id=domain)
        self.node = Node("gait_client", context=self.context, start_parameter_services=False)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.generator = generator
        self.messages = []
        self.clock = self.node.create_publisher(Clock, "/clock", 10)

    def close(self):
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()

    def listen(self, topic="curvature_law", quality=LATCHED):
        self.node.create_subscription(CurvatureLaw, topic, self.messages.append, quality)

    def until(self, condition, what):
        """Spin until the condition holds; AssertionError, with what was awaited, after LIMIT."""
        deadline = time.monotonic() + LIMIT
        while not condition():
            assert time.monotonic() < deadline, f"no {what} within {LIMIT} s"
            self.executor.spin_once(timeout_sec=0.02)

    def law(self, index):
        """Wait for message number `index` (from 0); its law and its stamp [s]."""
        self.until(lambda: len(self.messages) > index, f"law number {index}")
        stamp = self.messages[index].header.stamp
        return law_from_message(self.messages[index]), stamp.sec + 1e-9 * stamp.nanosec

    def latest(self):
        return self.law(len(self.messages) - 1)

    def tick(self, seconds):
        whole = int(seconds)
        message = Clock()
        message.clock.sec, message.clock.nanosec = whole, round((seconds - whole) * 1e9)
        self.clock.publish(message)

    def tick_until(self, seconds, condition, what):
        """Publish this simulation time over and over until the condition holds."""

        def ticked():
            self.tick(seconds)
            return condition()

        self.until(ticked, what)

    def call(self, kind, name, **request):
        service = self.node.create_client(kind, f"{self.generator}/{name}")
        try:
            self.until(service.service_is_ready, f"service {name}")
            answer = answer_of(service, kind.Request(**request))
            self.until(answer, f"answer from {name}")
            return answer()
        finally:
            self.node.destroy_client(service)

    def set(self, **values):
        """Set one after another; the list of results."""
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        return self.call(SetParameters, "set_parameters", parameters=parameters).results

    def set_together(self, **values):
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        return self.call(SetParametersAtomically, "set_parameters_atomically", parameters=parameters).result

    def values(self):
        """All parameters: a mapping of name to value."""
        names = self.call(ListParameters, "list_parameters").result.names
        answer = self.call(GetParameters, "get_parameters", names=names)
        return {name: parameter_value_to_python(value) for name, value in zip(names, answer.values, strict=True)}

    def describe(self, *names):
        return self.call(DescribeParameters, "describe_parameters", names=names).descriptors
