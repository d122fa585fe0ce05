# SPDX-License-Identifier: Apache-2.0
"""Random tasks for a pilot, and how well it does them."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_gaits.pilot.goals import Path, Station, course, path, station
from eel_gaits.pilot.pilot import Pilot
from eel_gaits.pilot.settings import PilotSettings
from eel_model.scene import Scene

from eel_studies.pilot.closed_loop import Voyage, swim_with

POINTS = 5  # way points of a course
LEG, TURN, SLOPE, SPEED = (4.0, 8.0), 1.6, 0.2, (0.3, 0.8)  # m, rad, rad, m/s: ranges of a course
STRAIGHT = 90.0  # s, swim of a held course, of which the last part counts
LAST_PART = 30.0  # s
STATION = 120.0  # s, swim to a station and stay there
SHARE_OF_SPEED = 0.5  # of the current at a station, of the swimmer's cruising speed


@dataclass(frozen=True)
class Figures:
    """What a pilot reached on one random course, one held course and one station. Distances in body lengths."""

    misses: tuple[float, ...]  # to each way point; inf where it was not passed
    course_roll: float  # rad, greatest on the course
    depth: float  # m, greatest error while a course is held
    heading: float  # rad, likewise, mean over a period
    straight_roll: float  # rad, likewise
    station: float  # greatest distance from the station
    station_roll: float  # rad
    news: tuple[str, ...]  # what the pilot reported of goals that it could not reach


def random_path(rng: np.random.Generator, settings: PilotSettings) -> Path:
    """A path from the origin, first ahead to within 0.8 rad: legs, turns, slopes and speed are uniform in their ranges.
    A path that the pilot refuses is drawn again."""
    while True:
        bearing, point, points = rng.uniform(-0.8, 0.8), np.zeros(3), []
        for _ in range(POINTS):
            leg, slope = settings.length * rng.uniform(*LEG), rng.uniform(-SLOPE, SLOPE)
            point = point + leg * np.array((math.cos(bearing), math.sin(bearing), math.tan(slope)))
            points.append(point)
            bearing += rng.uniform(-TURN, TURN)
        try:
            return path(points, rng.uniform(*SPEED), settings.limits)
        except ValueError:
            continue


def swim_path(goal: Path, fins: Any = None, **scene: Any) -> tuple[Pilot, Voyage]:
    """Swim a path, in at most three times the time that its legs take; the rest as in `figures_of`."""
    pilot = pilot_for(**scene)
    pilot.follow(goal)
    legs = np.linalg.norm(np.diff(goal.points, axis=0, prepend=np.zeros((1, 3))), axis=1)
    longest = 3.0 * float(np.sum(legs)) / goal.speed + 20.0
    return pilot, swim_with(
        pilot,
        longest,
        scene=motion_alone(**scene),
        fins=fins,
        until=lambda pilot: isinstance(pilot.goal, Station),
    )


def figures_of(seed: int, fins: Any = None, **scene: Any) -> Figures:
    """The figures of the tasks that the `seed` draws. fins: as in `Simulation`; scene: fields of `Scene` for all."""
    rng = np.random.default_rng(seed)
    settings = PilotSettings()
    pilot, swum = swim_path(random_path(rng, settings), fins, **scene)
    misses = [miss / settings.length for miss in swum.misses]
    misses += [math.inf] * (POINTS - len(misses))
    pilot.follow(course(rng.uniform(-1.5, 1.5), rng.uniform(-1.0, 1.0), rng.uniform(*SPEED), settings.limits))
    pilot.news.clear()
    held = swim_with(pilot, STRAIGHT, scene=motion_alone(**scene), fins=fins)
    last = held.time >= held.time[-1] - LAST_PART
    off = np.abs(np.remainder(held.heading - held.wanted_heading + math.pi, 2.0 * math.pi) - math.pi)
    speed, towards = SHARE_OF_SPEED * settings.cruise_speed, rng.uniform(-math.pi, math.pi)
    current = (speed * math.cos(towards), speed * math.sin(towards), 0.0)
    spot = np.array((rng.uniform(2.0, 5.0), rng.uniform(-2.0, 2.0), rng.uniform(-0.5, 0.5)))
    pilot = pilot_for(**scene)
    pilot.follow(station(spot, rng.uniform(*SPEED), settings.limits))
    stayed = swim_with(pilot, STATION, scene=motion_alone(current=current, **scene), fins=fins)
    at_end = stayed.time >= stayed.time[-1] - LAST_PART
    return Figures(
        misses=tuple(misses),
        course_roll=float(np.max(np.abs(swum.roll))),
        depth=float(np.max(np.abs(held.position[last, 2] - held.wanted_height[last]))),
        heading=float(np.max(off[last])),
        straight_roll=float(np.max(np.abs(held.roll[last]))),
        station=float(np.max(np.linalg.norm(stayed.position[at_end] - spot, axis=1))) / settings.length,
        station_roll=float(np.max(np.abs(stayed.roll[at_end]))),
        news=(*(line for line in swum.news if "cannot" in line), *held.news, *stayed.news),
    )


def pilot_for(**scene: Any) -> Pilot:
    """A pilot that knows the keel of a scene with these fields."""
    return Pilot(PilotSettings(metacentric_height=scene.get("metacentric_height", 0.0)))


def motion_alone(**scene: Any) -> Scene:
    """A scene of these fields without internal wrench and ledger."""
    return Scene(**{"internal_wrench": False, "ledger": False, **scene})
