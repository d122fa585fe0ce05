# SPDX-License-Identifier: Apache-2.0
"""Guidance: from a goal and the estimate to the velocity over ground and the climb that lead to it.

On a path this is line-of-sight guidance: the swimmer aims at the point of the leg that lies a look-ahead D ahead of it,

    course = bearing of the leg - atan(e / D),   climb = slope of the leg + atan(h / D)

with e the distance to the left of the leg and h the height of the leg above the swimmer. Within D of the end of the leg
it aims at that end. D above two body lengths keeps the loop stable: a rule of thumb of Kelasidi and others, IEEE
Robotics and Automation Magazine, March 2016. Integral action against a current is due to Kelasidi, Liljeback, Pettersen
and Gravdahl, Integral Line-of-Sight Guidance for Path Following Control of Underwater Snake Robots, IEEE Trans.
Robotics. Here the estimate of the water's velocity, subtracted from the demanded velocity over ground, has that role.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from eel_common.head_motion import wrapped

from eel_gaits.pilot.estimate import Estimate
from eel_gaits.pilot.goals import Course, Path, Station
from eel_gaits.pilot.settings import PilotSettings

STANDOFF = 2.2  # turning radii: the swimmer first swims away from a nearer point behind it
BEHIND = 1.2  # rad to either side of ahead
CLOSE = 0.5  # reaches: closer to a way point, the swimmer aims at the next one


class Demand(NamedTuple):
    """The output of guidance."""

    heading: float  # rad
    speed: float  # m/s, through the water
    climb: float  # rad
    height: float  # m, present demand, z up
    possible: bool  # whether the swimmer makes way against the water


class CourseGuidance:
    """Holds heading and depth. A guidance has a `goal`, whose speed may change, and the `settings`."""

    def __init__(self, goal: Course, settings: PilotSettings, start: np.ndarray) -> None:
        self.goal, self._settings = goal, settings

    def demand(self, estimate: Estimate, greatest_speed: float) -> Demand:
        """The present demand. greatest_speed: [m/s], through the water."""
        goal, water = self.goal, estimate.water
        along = water[0] * math.cos(goal.heading) + water[1] * math.sin(goal.heading)
        speed = goal.speed - float(along)
        climb = math.atan((-goal.depth - estimate.position[2]) / self._settings.ahead)
        return Demand(goal.heading, min(max(speed, 0.0), greatest_speed), climb, -goal.depth, speed <= greatest_speed)


class PathGuidance:
    """Follows the legs from `start` (3,) through the points of a path.

    Attributes:
        target: index of the next point; the number of points when all are passed.
        last_miss: [m], least distance of the head from the last point passed.
    """

    def __init__(self, goal: Path, settings: PilotSettings, start: np.ndarray) -> None:
        self.goal, self._settings = goal, settings
        self._points, self._close = np.vstack((start, goal.points)), CLOSE * settings.limits.reach
        self.target, self.last_miss, self._least = 0, math.inf, math.inf

    @property
    def done(self) -> bool:
        """Whether all points have been passed."""
        return self.target == len(self._points) - 1

    def pass_points(self, estimate: Estimate, head: np.ndarray) -> bool:
        """Aim at the next point if this one is passed, or is closer to the `head` (3,) than `close`. Returns whether.

        A point is passed when the swimmer crosses the plane through it that is normal to the leg.
        """
        point = self._points[self.target + 1]
        self._least = min(self._least, float(np.linalg.norm(head - point)))
        leg = point - self._points[self.target]
        if self._least > self._close and float((point - estimate.position) @ leg) > 0.0:
            return False
        self.last_miss = self._least
        self.target, self._least = self.target + 1, math.inf
        return True

    def demand(self, estimate: Estimate, greatest_speed: float) -> Demand:
        """The present demand, on the leg to the target. greatest_speed: [m/s], through the water."""
        begin, end = self._points[self.target : self.target + 2]
        leg, away = end - begin, estimate.position - begin
        length = math.hypot(leg[0], leg[1])
        if length == 0.0:  # the point lies straight above or below the start: swim on, and climb or dive
            climb, height = math.atan((end[2] - estimate.position[2]) / self._settings.ahead), float(end[2])
            heading, speed, possible = against_water(estimate.heading, self.goal.speed, estimate.water, greatest_speed)
            return Demand(heading, speed, climb, height, possible)
        along = float(away[:2] @ leg[:2]) / length
        left = float(leg[0] * away[1] - leg[1] * away[0]) / length
        ahead = max(min(self._settings.ahead, length - along), self._close)
        course = math.atan2(leg[1], leg[0]) - math.atan2(left, ahead)
        height = float(begin[2] + min(1.0, max(0.0, along / length)) * leg[2])
        climb = math.atan2(leg[2], length) + math.atan((height - estimate.position[2]) / ahead)
        heading, speed, possible = against_water(course, self.goal.speed, estimate.water, greatest_speed)
        return Demand(heading, speed, climb, height, possible)


class StationGuidance:
    """Swims to a point and stays there. In still water it stops within `reach` of it."""

    def __init__(self, goal: Station, settings: PilotSettings, start: np.ndarray) -> None:
        self.goal, self._settings, self._limits, self._resting = goal, settings, settings.limits, False

    def demand(self, estimate: Estimate, greatest_speed: float) -> Demand:
        """The present demand. greatest_speed: [m/s], through the water."""
        away, gain, rest = self.goal.point - estimate.position, self._settings.station_gain, self._limits.reach
        distance, height = math.hypot(away[0], away[1]), float(self.goal.point[2])
        climb = math.atan(away[2] / self._settings.ahead)
        still = math.hypot(*estimate.water) < gain * rest
        self._resting = still and distance < (2.0 if self._resting else 1.0) * rest
        if self._resting:
            return Demand(estimate.heading, 0.0, climb, height, True)
        speed, bearing = min(self.goal.speed, gain * distance), math.atan2(away[1], away[0])
        heading, through, possible = against_water(bearing, speed, estimate.water, greatest_speed)
        if distance < STANDOFF * self._limits.turning_radius and abs(wrapped(heading - estimate.heading)) > BEHIND:
            return Demand(estimate.heading, through, climb, height, possible)  # there is no room to turn round
        return Demand(heading, through, climb, height, possible)


GUIDANCE: dict[type, Any] = {Course: CourseGuidance, Path: PathGuidance, Station: StationGuidance}


def against_water(course: float, speed: float, water: np.ndarray, greatest: float) -> tuple[float, float, bool]:
    """Heading [rad] and speed through the water [m/s] that give the `course` [rad] and the `speed` [m/s] over ground.

    water (2,) [m/s]. If that needs more than the `greatest` speed, the speed over ground is less, or the course is not
    kept. Also returns whether the swimmer makes way on its course.
    """
    along = float(water[0] * math.cos(course) + water[1] * math.sin(course))
    across = float(water[1] * math.cos(course) - water[0] * math.sin(course))
    if abs(across) >= greatest:
        return course - math.copysign(0.5 * math.pi, across), greatest, False
    most = math.sqrt(greatest**2 - across**2)
    ahead = min(speed - along, most)
    return course + math.atan2(-across, ahead), math.hypot(ahead, across), along + ahead > 0.0
