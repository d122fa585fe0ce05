# SPDX-License-Identifier: Apache-2.0
"""The pilot's estimate of the swimmer, from the head's motion: means without the swing of the beat, and the water.

The body swims in a plane that the beat preserves: all sections move the same way across it. The head's up axis is
normal to it and does not swing. So the roll and the climb of that plane are known at once, about the mean heading.
Heading and velocity need a mean over a period of the gait. That period depends on the tempo, so the mean is taken over
a period of the gait's own time, in which the swings cancel. The rate of change corrects the lag of half a period.

The water's velocity is the mean velocity over ground less the gait's velocity through the water, filtered with a time
constant. It also contains every other deviation from the expected speed: it is the integral action of the pilot.
"""

import math
from collections import deque
from typing import Any, NamedTuple

import numpy as np
from eel_common.attitude import world_from_body
from eel_common.head_motion import HeadMotion, wrapped


class Estimate(NamedTuple):
    """The present state of the swimmer, in REP-103 axes."""

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
    water: np.ndarray  # (2,) m/s, estimated horizontal velocity of the water
    settled: bool  # whether a whole period has passed


class Estimator:
    """Takes in one `HeadMotion` after another.

    period: [s], of the gait at tempo 1. speed_time: [s], time constant of the speed through the water. water_time: [s],
    time constant of the water's estimated velocity.
    """

    def __init__(self, *, period: float, speed_time: float, water_time: float) -> None:
        self._means = PeriodMeans(5, period)  # position, heading, speed through the water
        self._speed_time, self._water_time = speed_time, water_time
        self._heading = 0.0  # rad, unwrapped
        self._time = -math.inf
        self._speed, self._water = 0.0, np.zeros(2)

    def restart(self) -> None:
        """Reset the estimate, but keep the water's velocity."""
        self._means.clear()
        self._time, self._speed = -math.inf, 0.0

    def add(self, time: float, head: HeadMotion, own_time: float, gait_speed: float) -> Estimate:
        """The estimate at `time` [s]. own_time: [s], of the gait. gait_speed: [m/s], of the gait in still water."""
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
        return Estimate(
            time=time,
            position=mean[:3] + lag * rate[:3],
            velocity=rate[:3],
            heading=wrapped(heading),
            heading_rate=float(rate[3]),
            **plane_of(head, heading),
            rise=float(head.velocity[2]),
            water=self._water.copy(),
            settled=whole,
        )


def plane_of(head: HeadMotion, heading: float) -> dict[str, float]:
    """Roll and climb [rad] of the plane normal to the head's up axis about a level frame of this `heading` [rad], and
    their rates [rad/s]."""
    forward, left, up = world_from_body(head.orientation).T
    turning = head.angular_velocity[0] * forward + head.angular_velocity[1] * left  # without the part about `up`
    c, s = math.cos(heading), math.sin(heading)
    level = np.array(((c, s), (-s, c)))
    (ahead, aside), (ahead_rate, aside_rate) = level @ up[:2], level @ turning[:2]
    climb = math.asin(max(-1.0, min(1.0, -ahead)))
    roll = math.atan2(-aside, up[2])
    return {"roll": roll, "climb": climb, "roll_rate": float(ahead_rate), "climb_rate": float(-aside_rate)}


class Means(NamedTuple):
    """Means of signals over the last period."""

    mean: np.ndarray  # (n,) of each signal
    rate: np.ndarray  # (n,) per s: change over the period, divided by its length
    span: float  # s, length of that period
    whole: bool  # whether a whole period has passed


class PeriodMeans:
    """Collects `count` signals and gives their means over the last `period` [s] of the gait's own time."""

    def __init__(self, count: int, period: float) -> None:
        self._period = period
        self._rows: deque[Any] = deque()  # time, own time, signals and their integrals since the start
        self._empty = np.zeros(count)

    def clear(self) -> None:
        """Forget all signals."""
        self._rows.clear()

    def add(self, time: float, own_time: float, signals: Any) -> Means:
        """Add the `signals` (n,) at `time` [s] and the gait's own time `own_time` [s]; return the present means."""
        signals = np.asarray(signals, dtype=float)
        if not self._rows:
            self._rows.append((time, own_time, signals, self._empty))
            return Means(signals, self._empty, 0.0, False)
        before, _, last, integral = self._rows[-1]
        integral = integral + 0.5 * (time - before) * (last + signals)
        self._rows.append((time, own_time, signals, integral))
        begin = own_time - self._period
        while len(self._rows) > 2 and self._rows[1][1] <= begin:
            self._rows.popleft()
        first, start = self._rows[0], self._row_at(begin)
        span = time - start[0]
        return Means((integral - start[2]) / span, (signals - start[1]) / span, span, first[1] <= begin)

    def _row_at(self, own_time: float) -> tuple[Any, ...]:
        """Time, signals and integrals at `own_time` [s], which must lie in the oldest interval or before it."""
        (t0, tau0, signals0, integral0), (t1, tau1, signals1, _) = self._rows[0], self._rows[1]
        share = (own_time - tau0) / (tau1 - tau0) if own_time > tau0 else 0.0
        time, signals = t0 + share * (t1 - t0), signals0 + share * (signals1 - signals0)
        return time, signals, integral0 + 0.5 * (time - t0) * (signals0 + signals)
