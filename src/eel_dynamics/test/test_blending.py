# SPDX-License-Identifier: Apache-2.0
"""Changes of what drives the body: curvature, its rate and its acceleration never jump, and the head follows."""

import numpy as np
import pytest
from cases import SPLINE_KNOTS, random_law
from library_state import Scene, Simulation, distance, simulate

from eel_gaits import Law, falling, still, straight, turning

STEP = 1e-3
X = np.array([0.0, 0.1, 0.35, 0.6, 1.0])


def law_of(seed, **changes):
    law = random_law(np.random.default_rng(seed), size=0.5)
    return Law(*law.terms, name=str(seed), **changes)


def record(simulation, until):
    """Time (T,), curvature and rate (T, M, 3) at steps of STEP from the present on."""
    out = []
    for k in range(1, round((until - simulation.time) / STEP) + 1):
        simulation.advance(simulation.time + STEP)
        got = simulation.observe(wrench=False, load=False)
        out.append((got.time, got.curvature.copy(), got.curvature_rate.copy()))
        assert k < 10_000
    return tuple(np.array(column) for column in zip(*out, strict=True))


def check_smooth(time, curvature, rate):
    """The rate is the slope of the curvature, and its own slope has no jump.

    Central differences at 1 ms of motions of some 20 rad/s: errors of (0.02)^2 / 6 of the rate. A jump of the value
    by 1 % would be a rate 10 times too large; jumps of rate and acceleration show in the differences of the rate.
    """
    slope = (curvature[2:] - curvature[:-2]) / (time[2:] - time[:-2])[:, None, None]
    scale = np.abs(rate).max()
    assert distance(slope, rate[1:-1], scale) < 1e-3
    acceleration = np.diff(rate, axis=0) / STEP
    jumps = np.abs(np.diff(acceleration, axis=0)).max()
    assert jumps < 0.03 * np.abs(acceleration).max()


def test_a_law_adopted_in_mid_swim_and_another_in_mid_blend():
    simulation = Simulation(stations=X)
    simulation.adopt(law_of(1))
    before = record(simulation, 0.5)
    simulation.adopt(law_of(2), origin=0.2, transition=0.6)
    blend = record(simulation, 0.8)
    simulation.adopt(law_of(3, transition=0.4), origin=-0.3)  # half-way through the first blend
    after = record(simulation, 1.5)
    check_smooth(*(np.concatenate(columns) for columns in zip(before, blend, after, strict=True)))
    # the first follows its law from the start; the last is on its own law, at its own time, after its transition
    for (time, curvature, rate), law, origin in ((before, law_of(1), 0.0), (after, law_of(3), -0.3)):
        value, slope, _ = law.curvature(time[-1] - origin, X)
        assert curvature[-1] == pytest.approx(value, abs=1e-12)
        assert rate[-1] == pytest.approx(slope, abs=1e-11)
    value, slope, _ = law_of(2).curvature(0.8 - 0.2, X)
    assert not np.allclose(blend[1][-1], value, atol=1e-3)  # the second never came to its own


def test_the_first_law_needs_no_blend_and_the_last_adopted_counts():
    simulation = Simulation(stations=X)
    simulation.adopt(law_of(1))
    simulation.adopt(law_of(2), transition=0.5)
    got = simulation.observe()
    assert got.curvature == pytest.approx(law_of(2).curvature(0.0, X)[0], abs=1e-13)
    assert got.curvature_rate == pytest.approx(law_of(2).curvature(0.0, X)[1], abs=1e-12)


def test_the_default_transition_holds_where_none_is_given():
    simulation = Simulation(stations=X, default_transition=0.3)
    simulation.adopt(law_of(1))
    simulation.advance(0.2)
    simulation.adopt(law_of(2))
    simulation.advance(0.49)
    assert distance(simulation.observe().curvature, law_of(2).curvature(0.49, X)[0]) > 1e-9
    simulation.advance(0.51)
    assert simulation.observe().curvature == pytest.approx(law_of(2).curvature(0.51, X)[0], abs=1e-12)


def test_adopting_the_same_law_again_changes_nothing():
    law = law_of(4)
    plain = simulate(law, duration=1.0, sample_period=0.5, accuracy="fine")
    simulation = Simulation(accuracy="fine")
    simulation.adopt(law)
    simulation.advance(0.37)
    simulation.adopt(law)
    simulation.advance(1.0)
    assert simulation.observe().position == pytest.approx(plain.position[-1], abs=1e-6)


