# SPDX-License-Identifier: Apache-2.0
"""The task Eel/WayPoints-v0: swim through points, one after the other."""

import math
from dataclasses import dataclass

import numpy as np
from eel_base.quantity import quantity
from eel_dynamics.model.scene import Scene
from eel_gaits.pilot.head_motion import wrapped

from eel_gym.swimmer_env import (
    FARTHEST,
    FASTEST,
    GREATEST_START_SPEED,
    SPIN,
    Episode,
    Observed,
    Start,
    SwimmerEnv,
)


@dataclass(frozen=True, kw_only=True)
class WayPointsNumbers(Episode):
    """The numbers of the task."""

    duration: float = quantity(
        40.0, unit="s", description="length of an episode, at which it is truncated", minimum=0.1, maximum=1e5
    )
    points: float = quantity(3.0, unit="", description="number of points", minimum=1.0, maximum=100.0)
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

    An episode begins at the origin, with a random speed and phase of the gait; each leg turns by up to `greatest_turn`.
    The action is the bend of the whole body, added to the gait straight(). The swimmer moves in the plane, as in
    Eel/Heading-v0.

    The reward of a control step is how much nearer the head has come to the present point [m], and 1 for a point that
    it reaches. An episode ends, besides by `duration`, with the last point, or where the head is farther from a point
    than twice `distance`.
    """

    name = "WayPoints"
    Numbers = WayPointsNumbers
    numbers: WayPointsNumbers
    observed = (
        Observed(
            "bearing of the point from the heading, averaged over the gait's period; positive: left", "rad", math.pi
        ),
        Observed("distance of the point", "m", FARTHEST),
        Observed("turn at the point to the next one, 0 at the last; positive: left", "rad", math.pi),
        Observed("yaw rate of the head, positive: left", "rad/s", SPIN),
        Observed("velocity of the head, forward", "m/s", FASTEST),
        Observed("velocity of the head, to the left", "m/s", FASTEST),
    )

    def __init__(self, **settings):
        super().__init__(**settings)
        self.points: list[tuple[float, float]] = [(0.0, 0.0)]  # m, those to be reached
        self._turns = [0.0]  # rad, at each of them
        self._distance, self._reached = 0.0, False  # m, before the last step; whether it ended at the last point

    def default_scene(self) -> Scene:
        """Motion in the plane."""
        return Scene(planar=True, internal_wrench=False, ledger=False)

    def begin(self, options: dict) -> Start:
        """Random points."""
        numbers, draw = self.numbers, self.np_random.uniform
        turns: np.ndarray = np.asarray(draw(-numbers.greatest_turn, numbers.greatest_turn, round(numbers.points)))
        x = y = bearing = 0.0
        self.points, self._turns = [], [*turns[1:].tolist(), 0.0]
        for turn in turns.tolist():
            bearing += turn
            x, y = x + numbers.distance * math.cos(bearing), y + numbers.distance * math.sin(bearing)
            self.points.append((x, y))
        self._distance, self._reached = numbers.distance, False
        return Start(speed=draw(0.0, GREATEST_START_SPEED), own_time=draw(0.0, self.action.period))

    def observe(self) -> list[float]:
        """Bearing and distance of the point, turn to the next, yaw rate, velocity in the plane."""
        forward, left, _ = self.head.velocity.tolist()
        bearing, distance = self._way()
        return [
            wrapped(bearing - self.heading),
            distance,
            self._turns[0],
            float(self.head.angular_velocity[2]),
            forward,
            left,
        ]

    def reward(self) -> float:
        """See the class."""
        _, distance = self._way()
        gain, self._distance = self._distance - distance, distance
        if distance > self.numbers.reach:
            return gain
        self._reached = len(self.points) == 1
        if not self._reached:
            self.points, self._turns = self.points[1:], self._turns[1:]
            self._distance = self._way()[1]
        return gain + 1.0

    def ended(self) -> bool:
        """Whether the last point is reached, or the present one is too far."""
        return self._reached or self._distance > 2.0 * self.numbers.distance

    def marks(self) -> list[tuple[float, float, float]]:
        """The points that are left."""
        return [(x, y, 0.0) for x, y in self.points]

    def _way(self) -> tuple[float, float]:
        """Bearing [rad] in the world and distance [m] of the present point."""
        x, y, _ = self.head.position.tolist()
        east, north = self.points[0][0] - x, self.points[0][1] - y
        return math.atan2(north, east), math.hypot(east, north)
