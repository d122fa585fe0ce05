# SPDX-License-Identifier: Apache-2.0
"""The dynamics node: declares parameters, subscribes to laws, runs the simulation, publishes samples and diagnostics.

The run loop runs in one thread (run_loop.py), callbacks in another, and the main thread waits for the end.
"""

import math
import sys
import time
import traceback

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from eel_base.command.command_line import one_line_warnings
from eel_base.wording import one_line
from eel_gaits.ros.messages import law_from_message
from eel_ros.command_line import handle_arguments
from eel_ros.parameter_node import ParameterNode
from eel_ros.parameters import help_rows
from eel_ros.process_end import ProcessEnd, leave_at_once
from eel_ros.qos import keep_all, latched, matches
from eel_ros.serving import serve_once
from eel_ros.start import start
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.qos import QoSProfile
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

from eel_dynamics.model.scene import Scene
from eel_dynamics.ros.clock_arbiter import ClockMonitor
from eel_dynamics.ros.clock_subscription import ClockSubscription
from eel_dynamics.ros.declaration import Declaration
from eel_dynamics.ros.diagnostics import Report, Status
from eel_dynamics.ros.loop.followed_clock import FollowedClock
from eel_dynamics.ros.loop.law_feed import LawFeed
from eel_dynamics.ros.loop.pacing import Pace
from eel_dynamics.ros.loop.run_loop import NewRun, RunLoop
from eel_dynamics.ros.messages import (
    Sample,
    body_message,
    diagnostic_array,
    parse_law,
    root_message,
    samples_from_message,
    state_from_message,
    time_message,
    values_of_status,
)
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.publishers import Publishers
from eel_dynamics.ros.sample_inbox import SampleInbox
from eel_dynamics.ros.simulation_from_parameters import simulation_from_parameters
from eel_dynamics.ros.swimmer_arbiter import Identity, SwimmerArbiter
from eel_msgs.msg import BodyGeometry, CurvatureLaw
from eel_msgs.srv import SetState, Step

NAME = "dynamics"
ABOUT = "Simulates the swimmer that the laws on curvature_law bend, and publishes how it moves."
LATCHED, LOSSLESS = latched(10), keep_all()
SERVICE_QOS = QoSProfile(depth=1000)  # with ROS's default, more than ten simultaneous calls are lost silently
TIMER_PERIOD = 0.25  # s between two checks of the state and of the publishers of /clock
SERVICE_TIMEOUT = 1.0  # s within which a service answers
MOST_STEPS = 1_000_000  # samples of one call
SIGNAL_TIMEOUT = 0.2  # s: longest wait for acknowledgements after a signal


class NextTurn:
    """A callback that awaits one lets the executor run others of other groups, and goes on when that wakes again."""

    def __await__(self):
        yield


