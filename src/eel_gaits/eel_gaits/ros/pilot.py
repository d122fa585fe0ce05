# SPDX-License-Identifier: Apache-2.0
"""The pilot: subscribes to `odom` and goals, and answers with the curvature that leads the swimmer there.

Goals are the parameters heading, depth and speed, a path on `goal_path`, or a station on `goal_pose`; the last counts.
A goal out of reach is refused in one line, and the last goal stays. The topic `goal` shows the present goal. See
docs/howto/pilot.md.
"""

import math
import sys
from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np
from eel_common.head_motion import HeadMotion
from eel_common.ros.headers import frame_in, seconds_of
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.parameters import declare_all, help_rows
from eel_common.ros.qos import keep_all, latched
from eel_common.ros.run_node import run_node
from eel_common.wording import shown
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry, Path
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from rclpy.subscription import Subscription

from eel_gaits.pilot import goals
from eel_gaits.pilot.pilot import Pilot
from eel_gaits.pilot.settings import GROUPS, GoalParameters, TimingParameters
from eel_gaits.ros.lead import Lead
from eel_gaits.ros.messages import FRAME, samples_to_message
from eel_gaits.ros.pilot_messages import head_motion, path_message, point_of, read_path
from eel_msgs.msg import CurvatureSamples, SwimState

NAME = "pilot"
ABOUT = "Swims to goals: subscribes to odom, goal_path and goal_pose, and answers on curvature_samples."
MOST_WAITING = 50  # odom samples waiting for the torque of their time, and torques waiting for an odom
LONGEST_GAP = 2.0  # s between two odom samples: after a longer gap the body is at rest, as no answer reaches so far


