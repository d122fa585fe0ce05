# SPDX-License-Identifier: Apache-2.0
"""The pilot in the loop with the mechanics, in space, without a righting moment: courses, a held course, a station."""

import math

import numpy as np
import pytest
from eel_dynamics.model.fins.text import fins_from_text
from eel_gaits.pilot.goals import Station, course, path, station
from eel_gaits.pilot.pilot import News, Pilot
from eel_gaits.pilot.regulator import Gains
from eel_gaits.pilot.settings import PilotSettings
from eel_studies.pilot.closed_loop import swim_with
from eel_studies.roll_hold.study import PAIR

from eel_dynamics import Scene

LIMITS = PilotSettings().limits


def test_way_points_are_reached():
    pilot = Pilot()
    pilot.follow(path([(5.0, 1.0, -0.4), (9.0, 4.0, 0.2), (15.0, 3.0, 0.0)], 0.5, LIMITS))
    voyage = swim_with(pilot, 90.0, until=lambda pilot: isinstance(pilot.goal, Station))
    assert len(voyage.misses) == 3 and max(voyage.misses) < 0.25, voyage.misses
    assert pilot.news == [
        News(f"way point {k + 1} of 3 reached: {miss:.3g} m from it", good=True) for k, miss in enumerate(pilot.misses)
    ]
    assert np.abs(voyage.roll).max() < 1.0


def test_a_held_course_settles_in_heading_depth_and_roll():
    """A disturbance of the roll that nobody controls grows by exp(1.45) a period."""
    pilot = Pilot()
    pilot.follow(course(-0.6, 0.3, 0.6, LIMITS))
    voyage = swim_with(pilot, 32.0, twist=(-0.2, -0.1, 0.0, 0.3, 0.0, 0.0))
    last = voyage.time > 30.0
    assert voyage.heading[last] == pytest.approx(-0.6, abs=math.radians(3.0))
    assert voyage.position[last, 2] == pytest.approx(-0.3, abs=0.05)
    assert voyage.roll[last] == pytest.approx(0.0, abs=0.02)


def test_fins_hold_the_roll_of_a_pilot_that_cannot():
    """Without the swirl by which it holds its roll the pilot rolls over; a pair of fins takes its place."""
    rolls = []
    for fins in (None, fins_from_text(PAIR)):
        pilot = Pilot(gains=Gains(greatest_swirl=0.0))
        pilot.follow(course(0.6, 0.3, 0.6, LIMITS))
        voyage = swim_with(pilot, 24.0, fins=fins, twist=(-0.2, -0.1, 0.0, 0.3, 0.0, 0.0))
        rolls.append(np.abs(voyage.roll[voyage.time > 22.0]).max())
    assert rolls[0] > 0.5 and rolls[1] < 0.02
    assert voyage.heading[-1] == pytest.approx(0.6, abs=0.02)
    assert voyage.position[-1, 2] == pytest.approx(-0.3, abs=0.05)


def test_a_station_in_a_current_of_half_the_swimmers_speed_is_kept():
    pilot = Pilot()
    pilot.follow(station((2.0, 0.5, 0.0), 0.6, LIMITS))
    voyage = swim_with(pilot, 60.0, scene=Scene(internal_wrench=False, ledger=False, current=(-0.3, -0.12, 0.0)))
    assert np.array_equal(voyage.last, voyage.time >= voyage.time[-1] - 30.0)
    last = voyage.time > 57.0
    assert np.linalg.norm(voyage.position[last] - (2.0, 0.5, 0.0), axis=1).max() < 0.5
