# SPDX-License-Identifier: Apache-2.0
"""The task Eel/WayPoints-v0: swim through points, one after the other."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_common.attitude import components
from eel_common.head_motion import wrapped
from eel_common.quantity import quantity
from eel_dynamics.model.scene import Scene

from eel_gym.swimmer_env import SwimmerEnv
from eel_gym.task import ANGLE, GREATEST_START_SPEED, SPEED, SPIN, Episode, Observed, Start


@dataclass(frozen=True, kw_only=True)
class WayPointsNumbers(Episode):
    """The numbers of the task."""

    duration: float = quantity(
        40.0, unit="s", description="length of an episode, at which it is truncated", minimum=0.1, maximum=1e5
    )
    points: float = quantity(5.0, unit="", description="number of points", minimum=1.0, maximum=100.0)
    distance: float = quantity(
        3.0, unit="m", description="distance from one point to the next", minimum=0.5, maximum=100.0
    )
    greatest_turn: float = quantity(
        1.0, unit="rad", description="greatest turn from one leg to the next", minimum=0.0, maximum=math.pi
    )
    reach: float = quantity(
        0.3, unit="m", description="distance of the head at which a point is reached", minimum=0.01, maximum=10.0
    )


class WayPointsEnv(SwimmerEnv):
    """Swim through points, one after the other: Eel/WayPoints-v0.

    An episode begins at the origin, with a random speed and phase of the gait. Each leg turns by up to `greatest_turn`.
    The action is a bend of the whole body, added to the gait straight(). The swimmer moves in the plane, as in
    Eel/Heading-v0.

    The reward of a control step is the decrease of the head's distance from the present point [m], plus 1 for reaching
    it. An episode ends after `duration`, after the last point, or when the head is farther from a point than twice
    `distance`.
    """

    name = "WayPoints"
    Numbers = WayPointsNumbers
    numbers: WayPointsNumbers
    observed = (
        Observed(
            "bearing of the point from the heading, averaged over the gait's period; positive: left", "rad", ANGLE
        ),
        Observed("distance of the point, by that between points", "", 1.0),
        Observed("turn at the point to the next one, 0 at the last; positive: left", "rad", ANGLE),
        Observed("yaw rate of the head, positive: left", "rad/s", SPIN),
        Observed("velocity of the head, forward", "m/s", SPEED),
        Observed("velocity of the head, to the left", "m/s", SPEED),
    )

    def default_scene(self) -> Scene:
        """Motion in the plane only."""
        return Scene(planar=True, internal_wrench=False, ledger=False)

    def begin(self, options: dict[str, Any]) -> Start:
        """Random points. The goal: number of points reached, last distance [m], then x and y [m] of each point and the
        turn [rad] there, 0 at the last."""
        numbers, draw = self.numbers, self.np_random.uniform
        turns: np.ndarray = np.asarray(draw(-numbers.greatest_turn, numbers.greatest_turn, round(numbers.points)))
        bearings = np.cumsum(turns)
        x, y = (numbers.distance * np.cumsum(part) for part in (np.cos(bearings), np.sin(bearings)))
        goal = (0.0, numbers.distance, *x.tolist(), *y.tolist(), *turns[1:].tolist(), 0.0)
        return Start(speed=draw(0.0, GREATEST_START_SPEED), own_time=draw(0.0, self.action.period), goal=goal)

    def observe(self) -> list[Any]:
        """Bearing and distance of the point, turn to the next, yaw rate, velocity in the plane."""
        (_, _, yaw_rate), (forward, left, _) = map(components, (self.head.angular_velocity, self.head.velocity))
        bearing, distance, turn = self._way()
        return [wrapped(bearing - self.heading), distance / self.numbers.distance, turn, yaw_rate, forward, left]

    def reward(self) -> Any:
        """See the class."""
        _, distance, _ = self._way()
        gain, reached = self.goal[1] - distance, distance <= self.numbers.reach
        self.goal[0] += reached
        self.goal[1] = np.where(reached & (self.goal[0] < self._count), self._way()[1], distance)
        return gain + reached

    def ended(self) -> Any:
        """Whether the last point is reached, or the present one is too far."""
        return (self.goal[0] >= self._count) | (self.goal[1] > 2.0 * self.numbers.distance)

    @property
    def points(self) -> list[tuple[float, float]]:
        """The remaining points [m] of one swimmer."""
        _, _, *numbers = self.goal.tolist()
        count = self._count
        return list(zip(numbers[:count], numbers[count : 2 * count], strict=True))[int(self.goal[0]) :]

    def marks(self) -> list[tuple[float, float, float]]:
        """The remaining points."""
        return [(x, y, 0.0) for x, y in self.points]

    @property
    def _count(self) -> int:
        return round(self.numbers.points)

    def _way(self) -> tuple[Any, Any, Any]:
        """Bearing [rad] in the world and distance [m] of the present point, or the last; and the turn [rad] there."""
        place = np.minimum(self.goal[0], self._count - 1).astype(int)
        parts = self.goal[2:].reshape(3, self._count, *self.shape)
        x, y, turn = parts[:, place, *map(np.arange, self.shape)]
        east, north = x - self.head.position[0], y - self.head.position[1]
        return np.arctan2(north, east), np.hypot(east, north), turn
