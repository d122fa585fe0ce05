# SPDX-License-Identifier: Apache-2.0
"""The dynamics node: declares parameters, subscribes to laws, runs the simulation, publishes samples and diagnostics.

The run loop runs in one thread (loop/run_loop.py), callbacks in the main thread. A new topic begins in
eel_common/topics.py.
"""

import sys
import threading
import time
import traceback
from collections.abc import Iterator
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from eel_common.command.command_line import one_line_warnings
from eel_common.ros.headers import stamp_of
from eel_common.ros.loop.diagnostics import Report
from eel_common.ros.loop.followed_clock import ClockSubscription, FollowedClock
from eel_common.ros.loop.other_nodes import Identity, OtherNodes
from eel_common.ros.loop.requests import Answer
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.parameters import help_rows
from eel_common.ros.process_end import exit_immediately
from eel_common.ros.qos import latched
from eel_common.ros.run_node import run_node
from eel_common.wording import one_line
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.qos import QoSProfile
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.scene import Scene
from eel_dynamics.ros.command_subscriptions import subscribe_to_commands
from eel_dynamics.ros.curvature_inbox import CurvatureInbox
from eel_dynamics.ros.declaration import Declaration
from eel_dynamics.ros.inputs.awaited import INPUTS
from eel_dynamics.ros.inputs.command_messages import state_from_message
from eel_dynamics.ros.inputs.inputs import check_inputs
from eel_dynamics.ros.law_subscription import LawSubscription
from eel_dynamics.ros.loop.run_loop import RunLoop
from eel_dynamics.ros.messages import diagnostic_array, root_transform, values_of_status
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.publishers import Publishers
from eel_dynamics.ros.simulation_from_parameters import simulation_from_parameters
from eel_dynamics.ros.status import Status
from eel_dynamics.sensors.suite import KINDS
from eel_msgs.srv import SetState, Step

NAME = "dynamics"
ABOUT = "Simulates a swimmer bent by the laws on curvature_law, and publishes its motion."
SERVICE_QOS = QoSProfile(depth=1000)  # with ROS's default, more than ten simultaneous calls are lost silently
LOOK_PERIOD = 0.2  # s between checks of the state and of the publishers of /clock
SERVICE_TIMEOUT = 1.0  # s within which a service answers
CANNOT_START = 2  # exit status
MOST_STEPS = 1_000_000  # samples of one call
SIGNAL_TIMEOUT = 0.2  # s: longest wait for the thread, and for acknowledgements, after a signal


