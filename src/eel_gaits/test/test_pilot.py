# SPDX-License-Identifier: Apache-2.0
"""The parts of the pilot: means over a period, the plane of the beat, guidance, goals, limits; without a simulation."""

import math

import numpy as np
import pytest
from eel_common.attitude import attitude
from eel_common.head_motion import HeadMotion
from eel_gaits.laws.steered_law import NUMBERS, SteeredLaw
from eel_gaits.pilot import goals
from eel_gaits.pilot.estimate import PeriodMeans, plane_of
from eel_gaits.pilot.guidance import PathGuidance, against_water
from eel_gaits.pilot.pilot import Pilot, Progress
from eel_gaits.pilot.regulator import RECOVERY, TorqueLimiter
from eel_gaits.pilot.settings import PilotSettings
from hypothesis import given, settings
from hypothesis import strategies as st

from eel_gaits import straight

ANGLES = st.floats(-3.0, 3.0)
STEP = 0.02  # s
LIMITS = PilotSettings().limits


def product(one, other):
    """The product of two quaternions x y z w: first `other`, then `one`."""
    a, b = np.asarray(one), np.asarray(other)
    vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.array([*vector, a[3] * b[3] - a[:3] @ b[:3]])


def about(axis, angle):
    return np.array([*(math.sin(0.5 * angle) * np.eye(3)[axis]), math.cos(0.5 * angle)])


@given(ANGLES, st.floats(-1.5, 1.5), ANGLES, st.floats(0.1, 10.0))
def test_heading_climb_and_roll_are_those_of_the_turns_whatever_the_norm(heading, climb, roll, norm):
    turns = product(about(2, heading), product(about(1, -climb), about(0, roll)))
    assert attitude(norm * turns) == pytest.approx((heading, climb, roll), abs=1e-12)


@settings(max_examples=10, deadline=None)
@given(st.floats(0.3, 2.0), st.floats(-0.5, 0.5), ANGLES)
def test_means_over_a_period_leave_out_the_swing_at_any_tempo(tempo, turning, phase):
    means = PeriodMeans(1, 1.0)
    for k in range(round(1.5 / tempo / 0.005)):
        t = 0.005 * k
        found = means.add(t, tempo * t, [turning * t + 0.16 * math.sin(2.0 * math.pi * tempo * t + phase)])
    assert found.whole
    assert found.rate[0] == pytest.approx(turning, abs=1e-3)
    assert found.mean[0] + 0.5 * found.span * found.rate[0] == pytest.approx(turning * t, abs=1e-3)


@settings(max_examples=30)
@given(ANGLES, st.floats(-0.3, 0.3), st.floats(-0.6, 0.6), st.floats(-0.6, 0.6))
def test_the_plane_of_the_beat_does_not_swing_with_the_head(heading, swing, roll, climb):
    """A head that swings about the up axis of a plane that is tilted as a whole."""
    tilted = product(about(2, heading), product(about(1, -climb), about(0, roll)))
    still = np.zeros(3)
    head = HeadMotion(still, product(tilted, about(2, swing)), still, still)
    plane = plane_of(head, heading)
    assert plane["climb"] == pytest.approx(math.asin(math.sin(climb) * math.cos(roll)), abs=1e-12)
    upright = math.cos(roll) * math.cos(climb)
    assert plane["roll"] == pytest.approx(math.atan2(math.sin(roll), upright), abs=1e-12)


