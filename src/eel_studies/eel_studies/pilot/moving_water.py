# SPDX-License-Identifier: Apache-2.0
"""Random tasks for a pilot in water that moves: a station in a shear, a course across a street, a depth below waves."""

import math
from typing import NamedTuple

import numpy as np
from eel_gaits.pilot.goals import course, station
from eel_gaits.pilot.settings import PilotSettings
from eel_model.flow.sources import Shear, VortexStreet, Wave

from eel_studies.pilot.closed_loop import swim_with
from eel_studies.pilot.courses import LAST_PART, SPEED, STATION, STRAIGHT, motion_alone, pilot_for

AGAINST, SHEAR, WIDTH = 0.5, 0.3, 2.0  # current and its change by cruising speed and current; m, scale of the change
CROSSING, BEFORE, AFTER = 60.0, 7.0, 10.0  # s, of a course across a street; its parts before it and beyond
CIRCULATION, CORE, SPACING = (0.05, 0.2), 0.4, 2.0  # m^2/s, m, m: of the vortices
AMPLITUDE, LENGTH, SURFACE = (0.02, 0.1), (3.0, 8.0), (1.5, 2.5)  # m, of the waves; height above the start
HEIGHT = 0.3  # m, below the start, that is held below waves


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
    spot = np.array((rng.uniform(2.0, 5.0), rng.uniform(-2.0, 2.0), rng.uniform(-0.5, 0.5)))
    layer = Shear(velocity=(SHEAR * speed, 0.0, 0.0), centre=tuple(spot), width=WIDTH)
    pilot = pilot_for()
    pilot.follow(station(spot, rng.uniform(*SPEED), settings.limits))
    stayed = swim_with(pilot, STATION, scene=motion_alone(current=(-speed, 0.0, 0.0)), flow=layer)
    at_end = stayed.time >= stayed.time[-1] - LAST_PART
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
    off = np.abs(np.remainder(crossed.heading - crossed.wanted_heading + math.pi, 2.0 * math.pi) - math.pi)
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
    last = held.time >= held.time[-1] - LAST_PART
    return WaterFigures(
        station=float(np.max(np.linalg.norm(stayed.position[at_end] - spot, axis=1))),
        heading=float(np.max(off[crossed.time > BEFORE])),
        after=float(np.max(off[crossed.time > CROSSING - AFTER])),
        depth=float(np.max(np.abs(held.position[last, 2] - held.wanted_height[last]))),
        orbit=wave.amplitude * math.exp(-2.0 * math.pi / wave.wavelength * (wave.surface + HEIGHT)),
    )