class DynamicsNode(ParameterNode):
    """Topics, services and parameters of one simulation.

    Attributes:
        failure: why the run loop failed, as text; else empty.
    """

    def __init__(self) -> None:
        super().__init__(NAME)
        self.failure, self._report = "", Report(self.get_logger())
        self.parameters = Declaration(self)
        with one_line_warnings(NAME):
            simulation = simulation_from_parameters(*self.parameters.present)
        self._sample_publishers = Publishers(self, simulation, self.parameters, self._report)
        self._inbox = CurvatureInbox(self, self._report)
        self.run_loop = RunLoop(simulation, self.parameters, self._sample_publishers, self._inbox, self._report)
        self._status = Status(self.run_loop, self._report, self.parameters)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._static_publisher: Any = None  # of /tf_static
        self._static_transforms: list[Any] = []  # the published ones
        self._ended: float | None = None  # s, steady clock: when the end of the run was seen
        self._laws = LawSubscription(self, self.run_loop, self._report)
        subscribe_to_commands(self, self.run_loop)
        self._log_notes(simulation.robot)
        pace, requests = self.run_loop.pace, self.run_loop.requests
        self._followed_clock = ClockSubscription(self, pace, requests) if isinstance(pace, FollowedClock) else None
        self._other_nodes = OtherNodes(self, self.resolve_topic_name("head_pose"), Identity.own(), self._report)
        self._holding, self._offers_clock = "", False  # what the run loop was last told about other nodes
        self.create_subscription(DiagnosticArray, "/diagnostics", self._receive_diagnostics, 10)
        calls, steps = MutuallyExclusiveCallbackGroup(), ReentrantCallbackGroup()  # the calls are answered in order
        self._serve(Trigger, "reset", self._reset, calls)
        self._serve(SetBool, "pause", self._pause, calls)
        self._serve(SetState, "set_state", self._set_state, calls)
        self._serve(Step, "step", self._step, steps)  # other calls are served while it waits for its samples
        self._look_at_other_nodes()
        self._publish_static()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _log_notes(self, robot: Robot | None) -> None:
        """Log the `robot`'s notes."""
        if robot is not None:
            for note in robot.notes:
                self.get_logger().info(f"robot {robot.name}: {note}")

    def _serve(self, kind: type, name: str, callback: Any, group: Any) -> None:
        self.create_service(kind, f"~/{name}", callback, qos_profile=SERVICE_QOS, callback_group=group)

    def _run(self) -> None:
        try:
            self.run_loop.run()
        except Exception as error:
            self.failure = f"the run loop failed: {error}"
            self.get_logger().fatal("".join(traceback.format_exception(error)))
        self._inbox.wake_callers()

    def look(self) -> bool:
        """Check what changes slowly. Returns whether the node continues."""
        if not self._thread.is_alive():
            return self._end()
        self._inbox.look()
        self.run_loop.inputs.awaited.offered = {topic for topic in INPUTS if self.count_publishers(topic)}
        self._look_at_other_nodes()
        self._publish_static()
        if self._followed_clock is not None:
            self._followed_clock.look()
        if self._status.due():
            self._publish_diagnostics()
        return True

    def _end(self) -> bool:
        """Returns whether the node continues after the end of the run: until subscribers have received everything."""
        now = time.monotonic()
        if self._ended is None:
            self._ended = now
            self._publish_diagnostics(final=True)
        return not self._sample_publishers.all_received([self._diagnostics], now - self._ended)

    def close(self) -> None:
        """End the run, if a signal came before its end."""
        self._sample_publishers.stopped = True
        self.run_loop.requests.stop()
        self._thread.join(SIGNAL_TIMEOUT)
        if self._ended is None:
            self._publish_diagnostics(final=True)
            self._diagnostics.wait_for_all_acked(Duration(seconds=SIGNAL_TIMEOUT))
        if self._thread.is_alive():  # the thread is in a step, and still needs its publishers
            exit_immediately(0)
        if self.run_loop.given_up:
            self.failure = self.failure or "the simulation stopped before its end"

    def answer_to(self, names: list[str]) -> str:
        """The answer to a change of the parameters `names`: when it acts. Empty if it acts at once."""
        return self.parameters.answer_to(names)

    def _look_at_other_nodes(self) -> None:
        makes_clock, requests = self.parameters.values.makes_clock, self.run_loop.requests
        self._other_nodes.look(makes_clock)
        holding = self._other_nodes.holding
        offers = makes_clock and self._other_nodes.clock_is_free and not holding
        if holding != self._holding:
            requests.put(self.run_loop.hold, holding, urgent=True)
        if offers != self._offers_clock:
            requests.put(self._sample_publishers.enable_clock, offers)
        self._holding, self._offers_clock = holding, offers

    def _publish_static(self) -> None:
        """Publish static transforms: from the root frame that swimmers share to the world frame, and from the head to
        sensors on a rigid part of the body.

        Late subscribers get them too. If a reset removes them, the message is empty; listeners keep their frames.
        """
        values, transforms = self.parameters.values, list(self._sample_publishers.sensors.static)
        if values.root_frame and values.publish_tf:
            transforms.append(root_transform(values))
        if transforms != self._static_transforms:
            if self._static_publisher is None:
                self._static_publisher = self.create_publisher(TFMessage, "/tf_static", latched(1))
            self._static_publisher.publish(TFMessage(transforms=transforms))
            self._static_transforms = transforms

    def _publish_diagnostics(self, final: bool = False) -> None:
        """Publish /diagnostics; `final`: at the end of the run."""
        level, text, values = self._status.collect(self.count_publishers("curvature_law"), final)
        values |= self._other_nodes.values(self.parameters.values.makes_clock)
        name = self.get_fully_qualified_name()
        self._diagnostics.publish(diagnostic_array(self.run_loop.time, name, level, text, values))

    def _receive_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            self._other_nodes.receive(status.name, values_of_status(status))

    # Services.

    async def _reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        values, sensors, new = self.parameters.next_values, self.parameters.next_sensors, None
        if self.parameters.pending:
            try:
                new = simulation_from_parameters(*self.parameters.next)
                check_inputs(new, values)
            except (ValueError, OSError) as error:
                response.message = f"reset refused: {one_line(error)}"
                self.get_logger().error(response.message)
                return response
            self._log_notes(new.robot)
        answer = self.run_loop.requests.put(self.run_loop.reset, new, values, sensors, urgent=True)
        return await answered(response, answer, "reset")

    async def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        answer = self.run_loop.requests.put(self.run_loop.pause, request.data, urgent=True)
        return await answered(response, answer, "paused" if request.data else "going on")

    async def _set_state(self, request: SetState.Request, response: SetState.Response) -> SetState.Response:
        try:
            state = state_from_message(request)
        except ValueError as error:
            response.message = str(error)
            return response
        answer = self.run_loop.requests.put(self.run_loop.set_state, *state, urgent=True)
        return await answered(response, answer, "head put into the state")

    async def _step(self, request: Step.Request, response: Step.Response) -> Step.Response:
        if not 1 <= request.samples <= MOST_STEPS:
            response.message = f"samples must be 1 to {MOST_STEPS}, got {request.samples}"
            return response
        steps = Answer(self._inbox)
        self.run_loop.requests.put(self.run_loop.step, request.samples, steps, urgent=True)
        await steps
        response.success, response.stamp = not steps.failure, stamp_of(steps.time)
        many = "s" if request.samples > 1 else ""
        response.message = steps.failure or f"{request.samples} sample{many} published, paused at t = {steps.time:g} s"
        return response


async def answered(response: Any, answer: Answer, state: str) -> Any:
    """The `response` of a service with the run loop's `answer`; `state`: the state afterwards, as text."""
    answer.deadline = time.monotonic() + SERVICE_TIMEOUT
    await answer
    done = answer.done.is_set()
    response.success = done and not answer.failure
    if answer.failure:
        response.message = f"refused: {answer.failure}"
    elif done:
        response.message = f"{state} at t = {answer.time:g} s"
    else:
        response.message = f"not done within {SERVICE_TIMEOUT:g} s, still queued"
    return response


def parameter_rows() -> Iterator[tuple[Any, ...]]:
    """Name, description and default of each parameter."""
    yield from help_rows(DynamicsParameters)
    yield from help_rows(Scene, "scene.")
    for name, kind in KINDS.items():
        yield from help_rows(kind, f"{name}.")


def main(args: list[str] | None = None) -> int:
    """Run the node. Exit status: 0 after its duration, SIGINT or SIGTERM; 1 if it fails, or if an unattended simulation
    (with a duration, as fast as possible) stops; 2 if it cannot start."""
    words, look = sys.argv if args is None else args, DynamicsNode.look
    status = run_node(NAME, words, DynamicsNode, look, about=ABOUT, parameters=parameter_rows(), period=LOOK_PERIOD)
    if status == CANNOT_START:
        return status
    rclpy.get_default_context().destroy()  # leaves the network: others would wait 20 s for this node
    return exit_immediately(status)