@given(ANGLES, st.floats(0.05, 0.6), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_heading_and_speed_make_up_for_the_water(course, speed, x, y):
    water = np.array((x, y))
    heading, through, possible = against_water(course, speed, water, 1.2)
    over_ground = through * np.array((math.cos(heading), math.sin(heading))) + water
    assert possible and over_ground == pytest.approx(speed * np.array((math.cos(course), math.sin(course))), abs=1e-12)


def test_water_that_is_too_fast_is_reported():
    assert not against_water(0.0, 0.3, np.array((-0.7, 0.0)), 0.6)[2]
    heading, through, possible = against_water(0.0, 0.3, np.array((0.0, 0.7)), 0.6)
    assert (heading, through, possible) == (pytest.approx(-0.5 * math.pi), 0.6, False)


def test_numbers_of_a_steered_law_change_without_a_jump():
    """Between two samples, the quintic that meets value, rate and acceleration at both is the curvature itself: so it
    is, where the rates are the derivatives of the values."""
    law, targets = SteeredLaw(straight(), response=0.2), dict.fromkeys(NUMBERS, 0.7)
    law.begin(0.3, amplitude=0.2)
    step = 1e-4
    rows = [law.advance(targets, step, 0.3).reshape(2, 3, -1) for _ in range(3)]
    for order in (0, 1):
        slope = (rows[2][:, order] - rows[0][:, order]) / (2.0 * step)
        assert slope == pytest.approx(rows[1][:, order + 1], abs=1e-5 * np.abs(slope).max())


@pytest.mark.parametrize("count", [1, 2, 3])
def test_many_steered_swimmers_begin_with_the_numbers_that_one_does(count):
    law, numbers = SteeredLaw(straight()), {"amplitude": 0.7, "left_bend": 0.2}
    alone = law.begin(0.3, **numbers)
    assert np.array_equal(law.begin(np.full(count, 0.3), **numbers), np.broadcast_to(alone, (count, *alone.shape)))


def test_guidance_aims_at_the_leg_and_goes_from_point_to_point():
    goal = goals.path([(6.0, 0.0, 0.0), (6.0, 8.0, 1.0)], 0.5, LIMITS)
    pilot = Pilot()
    guidance, still = PathGuidance(goal, PilotSettings(), np.zeros(3)), np.zeros(3)

    def demand(*position):
        head = HeadMotion(np.array(position), np.array((0.0, 0.0, 0.0, 1.0)), still, still)
        estimate = pilot._estimator.add(0.0, head, 0.0, 0.0)
        pilot._estimator.restart()
        passed = guidance.pass_points(estimate, head.position)
        return passed, None if guidance.done else guidance.demand(estimate, 0.9)

    assert demand(1.0, 1.0, 0.0)[1].heading == pytest.approx(-math.atan2(1.0, 2.5))
    assert demand(5.0, 0.5, 0.0)[1].heading == pytest.approx(-math.atan2(0.5, 1.0))  # at the point itself
    passed, second = demand(6.1, 0.2, 0.0)
    assert passed and guidance.last_miss == pytest.approx(math.hypot(0.1, 0.2))
    assert second.heading == pytest.approx(0.5 * math.pi + math.atan2(0.1, 2.5))
    assert second.climb > math.atan(1.0 / 8.0)  # it is below the leg
    assert demand(6.0, 7.95, 1.0) == (True, None) and guidance.done


def test_a_way_point_straight_below_is_dived_to_on_the_present_heading():
    pilot, still = Pilot(), np.zeros(3)
    pilot.begin()
    pilot.follow(pilot.checked_path(goals.path([(0.0, 0.0, -1.0)], 0.5, LIMITS)))
    pilot.step(0.0, HeadMotion(still, about(2, 0.4), still, still), STEP)
    assert pilot.demand.heading == pytest.approx(0.4) and pilot.demand.possible
    assert pilot.demand.height == -1.0 and pilot.demand.climb < -0.3


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: goals.course(math.nan, 0.0, 0.5, LIMITS), "heading must be finite, got nan"),
        (lambda: goals.course(0.0, math.inf, 0.5, LIMITS), "depth must be finite, got inf"),
        (lambda: goals.course(0.0, 0.0, 3.0, LIMITS), "speed must be <= 0.9795 m/s, got 3"),
        (lambda: goals.path([], 0.5, LIMITS), "path must have one point or more, got none"),
        (lambda: goals.path([(0, 0, math.nan)], 0.5, LIMITS), "path point 1 must be finite"),
        (lambda: goals.path([(5, 0, 0), (5, 0.1, 0)], 0.5, LIMITS), "path point 2 must lie more than 0.25 m ahead"),
        (lambda: goals.path([(5, 0, 0), (9, 0, 4)], 0.5, LIMITS), "path to point 2 must climb or dive by at most 17.2"),
        (lambda: goals.path([(3, 0, 0), (6, 0, 0), (6, 1, 0)], 0.5, LIMITS), "path point 3 must lie outside the turn"),
        (lambda: goals.station((0, 1e9, 0), 0.5, LIMITS), "station point 1 must be finite and at most 100000 m"),
    ],
)
def test_goals_that_nobody_can_reach_are_refused(make, said):
    with pytest.raises(ValueError) as caught:
        make()
    assert str(caught.value).startswith(said)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(3.0, 8.0))
