# SPDX-License-Identifier: Apache-2.0
"""Random tasks for a pilot, and how well it does them: courses and stations; in water that moves a station in a shear,
a course across a street, a depth below waves."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from eel_gaits.pilot.goals import Path, Station, course, path, station
from eel_gaits.pilot.pilot import Pilot
from eel_gaits.pilot.settings import PilotSettings
from eel_studies.pilot.closed_loop import Voyage, swim_with

from eel_dynamics import Scene, Shear, VortexStreet, Wave

POINTS = 5  # way points of a course
LEG, TURN, SLOPE, SPEED = (4.0, 8.0), 1.6, 0.2, (0.3, 0.8)  # m, rad, rad, m/s: ranges of a course
STRAIGHT = 90.0  # s, swim of a held course, of which the last part counts
STATION = 120.0  # s, swim to a station and stay there
SHARE_OF_SPEED = 0.5  # of the current at a station, of the swimmer's cruising speed
AGAINST, SHEAR, WIDTH = 0.5, 0.3, 2.0  # current and its change by cruising speed and current; m, scale of the change
CROSSING, BEFORE, AFTER = 60.0, 7.0, 10.0  # s, of a course across a street; its parts before it and beyond
CIRCULATION, CORE, SPACING = (0.05, 0.2), 0.4, 2.0  # m^2/s, m, m: of the vortices
AMPLITUDE, LENGTH, SURFACE = (0.02, 0.1), (3.0, 8.0), (1.5, 2.5)  # m, of the waves; height above the start
HEIGHT = 0.3  # m, below the start, that is held below waves


@dataclass(frozen=True)
class Figures:
    """What a pilot reached on one random course, one held course and one station. Distances in body lengths."""

    misses: tuple[float, ...]  # to each way point; inf where it was not passed
    course_roll: float  # rad, greatest on the course
    depth: float  # m, greatest error while a course is held
    heading: float  # rad, likewise, mean over a period
    straight_roll: float  # rad, likewise
    station: float  # greatest distance from the station
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
    how: dict[str, Any] = {"scene": motion_alone(**scene), "fins": fins}
    return pilot, swim_with(pilot, longest, until=lambda pilot: isinstance(pilot.goal, Station), **how)


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
    speed, towards = SHARE_OF_SPEED * settings.cruise_speed, rng.uniform(-math.pi, math.pi)
    current = (speed * math.cos(towards), speed * math.sin(towards), 0.0)
    pilot, spot = pilot_to_station(rng, **scene)
    stayed = swim_with(pilot, STATION, scene=motion_alone(current=current, **scene), fins=fins)
    return Figures(
        misses=tuple(misses),
        course_roll=float(np.max(np.abs(swum.roll))),
        depth=held.depth_error,
        heading=float(held.heading_error[held.last].max()),
        straight_roll=float(np.abs(held.roll[held.last]).max()),
        station=stayed.distance_from(spot) / settings.length,
        news=(*(line for line in swum.news if "cannot" in line), *held.news, *stayed.news),
    )


def pilot_for(**scene: Any) -> Pilot:
    """A pilot that knows the keel of a scene with these fields."""
    return Pilot(PilotSettings(metacentric_height=scene.get("metacentric_height", 0.0)))


def pilot_to_station(rng: np.random.Generator, **scene: Any) -> tuple[Pilot, np.ndarray]:
    """A pilot that goes to a random spot, and the spot (3,) [m]."""
    spot = np.array((rng.uniform(2.0, 5.0), rng.uniform(-2.0, 2.0), rng.uniform(-0.5, 0.5)))
    pilot = pilot_for(**scene)
    pilot.follow(station(spot, rng.uniform(*SPEED), pilot.settings.limits))
    return pilot, spot


def motion_alone(**scene: Any) -> Scene:
    """A scene of these fields without internal wrench and ledger."""
    return Scene(**{"internal_wrench": False, "ledger": False, **scene})


class WaterFigures(NamedTuple):
    """What a pilot reached. Lengths in m, angles in rad."""

    station: float  # greatest distance from the station in the last part
    heading: float  # greatest error while it crosses, mean over a period
    after: float  # the same in its last part, beyond the street
    depth: float  # greatest error of the depth in the last part, mean over a period
    orbit: float  # radius on which the waves move the water there


def figures_in(seed: int) -> WaterFigures:
    """The figures of the tasks that the `seed` draws."""
    rng, settings = np.random.default_rng(seed), PilotSettings()
    speed = AGAINST * settings.cruise_speed
    pilot, spot = pilot_to_station(rng)
    layer = Shear(velocity=(SHEAR * speed, 0.0, 0.0), centre=tuple(spot), width=WIDTH)
    stayed = swim_with(pilot, STATION, scene=motion_alone(current=(-speed, 0.0, 0.0)), flow=layer)
    street = VortexStreet(
        circulation=rng.uniform(*CIRCULATION) * rng.choice((-1.0, 1.0)),
        core=CORE,
        spacing=SPACING,
        width=0.28 * SPACING,
        count=40,
        start=(rng.uniform(6.0, 10.0), -40.0, 0.0),
        downstream=(0.0, 1.0),
    )
    pilot = pilot_for()
    pilot.follow(course(0.0, 0.0, rng.uniform(*SPEED), settings.limits))
    crossed = swim_with(pilot, CROSSING, flow=street)
    wave = Wave(
        amplitude=rng.uniform(*AMPLITUDE),
        wavelength=rng.uniform(*LENGTH),
        surface=rng.uniform(*SURFACE),
        direction=tuple(rng.normal(size=2)),
        phase=rng.uniform(0.0, 6.0),
    )
    pilot = pilot_for()
    pilot.follow(course(0.0, HEIGHT, rng.uniform(*SPEED), settings.limits))
    held = swim_with(pilot, STRAIGHT, flow=wave)
    return WaterFigures(
        station=stayed.distance_from(spot),
        heading=float(crossed.heading_error[crossed.time > BEFORE].max()),
        after=float(crossed.heading_error[crossed.time > CROSSING - AFTER].max()),
        depth=held.depth_error,
        orbit=wave.amplitude * math.exp(-2.0 * math.pi / wave.wavelength * (wave.surface + HEIGHT)),
    )
