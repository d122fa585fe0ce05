# SPDX-License-Identifier: Apache-2.0
"""The task Eel/Heading-v0: hold a heading."""

import math
from dataclasses import dataclass
from typing import Any

from eel_common.attitude import components
from eel_common.head_motion import wrapped
from eel_common.quantity import quantity
from eel_dynamics.model.scene import Scene

from eel_gym.swimmer_env import SwimmerEnv
from eel_gym.task import ANGLE, GREATEST_START_SPEED, SPEED, SPIN, Episode, Observed, Start


@dataclass(frozen=True, kw_only=True)
class HeadingNumbers(Episode):
    """The numbers of the task."""

    target: float = quantity(
        0.0, unit="rad", description="heading to hold; positive: left", minimum=-math.pi, maximum=math.pi
    )
    greatest_error: float = quantity(
        1.0, unit="rad", description="greatest error of the heading at the start", minimum=0.0, maximum=math.pi
    )
    greatest_trim: float = quantity(
        0.1, unit="rad/m", description="greatest bend that the body has by itself, unseen", minimum=0.0, maximum=1.0
    )


class HeadingEnv(SwimmerEnv):
    """Hold a heading: Eel/Heading-v0.

    An episode begins with a random heading, speed and phase of the gait. The body has a small bend of its own, which
    the policy does not see. The action is a bend of the whole body, added to the gait straight(). The swimmer moves in
    the plane. In space a straight swimmer is unstable: it dives and rolls over (docs/howto/learning.md).

    The reward of a control step is control_period (1 - error / pi) [s], with the magnitude of the heading error. The
    heading is averaged over the last period of the gait, as the head swings. An episode ends only after `duration`.
    """

    name = "Heading"
    Numbers = HeadingNumbers
    numbers: HeadingNumbers
    observed = (
        Observed(
            "error of the heading, averaged over the gait's period; positive: the target is to the left", "rad", ANGLE
        ),
        Observed("error of the head's heading now", "rad", ANGLE),
        Observed("yaw rate of the head, positive: left", "rad/s", SPIN),
        Observed("velocity of the head, forward", "m/s", SPEED),
        Observed("velocity of the head, to the left", "m/s", SPEED),
    )

    def __init__(self, **settings: Any):
        super().__init__(**settings)
        self.target = self.numbers.target  #: rad

    def default_scene(self) -> Scene:
        """Motion in the plane only."""
        return Scene(planar=True, internal_wrench=False, ledger=False)

    def begin(self, options: dict[str, Any]) -> Start:
        """A random start."""
        draw = self.np_random.uniform
        return Start(
            heading=self.target + draw(-1.0, 1.0) * self.numbers.greatest_error,
            speed=draw(0.0, GREATEST_START_SPEED),
            own_time=draw(0.0, self.action.period),
            left_trim=draw(-1.0, 1.0) * self.numbers.greatest_trim,
        )

    def observe(self) -> list[Any]:
        """Errors of the heading, yaw rate, velocity in the plane."""
        (_, _, yaw_rate), (forward, left, _) = map(components, (self.head.angular_velocity, self.head.velocity))
        return [self.error, wrapped(self.target - self.head_heading), yaw_rate, forward, left]

    @property
    def error(self) -> Any:
        """Error [rad] of the heading, averaged over the gait's period."""
        return wrapped(self.target - self.heading)

    def reward(self) -> Any:
        """See the class."""
        return self.numbers.control_period * (1.0 - abs(self.error) / math.pi)

    def marks(self) -> list[tuple[float, float, float]]:
        """A point one metre ahead, on the wanted heading."""
        x, y, z = self.head.position.tolist()
        return [(x + math.cos(self.target), y + math.sin(self.target), z)]