def test_no_motion_of_the_head_makes_the_pilot_exceed_the_limit_of_curvature(seed, limit):
    draw = np.random.default_rng(seed)
    pilot = Pilot(PilotSettings(greatest_curvature=limit))
    pilot.follow(goals.course(2.0, 3.0, 0.6, LIMITS))
    pilot.begin()
    for k in range(60):
        q = draw.normal(size=4)
        head = HeadMotion(draw.normal(size=3), q / np.linalg.norm(q), *draw.normal(size=(2, 3)))
        rows = pilot.step(STEP * k, head, STEP)
        assert np.isfinite(rows).all()
        assert np.abs(rows[3]).max() <= limit * (1.0 + 1e-9)


def test_a_goal_that_comes_no_nearer_is_reported_once():
    progress = Progress(10.0)
    progress.restart(0.0)
    said = [progress.stalled(0.1 * k, max(5.0, 8.0 - 0.1 * k), 1.0) for k in range(400)]
    assert sum(said) == 1 and 0.1 * said.index(True) == pytest.approx(13.0, abs=0.3)
    progress.restart(40.0)
    assert not any(progress.stalled(40.0 + 0.1 * k, 0.5, 1.0) for k in range(400))


def test_water_that_carries_the_swimmer_off_is_reported():
    pilot, still = Pilot(PilotSettings(patience=12.0)), np.zeros(3)
    pilot.follow(goals.station((5.0, 0.0, 0.0), 0.5, LIMITS))
    pilot.begin()
    for k in range(200):
        head = HeadMotion(np.array((-0.2 * k, 0.0, 0.0)), np.array((0.0, 0.0, 0.0, 1.0)), still, still)
        pilot.step(0.1 * k, head, 0.1)
    (news,) = pilot.news
    assert news.text.startswith("the goal (5, 0, 0) m cannot be reached: ") and not news.good
    assert news.text.endswith("the water is faster than the swimmer may swim")


def test_the_beat_slows_down_where_the_torque_is_too_great():
    """A swimmer whose torque goes with the square of the tempo."""
    limiter, tempo, said = TorqueLimiter(0.3, 1.5), 1.5, []
    for k in range(400):
        said.append(limiter.exceeded(4.0 * tempo**2, 1.0, 0.02 * k, tempo))
        tempo += 0.1 * (limiter.tempo - tempo)
    assert tempo == pytest.approx(0.5, rel=0.05) and not any(said)
    before = limiter.tempo
    limiter.exceeded(0.0, 1.0, 7.99, tempo)  # 0.01 s later
    assert limiter.tempo == pytest.approx(before * (1.0 + 0.01 * RECOVERY), rel=1e-9)
    said = [limiter.exceeded(9.0, 1.0, 8.0 + 0.02 * k, 0.3) for k in range(50)]
    assert limiter.tempo == 0.3 and sum(said) == 1
    assert not limiter.exceeded(math.nan, 1.0, 9.1, 0.3)
    limiter.exceeded(9.0, 0.0, 9.2, 0.3)
    assert limiter.tempo == 1.5
