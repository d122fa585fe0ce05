# SPDX-License-Identifier: Apache-2.0
"""The numbers of the pilot. The defaults fit the gait straight() on the robot of the paper (docs/howto/pilot.md)."""

from dataclasses import dataclass

from eel_base.quantity import Quantities, documented, quantity

from eel_gaits.pilot.goals import Limits

CIRCLE = 0.95  # radius of a turn times the bend of the body that gives it


@documented
@dataclass(frozen=True, kw_only=True)
class PilotSettings(Quantities):
    """Numbers of the swimmer and of the pilot. The body's own length is the unit of lengths that are given in lengths.

    Fields:"""

    length: float = quantity(1.0, unit="m", description="body length", minimum=1e-3, maximum=1e3)
    cruise_speed: float = quantity(
        0.653, unit="m/s", description="speed of the gait in still water", minimum=1e-4, maximum=1e2
    )
    speed_time: float = quantity(
        2.2, unit="s", description="time in which the speed follows the gait", minimum=1e-2, maximum=1e3
    )
    metacentric_height: float = quantity(
        0.0, unit="m", description="height of the buoyancy above the weight; 0: no keel", minimum=0.0, maximum=1.0
    )
    slowest_tempo: float = quantity(
        0.3, unit="", description="least tempo of the gait; below it the beat gets smaller", minimum=0.01, maximum=1.0
    )
    fastest_tempo: float = quantity(1.5, unit="", description="greatest tempo of the gait", minimum=0.1, maximum=10.0)
    greatest_bend: float = quantity(
        1.0, unit="rad/m", description="limit of the bends in yaw and in pitch", minimum=0.0, maximum=100.0
    )
    greatest_curvature: float = quantity(
        6.0, unit="rad/m", description="limit of the curvature along the body", minimum=0.01, maximum=1e3
    )
    greatest_climb: float = quantity(
        0.3, unit="rad", description="limit of the slope of the path", minimum=0.0, maximum=1.0
    )
    look_ahead: float = quantity(
        2.5, unit="lengths", description="look-ahead of the guidance; above 2", minimum=1.0, maximum=100.0
    )
    reach: float = quantity(
        0.25, unit="lengths", description="distance at which a point counts as reached", minimum=0.01, maximum=10.0
    )
    water_time: float = quantity(
        8.0, unit="s", description="time in which the estimate of the current follows", minimum=0.1, maximum=1e4
    )
    station_gain: float = quantity(
        0.08, unit="1/s", description="velocity towards a station by its distance", minimum=0.01, maximum=10.0
    )
    patience: float = quantity(
        40.0,
        unit="s",
        description="time without progress after which a goal counts as out of reach",
        minimum=1.0,
        maximum=1e5,
    )

    @property
    def limits(self) -> Limits:
        """What a goal may ask for."""
        return Limits(
            greatest_speed=self.cruise_speed * self.fastest_tempo,
            turning_radius=CIRCLE / self.greatest_bend if self.greatest_bend else float("inf"),
            greatest_climb=self.greatest_climb,
            reach=self.reach * self.length,
        )