def samples_of(law, time, x):
    """The arguments of `add_samples`: x, then value, rate and acceleration in pitch and in yaw."""
    fields = law.curvature(time, x)
    return (time, x, *(field[:, axis] for axis in (1, 2) for field in fields))


def test_samples_of_a_law_swim_like_the_law():
    """A controller that sends a law's values every 20 ms on 41 points: quintics in time, splines in X."""
    law = Law(*law_of(5).terms)
    x = np.union1d(np.linspace(0, 1, 41), SPLINE_KNOTS)
    exact = simulate(law, duration=1.0, sample_period=0.5, accuracy="fine", stations=X)
    simulation = Simulation(accuracy="fine", stations=X)
    simulation.adopt(law)
    for time in np.arange(1, 53) * 0.02:
        simulation.add_samples(*samples_of(law, time, x))
    simulation.advance(1.0)
    got = simulation.observe()
    assert got.curvature == pytest.approx(exact.curvature[-1], abs=2e-3)  # natural ends of the splines in X
    assert got.position == pytest.approx(exact.position[-1], abs=2e-3)


def test_samples_whose_waves_are_given_swim_alike_on_a_grid_for_these():
    """21 points could carry 4 waves; the law has one. The next pair of samples does not begin the steps anew."""
    law, x, found = law_of(5), np.linspace(0.0, 1.0, 21), []
    for waves in (None, 1.0):
        simulation = Simulation(scene=Scene(internal_wrench=False, ledger=False), stations=2)
        for time in np.arange(101) * 0.02:
            simulation.add_samples(*samples_of(law, time, x), waves=waves)
        simulation.advance(2.0)
        found.append((simulation, simulation.head.position))
    (many, far), (few, near) = found
    assert len(few.grid.x) < 0.5 * len(many.grid.x)
    assert np.linalg.norm(near - far) < 1e-4 * np.linalg.norm(far)  # of the preset standard
    assert few.evaluations[2] < 8 * 100  # a start anew with each pair would take twice as many
    for bad in (0.0, -1.0, np.nan, 1e4, "many"):
        with pytest.raises(ValueError, match="curvature samples waves must be > 0 and at most 200, got"):
            few.add_samples(*samples_of(law, 3.0, x), waves=bad)


def test_samples_take_over_smoothly_and_rest_follows_when_they_stop():
    law, controller = law_of(6), law_of(7)
    simulation = Simulation(stations=X, default_transition=0.4)
    simulation.adopt(law)
    first = record(simulation, 0.3)
    x = np.linspace(0, 1, 21)
    for time in np.arange(31, 91) * 0.01:
        simulation.add_samples(*samples_of(controller, time, x))
    assert simulation.samples_until == pytest.approx(0.9)
    assert not simulation.resting
    rest = record(simulation, 2.2)
    assert simulation.resting
    check_smooth(*(np.concatenate(columns) for columns in zip(first, rest, strict=True)))
    assert np.abs(rest[2][-1]).max() < 1e-9 * np.abs(rest[2]).max()  # at rest: the rate is gone
    for time in np.arange(2.3, 2.8, 0.01):  # and they return
        simulation.add_samples(*samples_of(controller, time, x))
    check_smooth(*record(simulation, 2.7))
    assert not simulation.resting


def test_samples_take_over_from_a_law_that_lies_still():
    """It stays in a plane, and its settings are for that: those of the samples are others, whatever their points."""
    simulation, x = Simulation(law=still(), stations=X), np.linspace(0, 1, 11)
    for k in range(20):
        simulation.add_samples(*samples_of(law_of(7), 0.1 + 0.05 * k, x))
    simulation.advance(0.9)
    assert simulation.sampled and np.isfinite(simulation.observe().position).all()


