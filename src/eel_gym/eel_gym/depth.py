# SPDX-License-Identifier: Apache-2.0
"""The task Eel/Depth-v0: swim to a depth and hold it."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_common.attitude import components
from eel_common.head_motion import wrapped
from eel_common.quantity import quantity

from eel_gym.swimmer_env import SwimmerEnv
from eel_gym.task import ANGLE, GREATEST_START_SPEED, SPEED, SPIN, Episode, Observed, Start

HEIGHT = 0.5  # m, scale of the observed error
LEAST_CHANGE = 0.05  # body lengths: least scale of the reward, for a task without a change of depth


@dataclass(frozen=True, kw_only=True)
class DepthNumbers(Episode):
    """The numbers of the task."""

    greatest_change: float = quantity(
        0.5, unit="m", description="greatest change of depth that is asked for", minimum=0.0, maximum=10.0
    )
    greatest_roll_rate: float = quantity(
        0.01, unit="rad/s", description="greatest rate of roll at the start", minimum=0.0, maximum=10.0
    )
    roll_limit: float = quantity(
        1.0, unit="rad", description="roll of the head at which an episode ends", minimum=0.01, maximum=math.pi
    )


class DepthEnv(SwimmerEnv):
    """Swim to a depth and hold it: Eel/Depth-v0.

    An episode begins level, with a random speed, phase of the gait and small rate of roll. The wanted depth is up to
    `greatest_change` above or below. The action is a bend of the whole body to the left and upwards, added to the gait
    straight(). In space this gait dives and rolls over by itself; the policy must prevent that.

    The reward of a control step is control_period (1 - error / (2 greatest_change)) [s], at least 0, with the magnitude
    of the head's depth error. A `greatest_change` below a twentieth of the body's length counts as that. An episode
    ends after `duration`, or when the head rolls beyond `roll_limit`.
    """

    name = "Depth"
    Numbers = DepthNumbers
    numbers: DepthNumbers
    observed = (
        Observed("error of the depth; positive: the target is above", "m", HEIGHT),
        Observed("velocity of the head, upwards in the world", "m/s", SPEED),
        Observed("angle of the head above the horizontal", "rad", ANGLE),
        Observed("roll of the head; positive: right side down", "rad", ANGLE),
        Observed("heading since the start, averaged over the gait's period; positive: left", "rad", ANGLE),
        Observed("angular velocity of the head, about forward", "rad/s", SPIN),
        Observed("angular velocity of the head, about left", "rad/s", SPIN),
        Observed("angular velocity of the head, about up", "rad/s", SPIN),
        Observed("velocity of the head, forward", "m/s", SPEED),
        Observed("velocity of the head, to the left", "m/s", SPEED),
        Observed("velocity of the head, up in its axes", "m/s", SPEED),
    )

    def begin(self, options: dict[str, Any]) -> Start:
        """A random start, and a random depth."""
        draw = self.np_random.uniform
        target = draw(-1.0, 1.0) * self.numbers.greatest_change
        return Start(
            speed=draw(0.0, GREATEST_START_SPEED),
            roll_rate=draw(-1.0, 1.0) * self.numbers.greatest_roll_rate,
            own_time=draw(0.0, self.action.period),
            goal=(target,),
        )

    @property
    def target(self) -> Any:
        """Height [m] of the wanted depth, z up."""
        return self.goal[0]

    def observe(self) -> list[Any]:
        """Error of the depth, vertical speed, attitude, twist."""
        head = self.head
        climb, roll = head.climb, head.roll
        spin, (forward, left, up) = map(components, (head.angular_velocity, head.velocity))
        rise = forward * np.sin(climb) + np.cos(climb) * (left * np.sin(roll) + up * np.cos(roll))
        return [self.error, rise, climb, roll, wrapped(self.heading), *spin, forward, left, up]

    @property
    def error(self) -> Any:
        """Error [m] of the head's depth; positive: the target is above."""
        return self.target - self.head.position[2]

    def reward(self) -> Any:
        """See the class."""
        scale = 2.0 * max(self.numbers.greatest_change, LEAST_CHANGE * self.body.length)
        return self.numbers.control_period * np.maximum(0.0, 1.0 - abs(self.error) / scale)

    def ended(self) -> Any:
        """Whether the swimmer has rolled too far."""
        return abs(self.head.roll) > self.numbers.roll_limit

    def marks(self) -> list[tuple[float, float, float]]:
        """A point one metre ahead, at the wanted depth."""
        x, y, _ = self.head.position.tolist()
        return [(x + 1.0, y, float(self.target))]
