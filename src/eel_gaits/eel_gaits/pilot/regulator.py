# SPDX-License-Identifier: Apache-2.0
"""Regulator: from guidance's demand to the numbers of the steered law. State feedback in the gait's own time.

Bends in pitch turn the plane of the beat up and down. A wave in pitch, a quarter of a period behind the wave in yaw
(the number `swirl`), rolls it, so the body can hold its roll without a keel. Both act on the present plane, which needs
no mean over a period. In the gait's own time the swimmer behaves the same at any tempo, as drag grows with the square
of speed. So rates are divided by the tempo, and the response times of the numbers scale with the period. The internal
torque grows with the square of the tempo: where it is too large, the beat slows down.
"""

import math
from dataclasses import dataclass

from eel_common.head_motion import wrapped

from eel_gaits.laws.steered_law import SteeredLaw
from eel_gaits.pilot.estimate import Estimate
from eel_gaits.pilot.guidance import Demand
from eel_gaits.pilot.settings import PilotSettings

KEEL = 0.004  # metacentric height / (length tempo^2) around which the roll gains change
NEAR = 0.1  # body lengths: a larger error of the height is not integrated, against windup on a dive
MOST_CLIMB_OFFSET = 0.1  # rad: most that this integral adds to the climb
RECOVERY = 0.02  # 1/s: growth of the greatest tempo after a limit
LONGEST_STEP = 1.0  # s: a longer gap between two torques counts as this
AT_SLOWEST = 1.05  # times the slowest tempo: a beat below this cannot slow down
SHARE_OF_BEND = 0.5  # of the bend's limit: most that the integral of the climb error takes


@dataclass(frozen=True, kw_only=True)
class Gains:
    """Feedback for a body of 1 m and a gait with a period of 1 s, found from the motion linearised over a period."""

    heading: float = 1.3  # rad/m per rad: bend / error
    heading_rate: float = 0.7  # s/m
    climb: float = 13.4  # rad/m per rad
    climb_rate: float = 7.34  # s/m
    rise: float = -4.28  # rad/m per m/s
    up_bend: float = 21.6  # feedback of the bend itself, and of its rate [s]
    up_bend_rate: float = -2.09
    climb_integral: float = 0.05  # rad/m per rad s, integral action: bend / integral of the climb error
    height: float = 0.01  # 1/m/s, integral action: climb / integral of the height error
    roll: float = 4.16  # 1/rad: swirl / error
    roll_rate: float = 0.135  # s/rad
    roll_with_keel: float = 1.0  # the same two if weight and buoyancy right the body faster than it beats
    roll_rate_with_keel: float = 0.5
    swirl: float = 4.8
    swirl_rate: float = 0.35  # s
    greatest_swirl: float = 0.6