class DynamicsNode(ParameterNode):
    """Topics, services and parameters of one simulation."""

    run_loop: RunLoop

    def __init__(self):
        super().__init__(NAME)
        report = Report(self.get_logger())
        self.parameters = Declaration(self, lambda values: self.run_loop.requests.change(values))
        values, scene = self.parameters.values, self.parameters.scene
        simulation = simulation_from_parameters(values, scene)
        self.sample_publishers = Publishers(
            Sample(simulation.x, scene, values, lambda: self.run_loop.output.head_errors),
            create=lambda kind, topic, depth: self.create_publisher(kind, topic, depth or LOSSLESS),
            destroy=self.destroy_publisher,
            known=self._count_known,
            received=lambda publisher, seconds: publisher.wait_for_all_acked(Duration(seconds=seconds)),
            publish_error=rclpy_implementation.RCLError,
            values=lambda: self.parameters.values,
            stopped=lambda: self.run_loop.requests.stopped,
            report=report,
        )
        feed: LawFeed
        inbox = SampleInbox(self, lambda message, info: feed.receive_samples(message, info))
        self.run_loop = RunLoop(
            simulation,
            values,
            self.sample_publishers,
            report,
            self._wait_for_body_received,
            inbox,
            FollowedClock if values.follow_clock else Pace,
        )
        self.status = Status(self.run_loop, report, values.accuracy)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._body = self.create_publisher(BodyGeometry, "body", latched(1))
        self._body.publish(body_message(simulation.body, scene, simulation.x, values.section_frame))

        feed = LawFeed(
            self.run_loop.requests, report, parse=parse_law, law_of=law_from_message, samples_of=samples_from_message
        )
        # The first also gets earlier messages, the second matches any publisher.
        for number, quality in enumerate((LATCHED, QoSProfile(depth=10))):
            self.create_subscription(
                CurvatureLaw,
                "curvature_law",
                lambda data, info, number=number: feed.receive_law(data, info, number),
                quality,
                raw=True,
                event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),  # one of the two matches
            )
        steps, calls = ReentrantCallbackGroup(), MutuallyExclusiveCallbackGroup()  # the calls are answered in order
        self.run_loop.requests.on_finished = self.create_guard_condition(lambda: None, steps).trigger
        for kind, name, callback, group in (
            (Trigger, "reset", self._reset, calls),
            (SetBool, "pause", self._pause, calls),
            (SetState, "set_state", self._set_state, calls),
            (Step, "step", self._step, steps),  # others go on while it waits for its samples
        ):
            self.create_service(kind, f"~/{name}", callback, qos_profile=SERVICE_QOS, callback_group=group)
        clock = ClockMonitor(
            self,
            lambda offered: self.run_loop.requests.put(lambda: self.sample_publishers.enable_clock(offered)),
            report,
        )
        clock.look(values.makes_clock)
        follow = self.run_loop.requests.show_clock
        followed = (
            ClockSubscription(self, lambda shown: follow(shown, time.monotonic())) if values.follow_clock else None
        )
        self._root = None  # publisher of /tf_static
        self._publish_root()
        topic = self.resolve_topic_name("head_pose")
        self._arbiter = SwimmerArbiter(Identity.own(), topic, report, self.run_loop.requests.hold)
        self.create_subscription(DiagnosticArray, "/diagnostics", self._receive_diagnostics, 10)

        def on_timer():
            """Check all in one timer: waking the executor costs more than the checks."""
            self._arbiter.look()
            inbox.look()
            if self.status.due():
                self.publish_diagnostics()
            clock.look(self.parameters.values.makes_clock and not self._arbiter.waits)
            self._publish_root()
            if followed is not None:
                followed.look()

        self.create_timer(TIMER_PERIOD, on_timer, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _count_known(self, publisher) -> int:
        """The number of subscribers on the network that `publisher` can match."""
        wanted = self.get_subscriptions_info_by_topic(publisher.topic_name)
        return sum(matches(each.qos_profile, publisher.qos_profile) for each in wanted)

    def _publish_root(self):
        """Publish once where the world lies in the frame that swimmers share; later subscribers get it too."""
        values = self.parameters.values
        if self._root is None and values.root_frame and values.publish_tf:
            self._root = self.create_publisher(TFMessage, "/tf_static", latched(1))
            self._root.publish(root_message(values))

    def publish_diagnostics(self, final: bool = False):
        """Publish /diagnostics; `final`: at the end of the run."""
        level, text, values = self.status.collect(self.count_publishers("curvature_law"), final)
        name, values = self.get_fully_qualified_name(), values | self._arbiter.values()
        self._diagnostics.publish(diagnostic_array(self.run_loop.time, name, level, text, values))

    def wait_until_received(self, interrupted, longest: float = math.inf):
        """Wait at most `longest` [s] until subscribers have acknowledged everything, or until `interrupted()`."""
        began = time.monotonic()
        received = self.sample_publishers.wait_until_received([self._diagnostics, self._body], interrupted, longest)
        if not received and not interrupted():
            waited = time.monotonic() - began
            self.get_logger().warning(f"some subscriber has not received everything within {waited:.2g} s")

    def _wait_for_body_received(self):
        """Wait until the present subscribers have received the body: they need it for the samples."""
        self._body.wait_for_all_acked(Duration(seconds=SERVICE_TIMEOUT))

    def _receive_diagnostics(self, message):
        for status in message.status:
            self._arbiter.receive(status.name, values_of_status(status))

    def answer_to(self, names: list[str]) -> str:
        """When the changes of the parameters `names` act; empty: at once."""
        return self.parameters.answer_to(names)

    def _reset(self, request, response):
        try:
            new = self._new_run() if self.parameters.pending else None
        except (ValueError, OSError) as error:
            response.message = f"reset refused: {one_line(error)}"
            self.get_logger().error(response.message)
            return response
        return self._answer(response, self.run_loop.requests.reset(new), "reset")

    def _new_run(self) -> NewRun:
        """The run with the parameters that have been set for the next reset. `ValueError` names what does not fit."""
        values, scene = self.parameters.next_values, self.parameters.next_scene
        simulation = simulation_from_parameters(values, scene)
        sample = Sample(simulation.x, scene, values, lambda: self.run_loop.output.head_errors)
        body = body_message(simulation.body, scene, simulation.x, values.section_frame)

        def begin():
            self.parameters.begin(values, scene)
            self.sample_publishers.change(sample)
            self._body.publish(body)
            self.status.accuracy = values.accuracy

        return NewRun(simulation, values, begin)

    async def _step(self, request, response):
        if not 1 <= request.samples <= MOST_STEPS:
            response.message = f"samples must be 1 to {MOST_STEPS}, got {request.samples}"
            return response
        steps = self.run_loop.requests.step(request.samples)
        while not steps.done.is_set():
            await NextTurn()
        response.success, response.stamp = not steps.failure, time_message(steps.time)
        many = "s" if request.samples > 1 else ""
        response.message = steps.failure or f"{request.samples} sample{many} published, paused at t = {steps.time:g} s"
        return response

    def _set_state(self, request, response):
        try:
            state = state_from_message(request)
        except ValueError as error:
            response.message = str(error)
            return response
        return self._answer(response, self.run_loop.requests.set_state(*state), "head put into the state")

    def _pause(self, request, response):
        return self._answer(
            response, self.run_loop.requests.pause(request.data), "paused" if request.data else "going on"
        )

    async def _answer(self, response, request, state):
        end = time.monotonic() + SERVICE_TIMEOUT
        while not request.done.is_set() and time.monotonic() < end:
            await NextTurn()
        done = request.done.is_set()
        response.success = done and not request.failure
        if request.failure:
            response.message = f"refused: {request.failure}"
        elif done:
            response.message = f"{state} at t = {request.time:g} s"
        else:
            response.message = f"not done within {SERVICE_TIMEOUT:g} s, still queued"
        return response


def parameter_rows():
    """Name, description and default of each parameter."""
    yield from help_rows(DynamicsParameters)
    yield from help_rows(Scene, "scene.")


def main(args=None) -> int:
    """Run the node. Exit status: 0 after its duration, SIGINT or SIGTERM; 1 if it fails, or if an unattended simulation
    (with a duration, as fast as possible) stops; 2 if it cannot start."""
    end, words = ProcessEnd(), sys.argv if args is None else args
    status = handle_arguments(NAME, ABOUT, parameter_rows(), words)
    if status is not None:
        return status
    with one_line_warnings(NAME):
        node = start(NAME, words, DynamicsNode)
    if node is None:
        return 2
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    end.start(node.run_loop.run)
    end.start(lambda: spin(executor, node, end))
    done, error = end.wait()
    node.run_loop.requests.stop()
    end.over = True
    executor.create_task(lambda: None)  # wakes the executor once more
    joined = end.join(SIGNAL_TIMEOUT)
    if error is not None:
        node.get_logger().fatal("".join(traceback.format_exception(error)))
    node.publish_diagnostics(final=True)
    node.wait_until_received(lambda: end.signalled, math.inf if done else SIGNAL_TIMEOUT)
    if joined:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
        rclpy.get_default_context().destroy()  # leaves the network: others would wait 20 s for this node
    return leave_at_once(int(error is not None or node.run_loop.given_up))


def spin(executor, node, end):
    """Run callbacks until the process ends."""
    while not end.over:
        serve_once(executor, node)
