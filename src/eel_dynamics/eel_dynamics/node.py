"""The dynamics node: declares its parameters, hears laws, has the simulation march, publishes, and tells how it goes.

The march has a thread of its own (march.py), callbacks run in another, and the main thread waits for the end.
"""

import math
import sys
import time
import traceback
from dataclasses import fields

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from eel_gaits.messages import law_from_message
from eel_gaits.node import answer_words, take_overrides, warn_of_unknown
from eel_gaits.serving import serve_once
from eel_gaits.starting import CANNOT_START, tell_no_start
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import SetBool, Trigger

from eel_msgs.msg import BodyGeometry, CurvatureLaw, CurvatureSamples

from .assembly import simulation_of
from .clock_right import ClockWatch
from .declaration import Declaration
from .ending import Ending, leave_at_once
from .feed import LawFeed
from .march import March
from .messages import Sample, body_message, diagnostic_array, opened_law, samples_from_message
from .one_line_warnings import one_line_warnings
from .parameters import DynamicsParameters, default_of
from .publishers import Publishers
from .repair import repair_soon
from .report import Report
from .scene import Scene
from .status import Status

NAME = "dynamics"
ABOUT = "Simulates the swimmer that the laws on curvature_law bend, and publishes how it moves."
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LOSSLESS = QoSProfile(history=HistoryPolicy.KEEP_ALL)  # reliable, as the others are
MANY_CALLS = QoSProfile(depth=1000)  # of a service: with ROS's own, calls beyond ten at once are lost without a word
ATTENTION = 0.25  # s: how often the state is looked at, and who publishes /clock
PROMPT = 1.0  # s: a service has answered by then
HASTE = 0.2  # s: longest wait for acknowledgements after a signal


class DynamicsNode(Node):
    """Topics, services and parameters of a run."""

    def __init__(self):
        super().__init__(NAME, automatically_declare_parameters_from_overrides=True)
        overrides = take_overrides(self)
        report = Report(self.get_logger())
        self.parameters = Declaration(self, lambda values: self.march.change(values))
        warn_of_unknown(self, overrides, {name for name in overrides if self.has_parameter(name)})
        values, scene = self.parameters.values, self.parameters.scene
        simulation = simulation_of(values, scene)
        self.outlets = Publishers(
            Sample(simulation.x, scene, values.world_frame, values.head_frame),
            create=lambda kind, topic, depth: self.create_publisher(kind, topic, depth or LOSSLESS),
            destroy=self.destroy_publisher,
            received=lambda publisher, seconds: publisher.wait_for_all_acked(Duration(seconds=seconds)),
            refusal=rclpy_implementation.RCLError,
            values=lambda: self.parameters.values,
            stopped=lambda: self.march.stopped,
            report=report,
        )
        self.march = March(simulation, values, self.outlets, report, greet=self._introduce)
        self.status = Status(self.march, report, values.accuracy)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._body = self.create_publisher(BodyGeometry, "body", LATCHED)
        self._body.publish(body_message(simulation.body, scene, simulation.x, values.head_frame))

        feed = LawFeed(self.march, report, opened=opened_law, law_of=law_from_message, samples_of=samples_from_message)
        # The first hears earlier laws too, the second any publisher.
        for number, quality in enumerate((LATCHED, QoSProfile(depth=10))):
            self.create_subscription(
                CurvatureLaw,
                "curvature_law",
                lambda data, info, number=number: feed.hear_law(data, info, number),
                quality,
                raw=True,
                event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),  # what one lacks the other has
            )
        self.create_subscription(CurvatureSamples, "curvature_samples", feed.hear_samples, LOSSLESS)
        self.create_service(Trigger, "~/reset", self._reset, qos_profile=MANY_CALLS)
        self.create_service(SetBool, "~/pause", self._pause, qos_profile=MANY_CALLS)
        clock = ClockWatch(self, lambda offered: self.march.order(lambda: self.outlets.offer_clock(offered)), report)
        clock.look(values.clock)

        def attend():
            """One timer for both: each wakes the executor, which costs more than what it is for."""
            if self.status.due():
                self.tell()
            clock.look(self.parameters.values.clock)

        self.create_timer(ATTENTION, attend, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def tell(self, final: bool = False):
        """Publishes /diagnostics."""
        level, text, values = self.status.collect(self.count_publishers("curvature_law"), final)
        name = self.get_fully_qualified_name()
        self._diagnostics.publish(diagnostic_array(self.march.time, name, level, text, values))

    def see_off(self, interrupted, longest: float = math.inf):
        """Waits until subscribers have received everything, no longer than `longest` [s]."""
        began = time.monotonic()
        received = self.outlets.wait_until_received([self._diagnostics, self._body], interrupted, longest)
        if not received and not interrupted():
            waited = time.monotonic() - began
            self.get_logger().warning(f"some subscriber has not received everything within {waited:.2g} s")

    def _introduce(self):
        """Waits until all who have come know the body, which they need for what follows."""
        self._body.wait_for_all_acked(Duration(seconds=PROMPT))

    def _reset(self, request, response):
        return self._answer(response, self.march.reset(), "reset")

    def _pause(self, request, response):
        return self._answer(response, self.march.pause(request.data), "paused" if request.data else "going on")

    def _answer(self, response, order, state):
        response.success = order.done.wait(PROMPT)
        response.message = f"{state} at t = {order.time:g} s" if response.success else "to be done soon"
        return response


def parameter_rows():
    """Name, description and default of each parameter."""
    for prefix, kind in (("", DynamicsParameters), ("scene.", Scene)):
        for item in fields(kind):
            unit = f" [{item.metadata['unit']}]" if item.metadata["unit"] else ""
            yield prefix + item.name, item.metadata["description"] + unit, default_of(item)


def main(args=None) -> int:
    """Runs the node; status 0 after its duration, SIGINT or SIGTERM, 2 if it cannot start as asked, 1 if it fails, or
    if a simulation that nobody attends (a duration, no pace) cannot go on."""
    ending = Ending()
    repair_soon()
    try:
        status = answer_words(NAME, ABOUT, parameter_rows(), sys.argv if args is None else args)
        if status is not None:
            return status
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        with one_line_warnings(NAME):
            node = DynamicsNode()
    except CANNOT_START as error:
        tell_no_start(NAME, error)
        rclpy.try_shutdown()
        return 2
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    ending.start(node.march.run)
    ending.start(lambda: spin(executor, node, ending))
    done, error = ending.wait()
    node.march.stop()
    ending.over = True
    executor.create_task(lambda: None)  # one more turn, its last
    joined = ending.join(HASTE)
    if error is not None:
        node.get_logger().fatal("".join(traceback.format_exception(error)))
    node.tell(final=True)
    node.see_off(lambda: ending.signalled, math.inf if done else HASTE)
    if joined:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
        rclpy.get_default_context().destroy()  # says goodbye to the network, which would wait 20 s for news otherwise
    return leave_at_once(int(error is not None or node.march.given_up))


def spin(executor, node, ending):
    """Serves callbacks until the process ends."""
    while not ending.over:
        serve_once(executor, node)