class PilotNode(ParameterNode):
    """A node with the topics `odom`, `goal_path`, `goal_pose`, `swim_state` (in), `curvature_samples`, `goal` (out)."""

    def __init__(self) -> None:
        super().__init__(NAME)
        self._numbers: GoalParameters
        self._timing: TimingParameters
        self._numbers, self._timing, settings = declare_all(self, *GROUPS)
        self._pilot = Pilot(settings)
        self._goal = self.create_publisher(Path, "goal", latched(1))  # the present goal
        self._follow(self._course(self._numbers), "parameters")
        self._frames = {frame_in(self.get_namespace(), "odom"), ""}
        self._section_frame = frame_in(self.get_namespace(), FRAME)
        self._lead = Lead(self._timing.sample_period, self._timing.lead)
        self._last = math.inf  # s, time of the last odom
        self._answers: list[CurvatureSamples] = []  # answers to the last odom
        self._waiting: list[tuple[float, HeadMotion, str]] = []  # time [s] and frame of each
        self._torques: dict[float, float] = {}  # time [s]: torque [N m]
        self._torque_comes = False  # whether swim_state has come, and each since
        self._publisher = self.create_publisher(CurvatureSamples, "curvature_samples", keep_all())
        self.create_subscription(Odometry, "odom", self._receive, keep_all())
        self.create_subscription(Path, "goal_path", self._receive_path, 10, raw=True)
        self.create_subscription(PoseStamped, "goal_pose", self._receive_pose, 10)
        self._swim_state: Subscription | None = None
        self._subscribe_to_torque()
        self.add_on_set_parameters_callback(self._change)

    # -- goals

    def _course(self, numbers: GoalParameters) -> goals.Course:
        return goals.course(numbers.heading, numbers.depth, numbers.speed, self._pilot.settings.limits)

    def _change(self, parameters: list[Parameter]) -> SetParametersResult:
        changes = {each.name: each.value for each in parameters if each.name in GoalParameters.__dataclass_fields__}
        if not changes:
            return SetParametersResult(successful=True)
        present = {item.name: getattr(self._numbers, item.name) for item in fields(GoalParameters)}
        try:
            numbers = GoalParameters(**present | changes)
            course = self._course(numbers)
        except ValueError as error:
            self.get_logger().warning(f"refused: {error}")
            return SetParametersResult(successful=False, reason=str(error))
        self._numbers = numbers
        if "heading" in changes or "depth" in changes:
            self._follow(course, "parameters")
        elif "speed" in changes:
            self._pilot.change_speed(numbers.speed)
        self._subscribe_to_torque()
        return SetParametersResult(successful=True)

    def _receive_path(self, data: bytes, about: dict[str, Any]) -> None:
        def goal() -> Any:
            message = read_path(data)
            self._check_frame(message.header.frame_id)
            points = [point_of(each.pose.position) for each in message.poses]
            return self._pilot.checked_path(goals.path(points, self._numbers.speed, self._pilot.settings.limits))

        self._take("goal_path", goal)

    def _receive_pose(self, message: PoseStamped) -> None:
        def goal() -> Any:
            self._check_frame(message.header.frame_id)
            return goals.station(point_of(message.pose.position), self._numbers.speed, self._pilot.settings.limits)

        self._take("goal_pose", goal)

    def _take(self, topic: str, make: Callable[[], Any]) -> None:
        try:
            self._follow(make(), topic)
        except ValueError as error:
            self.get_logger().warning(f"{topic} refused, the last goal stays: {error}")

    def _follow(self, goal: Any, source: str) -> None:
        self._pilot.follow(goal)
        self._goal.publish(path_message(goals.way_points(goal), frame_in(self.get_namespace(), "odom")))
        self.get_logger().info(f"{goals.described(goal)}, from {source}")

    def _check_frame(self, frame: str) -> None:
        """`ValueError` for a frame other than odom's."""
        if frame.lstrip("/") not in self._frames:
            known = " or ".join(shown(each) for each in sorted(self._frames - {""})) or "empty"
            raise ValueError(f"frame_id must be {known}, got {shown(frame)}")

    # -- samples: a message with bad values raises, and is dropped

    def _subscribe_to_torque(self) -> None:
        """Subscribe to swim_state while there is a torque limit."""
        wanted = self._numbers.torque_limit > 0.0
        if wanted and self._swim_state is None:
            self._swim_state = self.create_subscription(SwimState, "swim_state", self._receive_state, keep_all())
        elif not wanted and self._swim_state is not None:
            self.destroy_subscription(self._swim_state)
            self._swim_state, self._torque_comes = None, False
            self._torques.clear()
            self._pilot.limit_torque(0.0, 0.0, 0.0)
            self._answer_waiting()

    def _receive_state(self, message: SwimState) -> None:
        now = seconds_of(message.header.stamp)
        known = [time for time in self._torques if time < now][-MOST_WAITING:]  # none of an earlier run
        self._torques = {time: self._torques[time] for time in known} | {now: message.greatest_torque}
        self._torque_comes = True
        if math.isnan(message.greatest_torque):
            self._warn_of_torque("swim_state holds no torque; the dynamics node needs internal_wrench")
        self._answer_waiting()

    def _warn_of_torque(self, reason: str) -> None:
        self.get_logger().warning(f"torque_limit is not kept: {reason}", throttle_duration_sec=10.0)

    def _receive(self, odometry: Odometry) -> None:
        self._waiting.append((seconds_of(odometry.header.stamp), head_motion(odometry), odometry.header.frame_id))
        self._answer_waiting()

    def _answer_waiting(self) -> None:
        """Answer each odom once the torque of its time is known, so that a run is reproducible.

        Nothing waits before swim_state has come, or after it has stopped.
        """
        while self._waiting:
            now, head, frame = self._waiting[0]
            if self._swim_state is not None:
                if now not in self._torques and self._torque_comes:
                    if len(self._waiting) <= MOST_WAITING:
                        return
                    self._torque_comes = False
                    self._warn_of_torque(f"swim_state stays away, at t = {now:.2f} s")
                torque = self._torques.get(now, math.nan)
                self._torques = {time: each for time, each in self._torques.items() if time >= now}
                self._pilot.limit_torque(torque, self._numbers.torque_limit, now)
            self._waiting.pop(0)
            self._answer(now, head, frame)

    def _answer(self, now: float, head: HeadMotion, frame: str) -> None:
        """Send the samples up to `lead` after `now` [s]. A stamp that goes back, or comes after a long gap, is a new
        start; a repeated stamp gets the same answers."""
        if now != self._last:
            self._answers = []
            self._frames = {frame.lstrip("/"), ""}
            gap = now - self._last
            if gap > LONGEST_GAP:
                text = f"odom goes on at t = {now:.9g} s, {gap:.9g} s after the last: a new start"
                self.get_logger().warning(text, throttle_duration_sec=1.0)
            if not 0.0 < gap <= LONGEST_GAP:
                self._add(self._lead.begin(now), self._pilot.begin(), -math.inf)
            self._last = now
            self._pilot.see(now, head)
            for time in self._lead.after(now):
                self._add(time, self._pilot.steer(self._timing.sample_period), now)
        for answer in self._answers:
            self._publisher.publish(answer)
        for news in self._pilot.news:
            text = f"t = {now:.2f} s: {news.text}"
            if news.good:  # rclpy allows one severity per line of code
                self.get_logger().info(text)
            else:
                self.get_logger().warning(text)
        self._pilot.news.clear()

    def _add(self, time: float, rows: np.ndarray, now: float) -> None:
        if time > now:
            self._answers.append(samples_to_message(time, self._pilot.law.x, rows, self._section_frame))


def main(args: list[str] | None = None) -> int:
    """Run the node. The exit status is 0 after SIGINT or SIGTERM, and 2 if a parameter or word is refused at start."""
    words, rows = sys.argv if args is None else args, [row for kind in GROUPS for row in help_rows(kind)]
    return run_node(NAME, words, PilotNode, about=ABOUT, parameters=rows, sim_time=True)


if __name__ == "__main__":
    sys.exit(main())
