# SPDX-License-Identifier: Apache-2.0
"""What the pilot knows of the swimmer from the head's motion alone: means without the swing of the beat, and the water.

The body swims in a plane that the beat keeps: all of its sections move across it alike. The head's up axis is normal to
it and does not swing, so the roll and the climb of that plane are known at once, about the mean heading. Heading and
velocity need a mean over a period; its lag of half a period is made up for by the rate of change.

The water's velocity is the mean velocity over ground less the one that the gait gives through the water, followed with
a time constant. So it also takes in what the swimmer does other than expected: it is the integral action of the pilot.
"""

import math
from typing import NamedTuple

import numpy as np
from eel_base.attitude import world_from_body

from eel_gaits.pilot.head_motion import HeadMotion, wrapped
from eel_gaits.pilot.period_means import PeriodMeans


class Estimate(NamedTuple):
    """The swimmer at present, REP-103 axes."""

    time: float  # s
    position: np.ndarray  # (3,) m, of the head, without its swing
    velocity: np.ndarray  # (3,) m/s, over ground, mean
    heading: float  # rad, without the swing; positive: left
    heading_rate: float  # rad/s, mean
    roll: float  # rad, of the plane of the beat, positive: right side down
    climb: float  # rad, of that plane
    roll_rate: float  # rad/s
    climb_rate: float  # rad/s
    rise: float  # m/s, velocity of the head along its up axis
    water: np.ndarray  # (2,) m/s, horizontal velocity of the water, as far as known
    settled: bool  # whether a whole period has passed


class Estimator:
    """Takes in one `HeadMotion` after another.

    period: [s], of the gait at tempo 1. speed_time: [s], in which the speed follows the gait. water_time: [s], in which
    the estimate of the water's velocity follows.
    """

    def __init__(self, *, period: float, speed_time: float, water_time: float) -> None:
        self._means = PeriodMeans(5, period)  # position, heading, speed through the water
        self._speed_time, self._water_time = speed_time, water_time
        self._heading = 0.0  # rad, unwrapped
        self._time = -math.inf
        self._speed, self._water = 0.0, np.zeros(2)

    def restart(self) -> None:
        """Forget all but the water."""
        self._means.clear()
        self._time, self._speed = -math.inf, 0.0

    def add(self, time: float, head: HeadMotion, own_time: float, gait_speed: float) -> Estimate:
        """The estimate at `time` [s]. own_time [s]: of the gait; gait_speed [m/s]: that it gives in still water."""
        step = time - self._time if math.isfinite(self._time) else 0.0
        self._heading += wrapped(head.heading - self._heading)
        self._speed += (gait_speed - self._speed) * (1.0 - math.exp(-step / self._speed_time))
        self._time = time
        mean, rate, span, whole = self._means.add(time, own_time, [*head.position, self._heading, self._speed])
        lag = 0.5 * span
        heading = mean[3] + lag * rate[3]
        if whole:
            through = mean[4] * np.array((math.cos(mean[3]), math.sin(mean[3])))
            self._water += (rate[:2] - through - self._water) * (1.0 - math.exp(-step / self._water_time))
        plane = Plane.of(head, heading)
        return Estimate(
            time=time,
            position=mean[:3] + lag * rate[:3],
            velocity=rate[:3],
            heading=wrapped(heading),
            heading_rate=float(rate[3]),
            roll=plane.roll,
            climb=plane.climb,
            roll_rate=plane.roll_rate,
            climb_rate=plane.climb_rate,
            rise=float(head.velocity[2]),
            water=self._water.copy(),
            settled=whole,
        )


class Plane(NamedTuple):
    """The plane of the beat."""

    roll: float  # rad
    climb: float  # rad
    roll_rate: float  # rad/s
    climb_rate: float  # rad/s

    @staticmethod
    def of(head: HeadMotion, heading: float) -> "Plane":
        """The plane normal to the head's up axis; its angles [rad] are about a level frame of this `heading` [rad]."""
        forward, left, up = world_from_body(head.orientation).T
        turning = head.angular_velocity[0] * forward + head.angular_velocity[1] * left  # without that about `up`
        c, s = math.cos(heading), math.sin(heading)
        level = np.array(((c, s), (-s, c)))
        (ahead, aside), (ahead_rate, aside_rate) = level @ up[:2], level @ turning[:2]
        climb = math.asin(max(-1.0, min(1.0, -ahead)))
        return Plane(math.atan2(-aside, up[2]), climb, float(ahead_rate), float(-aside_rate))