def test_a_law_that_ends_while_it_begins_is_swum_as_it_is_written():
    """Its envelope is the product of two sums of ramps."""
    law = straight().followed_by(turning(), at=0.6, blend=0.5).followed_by(straight(), at=0.9, blend=0.4)
    assert max(ramp.factor for term in law.terms for ramp in term.envelope) == 2
    run = simulate(law, 1.6, accuracy="draft", estimate=False, sample_period=0.05, stations=X)
    for time, curvature, rate in zip(run.time, run.curvature, run.curvature_rate, strict=True):
        expected = law.curvature(time, X)
        np.testing.assert_allclose(curvature, expected[0], rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(rate, expected[1], rtol=0.0, atol=1e-11)


def test_the_grid_goes_back_when_fine_samples_have_passed():
    """Two instants of 1001 points, then many of 11: each sample after them costs what it did before."""
    law, controller = law_of(6), law_of(7)
    simulation = Simulation(stations=X, default_transition=0.4)
    simulation.adopt(law)
    usual = len(simulation.grid.x)
    for time, points in [(0.05, 1001), (0.1, 1001), *((0.1 + 0.05 * k, 11) for k in range(1, 20))]:
        simulation.add_samples(*samples_of(controller, time, np.linspace(0, 1, points)))
    assert len(simulation.grid.x) == usual  # the fine ones lie ahead
    simulation.advance(0.07)
    assert len(simulation.grid.x) > 5 * usual
    smooth = record(simulation, 0.9)
    assert len(simulation.grid.x) <= 2.0 * usual
    check_smooth(*smooth)


def test_the_grid_goes_back_when_a_law_of_many_waves_is_over():
    simulation = Simulation(law=falling(), stations=X)
    usual = len(simulation.grid.x)
    simulation.advance(0.1)
    simulation.adopt(straight(wavelength=0.05), transition=0.1)
    simulation.advance(0.3)
    assert len(simulation.grid.x) > 3 * usual
    simulation.adopt(falling(), transition=0.1)
    simulation.advance(0.5)
    assert len(simulation.grid.x) == usual


def test_a_reset_swims_as_the_first_time_although_samples_were_finer():
    once = Simulation(law=falling(), stations=X)
    once.advance(1.0)
    simulation = Simulation(law=falling(), stations=X)
    for time in (0.1, 0.2):
        simulation.add_samples(*samples_of(law_of(7), time, np.linspace(0, 1, 201)))
    simulation.advance(0.3)
    simulation.reset()
    simulation.advance(1.0)
    np.testing.assert_allclose(simulation.observe().position, once.observe().position, rtol=0.0, atol=1e-5)


def test_samples_are_refused_where_there_are_too_many():
    simulation, law = Simulation(law=falling()), law_of(7)
    with pytest.raises(ValueError, match="x must have at most 1601 points, got 20000"):
        simulation.add_samples(1.0, *[np.zeros(20_000)] * 7)
    for bad in (None, 0.5, np.array(0.5), [[0.0, 1.0]]):
        with pytest.raises(ValueError, match=r"curvature samples x must be (a row of|real) numbers, got"):
            simulation.add_samples(1.0, bad, *[np.zeros(2)] * 6)
    few, many = samples_of(law, 0.0, np.linspace(0, 1, 5))[1:], samples_of(law, 0.0, np.linspace(0, 1, 1001))[1:]
    for k in range(10_000):
        simulation.add_samples(10.0 + 0.001 * k, *few)
    with pytest.raises(ValueError, match="at most 10000, of 1000000 points, got 10001 of 50005"):
        simulation.add_samples(30.0, *few)
    simulation.reset()
    for k in range(999):
        simulation.add_samples(10.0 + 0.001 * k, *many)
    with pytest.raises(ValueError, match="at most 10000, of 1000000 points, got 1000 of 1001000"):
        simulation.add_samples(30.0, *many)


def test_reset_swims_again_from_the_start():
    simulation = Simulation(twist=(0, 0, 0.1, 0.2, 0, 0))
    simulation.adopt(law_of(8), origin=0.0)
    simulation.advance(0.6)
    once = simulation.observe()
    position, twist, work = once.position.copy(), once.twist.copy(), once.actuator_work
    simulation.reset()
    assert simulation.time == 0.0
    start = simulation.observe()
    assert np.all(start.position == 0)
    assert start.actuator_work == 0.0
    simulation.advance(0.6)
    again = simulation.observe()
    assert np.array_equal(again.position, position)
    assert np.array_equal(again.twist, twist)
    assert again.actuator_work == work


def test_a_planar_scene_blends_too():
    rng = np.random.default_rng(9)
    simulation = Simulation(scene=Scene(planar=True), stations=X)
    simulation.adopt(random_law(rng, pitch=False))
    first = record(simulation, 0.2)
    simulation.adopt(random_law(rng, pitch=False), transition=0.3)
    check_smooth(*(np.concatenate(columns) for columns in zip(first, record(simulation, 0.7), strict=True)))
