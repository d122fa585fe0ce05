# SPDX-License-Identifier: Apache-2.0
"""The numbers of the pilot. The defaults fit the gait straight() on the robot of the paper (docs/howto/pilot.md).

`GROUPS` are the parameters of the node: the goal, which may change, the timing, and the numbers of the pilot.
"""

import math
from dataclasses import dataclass

from eel_common.quantity import Quantities, documented, quantity

from eel_gaits.pilot.goals import Limits

CIRCLE = 0.95  # radius of a turn times the body's bend


@documented
@dataclass(frozen=True, kw_only=True)
class PilotSettings(Quantities):
    """Numbers of the swimmer and of the pilot. The unit "lengths" means body lengths."""

    length: float = quantity(1.0, "m", "body length", 1e-3, 1e3)
    cruise_speed: float = quantity(0.653, "m/s", "speed of the gait in still water", 1e-4, 1e2)
    speed_time: float = quantity(2.2, "s", "time in which the speed follows the gait", 1e-2, 1e3)
    metacentric_height: float = quantity(0.0, "m", "height of the buoyancy above the weight; 0: no keel", 0.0, 1.0)
    slowest_tempo: float = quantity(0.3, "", "least tempo of the gait; below it the beat gets smaller", 0.01, 1.0)
    fastest_tempo: float = quantity(1.5, "", "greatest tempo of the gait", 0.1, 10.0)
    greatest_bend: float = quantity(1.0, "rad/m", "limit of the bends in yaw and in pitch", 0.0, 100.0)
    greatest_curvature: float = quantity(6.0, "rad/m", "limit of the curvature along the body", 0.01, 1e3)
    greatest_climb: float = quantity(0.3, "rad", "limit of the slope of the path", 0.0, 1.0)
    look_ahead: float = quantity(2.5, "lengths", "look-ahead of the guidance; above 2", 1.0, 100.0)
    reach: float = quantity(0.25, "lengths", "distance at which a point counts as reached", 0.01, 10.0)
    water_time: float = quantity(8.0, "s", "time in which the estimate of the current follows", 0.1, 1e4)
    station_gain: float = quantity(0.08, "1/s", "velocity towards a station by its distance", 0.01, 10.0)
    patience: float = quantity(40.0, "s", "time without progress after which a goal counts as out of reach", 1.0, 1e5)

    @property
    def limits(self) -> Limits:
        """The limits of a goal."""
        return Limits(
            greatest_speed=self.cruise_speed * self.fastest_tempo,
            turning_radius=CIRCLE / self.greatest_bend if self.greatest_bend else float("inf"),
            greatest_climb=self.greatest_climb,
            reach=self.reach * self.length,
        )

    @property
    def ahead(self) -> float:
        """The look-ahead [m]."""
        return self.look_ahead * self.length


@dataclass(frozen=True, kw_only=True)
class GoalParameters(Quantities):
    """Parameters that may change while the node runs."""

    heading: float = quantity(0.0, "rad", "heading to hold; positive: left", -1e3, 1e3, changeable=True)
    depth: float = quantity(0.0, "m", "depth to hold, below z = 0", -1e5, 1e5, changeable=True)
    speed: float = quantity(0.5, "m/s", "speed over ground, of every goal", 1e-3, 1e2, changeable=True)
    torque_limit: float = quantity(
        0.0,
        "N m",
        "internal torque above which the pilot slows down, from swim_state; 0: none",
        0.0,
        math.inf,
        changeable=True,
    )


@dataclass(frozen=True, kw_only=True)
class TimingParameters(Quantities):
    """The times of the samples that the pilot sends."""

    sample_period: float = quantity(0.02, "s", "time from one sample of the curvature to the next", 1e-3, 0.2)
    lead: float = quantity(
        0.05, "s", "time by which samples are sent ahead of odom; at least a sample_period", 1e-3, 1.0
    )


GROUPS = (GoalParameters, TimingParameters, PilotSettings)
