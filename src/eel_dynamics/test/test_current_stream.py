# SPDX-License-Identifier: Apache-2.0
"""A current sample by sample, and flows as texts."""

import numpy as np
import pytest
from eel_dynamics.model.flow.stream import CurrentStream
from eel_dynamics.model.flow.text import flow_from_text, text_of_flow
from scipy.integrate import quad

from eel_dynamics import Accuracy, Gust, Scene, Shear, Simulation, Uniform, Vortex, VortexStreet, Wave
from eel_gaits import straight

PERIOD = 0.1  # s


def swell(t):
    return np.array([0.2 * np.sin(t), 0.1 * np.cos(2 * t), 0.0])


def courses(times, ahead=0.0):
    """The stream's course after each sample of the swell at `times`."""
    stream = CurrentStream(1.0)
    return [stream.add(t, t + ahead, swell(t + ahead)) for t in times]


def test_velocity_and_rate_never_jump():
    rng = np.random.default_rng(0)
    times = np.cumsum(rng.uniform(0.02, 0.3, 60))  # an uneven clock
    made = courses(times)
    assert not made[0].sample([0.0, 0.0, 0.0], times[0]).velocity.any()
    for before, after, t in zip(made, made[1:], times[1:], strict=False):
        one, other = (course.sample([0.0, 0.0, 0.0], t) for course in (before, after))
        assert np.allclose(one.velocity, other.velocity, atol=1e-14) and np.allclose(one.rate, other.rate, atol=1e-13)


def test_a_sample_is_reached_one_interval_late():
    times = PERIOD * np.arange(60)
    for course, t in list(zip(courses(times), times, strict=True))[20:]:
        for after in PERIOD * np.linspace(0.0, 0.99, 7):
            assert np.allclose(course.sample([0, 0, 0], t + after).velocity, swell(t + after - PERIOD), atol=1e-3)
    for course, t in list(zip(courses(times, ahead=PERIOD), times, strict=True))[20:]:
        assert np.allclose(course.sample([0, 0, 0], t).velocity, swell(t), atol=1e-12)


def test_the_last_velocity_is_held_once_samples_stop():
    stream = CurrentStream(1.0)
    for t in PERIOD * np.arange(20):
        course = stream.add(t, t, swell(t))
    end = 19 * PERIOD
    assert np.allclose(course.sample([0, 0, 0], end + 2 * PERIOD).velocity, swell(end))
    assert np.allclose(course.sample([0, 0, 0], end + 2 * PERIOD).rate, 0.0, atol=1e-15)
    assert np.allclose(course.sample([0, 0, 0], end + 50.0).velocity, swell(end))
    assert not stream.is_silent(end + 0.2) and stream.is_silent(end + 0.4)
    assert stream.add(end + 1.0, end, swell(0.0)) is None
    stream.add(end + 20.0, end + 20.0, swell(3.0))  # after a long silence: anew, in a second
    assert stream.interval is None and not stream.is_silent(end + 22.0)


def test_a_neutral_swimmer_is_carried_by_the_displacement_of_the_current():
    """Water that accelerates alike everywhere: as in still water, plus the way of the water."""
    scene, reached = Scene(friction="laminar"), 1.5
    still, moved = (Simulation(scene=scene, accuracy=1e-6, law=straight(), measure_error=True) for _ in range(2))
    way = np.zeros(3)
    for k in range(round(reached / PERIOD)):
        moved.add_current(k * PERIOD, swell(k * PERIOD))
        course = moved.currents.course
        way += [
            quad(lambda t, i=i, c=course: c.sample([0, 0, 0], t).velocity[i], k * PERIOD, (k + 1) * PERIOD)[0]
            for i in range(3)
        ]
        still.advance((k + 1) * PERIOD)
        moved.advance((k + 1) * PERIOD)
        assert np.allclose(moved.water_at(moved.head.position), course.sample([0, 0, 0], moved.time).velocity)
    assert np.abs(way).max() > 0.05
    assert np.abs(moved.head.position - still.head.position - way).max() < 3e-7
    assert np.abs(moved.observe().force - still.observe().force).max() < 1e-5
    assert np.abs(moved.observe().energy.residual) < 1e-6
    assert moved.error_estimate.position < 1e-5
    other = moved.copy_with(Accuracy.of(1e-7))
    assert np.allclose(other.water_at([0, 0, 0]), moved.water_at([0, 0, 0]))
    moved.reset()
    assert not moved.water_at([0, 0, 0]).any() and moved.currents.course is None


def test_a_current_before_the_first_law_is_kept():
    simulation = Simulation(flow=Gust(velocity=(0.0, 0.1, 0.0)), scene=Scene(current=(0.3, 0.0, 0.0)))
    simulation.add_current(0.0, (0.1, 0.0, 0.0))
    simulation.adopt(straight())
    simulation.advance(1.5)
    assert np.allclose(simulation.water_at([0, 0, 0]), [0.4, 0.1, 0.0])


@pytest.mark.parametrize(
    ("sample", "message"),
    [
        ((np.nan, (0, 0, 0)), "current time must be finite"),
        ((1e300, (0, 0, 0)), r"current time must be <= 1e\+12 s, got 1e\+300"),
        ((0.0, (0, 0)), "current velocity must be 3 numbers"),
        ((0.0, (0, np.inf, 0)), "current velocity must be finite"),
        ((0.0, (0, 0, 0.1)), "current velocity must have no part along z in a planar scene, got 0.1 m/s"),
    ],
)
def test_a_sample_that_does_not_fit_is_named(sample, message):
    with pytest.raises(ValueError, match=message):
        Simulation(scene=Scene(planar=True)).add_current(*sample)


@pytest.mark.parametrize(
    ("text", "flow"),
    [
        ("shear velocity=0.1,0,0 width=0.5", Shear(velocity=(0.1, 0.0, 0.0), width=0.5)),
        ("vortex_street count=3 core=0.3 + wave", VortexStreet(count=3, core=0.3) + Wave()),
        ("uniform velocity=0,0,0;0.1,0,0 time=0,1", Uniform(((0, 0, 0), (0.1, 0, 0)), time=(0, 1))),
        ("uniform velocity=0.1,0,0 + shear profile=linear", Uniform((0.1, 0, 0)) + Shear(profile="linear")),
        ("vortex", Vortex()),
        ("", None),
    ],
)
def test_a_text_is_a_flow_and_a_flow_a_text(text, flow):
    assert flow_from_text(text) == flow
    assert flow is None or flow_from_text(text_of_flow(flow)) == flow


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("vortices", "flow must be one of uniform, .* did you mean 'vortex'|flow must be one of"),
        ("shear width", r"flow must be one of .*, got 'shear width' .did you mean 'shear'"),
        ("shear width=1 width=2", "each once, got 'width=2'"),
        ("shear breadth=1", "flow Shear has no field 'breadth'"),
        ("shear width=wide", "width"),
        ("nowhere.nc", "flow file nowhere.nc: there is no such file"),
    ],
)
def test_a_text_that_does_not_fit_is_named(text, message):
    with pytest.raises(ValueError, match=message):
        flow_from_text(text)
