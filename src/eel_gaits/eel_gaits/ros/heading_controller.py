# SPDX-License-Identifier: Apache-2.0
"""A heading controller: it reads the heading from /odom, and answers each sample with the curvature some time ahead.

It swims straight, and bends the whole body towards the target heading. Its answers are `curvature_samples`, so a
simulation that runs as fast as possible (`real_time_factor:=0`) keeps in step with it. See docs/howto/controllers.md.
"""

import math
import sys
from dataclasses import dataclass

import numpy as np
from eel_common.attitude import heading
from eel_common.quantity import Quantities, quantity
from eel_common.ros.headers import seconds_of
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.parameters import declare_all, help_rows
from eel_common.ros.qos import keep_all
from eel_common.ros.run_node import run_node
from nav_msgs.msg import Odometry

from eel_gaits.gaits.swimming import straight
from eel_gaits.ros.lead import Lead
from eel_gaits.ros.messages import samples_to_message
from eel_gaits.ros.pilot_messages import head_motion
from eel_msgs.msg import CurvatureSamples

NAME = "heading_controller"
ABOUT = "Swims towards a heading: answers each sample on odom with one on curvature_samples."
FOLLOWING = 3.0  # rad/s: bandwidth of the bend's response to the heading error


@dataclass(frozen=True, kw_only=True)
class HeadingParameters(Quantities):
    """The parameters of the controller."""

    heading: float = quantity(
        0.5, "rad", "target heading in the world frame; positive: left", -1e3, 1e3, changeable=True
    )
    gain: float = quantity(1.0, "1/m", "bend of the body by error of the heading", 0.0, 1e3, changeable=True)
    greatest_bend: float = quantity(0.5, "rad/m", "limit of that bend", 0.0, 1e3, changeable=True)
    period: float = quantity(
        0.01, "s", "time from one sample of the curvature to the next, whatever the rate of odom", 1e-3, 1.0
    )
    lead: float = quantity(
        0.1,
        "s",
        "time by which samples are sent ahead of odom; at least a period, and the dynamics node's 1/rate",
        1e-3,
        1.0,
    )
    length: float = quantity(1.0, "m", "body length", 1e-4, 1e3)


class HeadingController(ParameterNode):
    """A node with the topics `odom` (in) and `curvature_samples` (out)."""

    def __init__(self) -> None:
        super().__init__(NAME)
        (given,) = declare_all(self, HeadingParameters)
        self.gait, self.x = straight(), np.linspace(0.0, given.length, 21)
        self.period, self.lead = given.period, Lead(given.period, given.lead)
        self.bend, self.last = np.zeros(3), math.inf
        self.answers: list[CurvatureSamples] = []
        self.publisher = self.create_publisher(CurvatureSamples, "curvature_samples", keep_all())
        self.create_subscription(Odometry, "odom", self.receive, keep_all())

    def receive(self, odometry: Odometry) -> None:
        """Answer one sample with the curvature up to `lead` later. A repeated stamp gets the same answers."""
        now, head = seconds_of(odometry.header.stamp), head_motion(odometry)  # bad values raise: the message is dropped
        if now != self.last:
            self.last, self.answers = now, []
            if self.lead.begins(now):
                self.bend = np.zeros(3)
                self.answers.append(self.sample(self.lead.begin(now)))
            for time in self.lead.after(now):
                self.bend = self.next_bend(heading(head.orientation))
                if time > now:
                    self.answers.append(self.sample(time))
        for answer in self.answers:
            self.publisher.publish(answer)

    def next_bend(self, present: float) -> np.ndarray:
        """The bend of the body one period later at the `present` heading [rad]: K3 [rad/m], its rate and acceleration.
        K3 > 0 turns to the right."""
        target, gain, limit = (self.get_parameter(name).value for name in ("heading", "gain", "greatest_bend"))
        wanted = -gain * math.remainder(target - present, 2.0 * math.pi)
        value, rate, _ = self.bend
        acceleration = FOLLOWING**2 * (max(-limit, min(limit, wanted)) - value) - 2.0 * FOLLOWING * rate
        rate += self.period * acceleration
        return np.array((value + self.period * rate, rate, acceleration))

    def sample(self, time: float) -> CurvatureSamples:
        """The curvature message for `time` [s]: the gait plus the bend."""
        yaw = [rows[:, 2] + bend for rows, bend in zip(self.gait.curvature(time, self.x), self.bend, strict=True)]
        pitch = np.zeros((3, len(self.x)))
        return samples_to_message(time, self.x, np.vstack((pitch, *yaw)))


def main(args: list[str] | None = None) -> int:
    """Run the node. The exit status is 0 after SIGINT or SIGTERM, and 2 if a parameter or word is refused at start."""
    rows = help_rows(HeadingParameters)
    return run_node(NAME, sys.argv if args is None else args, HeadingController, about=ABOUT, parameters=rows)


if __name__ == "__main__":
    sys.exit(main())