class Regulator:
    """Turns demands into targets of a `SteeredLaw`. `torque` limits the tempo."""

    def __init__(self, settings: PilotSettings, gains: Gains | None = None) -> None:
        self._settings, self._gains = settings, gains or Gains()
        self._climb_offset = 0.0  # rad, integral of the error of the height
        self._bend_offset = 0.0  # rad/m, integral of the error of the climb
        self.torque = TorqueLimiter(settings.slowest_tempo, settings.fastest_tempo)

    def restart(self) -> None:
        """Reset the integrals and the torques."""
        self._climb_offset = self._bend_offset = 0.0
        self.torque.restart()

    @property
    def greatest_speed(self) -> float:
        """The present greatest speed [m/s] through the water."""
        return self._settings.cruise_speed * self.torque.tempo

    def targets(self, demand: Demand, estimate: Estimate, law: SteeredLaw, step: float) -> dict[str, float]:
        """The targets of the numbers for a step of `step` [s]."""
        settings, gains = self._settings, self._gains
        tempo, amplitude = self._beat(demand.speed)
        bend_limit = max(0.0, settings.greatest_curvature - amplitude * law.greatest_curvature)
        bend_limit = min(settings.greatest_bend, bend_limit)
        per_tempo = 1.0 / max(law.values["tempo"][0], settings.slowest_tempo)
        keel = min(1.0, max(0.0, settings.metacentric_height * per_tempo**2 / settings.length / KEEL - 0.5))
        high = demand.height - estimate.position[2]
        if abs(high) < NEAR * settings.length and demand.speed > 0.0:
            self._climb_offset = _limited(self._climb_offset + step * gains.height * high, MOST_CLIMB_OFFSET)
        climb = _limited(demand.climb, settings.greatest_climb) + self._climb_offset
        if demand.speed > 0.0:
            more = step * gains.climb_integral * (climb - estimate.climb)
            self._bend_offset = _limited(self._bend_offset + more, SHARE_OF_BEND * bend_limit)
        bend, bend_rate, _ = law.values["up_bend"]
        swirl, swirl_rate, _ = law.values["swirl"]
        length = settings.length
        up = (
            gains.climb * (climb - estimate.climb)
            - gains.climb_rate * per_tempo * estimate.climb_rate
            - gains.rise * per_tempo * estimate.rise / length
            + (1.0 + gains.up_bend) * self._bend_offset * length
            - gains.up_bend * bend * length
            - gains.up_bend_rate * per_tempo * bend_rate * length
        ) / length
        left = (
            gains.heading * wrapped(demand.heading - estimate.heading)
            - gains.heading_rate * per_tempo * estimate.heading_rate
        ) / length
        roll = (
            (gains.roll + keel * (gains.roll_with_keel - gains.roll)) * estimate.roll
            + (gains.roll_rate + keel * (gains.roll_rate_with_keel - gains.roll_rate)) * per_tempo * estimate.roll_rate
            - gains.swirl * swirl
            - gains.swirl_rate * per_tempo * swirl_rate
        )
        return {
            "tempo": tempo,
            "amplitude": amplitude,
            "left_bend": _limited(left, bend_limit),
            "up_bend": _limited(up, bend_limit),
            "swirl": _limited(roll, gains.greatest_swirl),
        }

    def _beat(self, speed: float) -> tuple[float, float]:
        """Tempo and amplitude for a `speed` [m/s] through the water, which is proportional to the tempo."""
        settings = self._settings
        wanted = speed / settings.cruise_speed
        tempo = min(max(wanted, settings.slowest_tempo), self.torque.tempo)
        amplitude = min(1.0, wanted / settings.slowest_tempo)
        return tempo, amplitude


def _limited(value: float, most: float) -> float:
    return min(max(value, -most), most)


class TorqueLimiter:
    """The greatest tempo, between `slowest` and `fastest`, that keeps the torque below a limit."""

    def __init__(self, slowest: float, fastest: float) -> None:
        self._slowest, self._fastest = slowest, fastest
        self._time, self._said = -math.inf, False
        self.tempo = fastest

    def restart(self) -> None:
        """Begin a run."""
        self.tempo, self._time, self._said = self._fastest, -math.inf, False

    def exceeded(self, torque: float, limit: float, time: float, tempo: float) -> bool:
        """Take the `torque` [N m] at `time` [s] of a beat of this `tempo`; `limit` 0: no limit.

        Returns whether the torque exceeds the limit at the slowest tempo; True at most once in a run.
        """
        if limit <= 0.0:
            self.tempo = self._fastest
            return False
        step = min(LONGEST_STEP, max(0.0, time - self._time))
        self._time = time
        if not torque > limit:  # also for NaN
            self.tempo = min(self._fastest, self.tempo * (1.0 + RECOVERY * step))
            return False
        self.tempo = max(self._slowest, min(self.tempo, tempo * math.sqrt(limit / torque)))
        if self._said or tempo > AT_SLOWEST * self._slowest:
            return False
        self._said = True
        return True
