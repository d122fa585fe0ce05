# SPDX-License-Identifier: Apache-2.0
"""Functions that rest and move for a moment: nothing is missed in silence, in time or along the body."""

import math

import numpy as np
import pytest
from eel_gaits.sources.lateral import LateralMidline
from eel_gaits.sources.period import period_of

from eel_gaits import sampled

X = np.linspace(0.0, 1.0, 201)
RESTS = {
    "straight": lambda t, x: 0.0 * x,
    "bent": lambda t, x: 0.5 + 0.0 * x,
    "a slow wave": lambda t, x: np.sin(2.0 * math.pi * (x - 0.2 * t)),
    "round-off": lambda t, x: 1e-15 * np.sin(1e3 * t + x),
}


def bend(time, at, half):
    """A bend from 0 to 1 and back, of three continuous derivatives, that lasts 2 `half` [s] around `at` [s]."""
    return (1.0 - min(((time - at) / half) ** 2, 1.0)) ** 4


def apart(law, function, times):
    """Greatest difference of the yaw curvature, relative to its greatest value."""
    wanted = np.array([function(time, X) for time in times])
    found = np.array([law.curvature(time, X)[0][:, 2] for time in times])
    return np.max(np.abs(found - wanted)) / np.max(np.abs(wanted))


@pytest.mark.parametrize("rest", RESTS)
def test_a_short_bend_is_met_wherever_it_is_and_however_long_the_run(rest):
    draw = np.random.default_rng(6)
    for _ in range(4):
        duration, half = 10.0 ** draw.uniform(0.0, 1.4), 10.0 ** draw.uniform(-2.2, -0.7)
        at = draw.uniform(0.0, duration)

        def twitch(t, x, at=at, half=half):
            return RESTS[rest](t, x) + 8.0 * bend(t, at, half) * np.sin(math.pi * x)

        inside = np.clip(np.linspace(at - half, at + half, 41), 0.0, duration)
        assert apart(sampled(twitch, duration), twitch, inside) < 1e-5


def test_a_bend_that_is_short_and_local_is_met():
    """The points along the body are chosen where and when the function bends it."""

    def flick(t, x):
        return np.sin(2.0 * math.pi * (x - t)) + 5.0 * bend(t, 3.21, 0.04) * np.exp(-(((x - 0.62) / 0.03) ** 2))

    law = sampled(flick, 8.0)
    assert apart(law, flick, np.linspace(3.17, 3.25, 33)) < 2e-5
    assert len(law.x) > 2 * len(sampled(RESTS["a slow wave"], 8.0).x)


@pytest.mark.parametrize("duration", [1.0, 30.0])
def test_the_looks_are_as_close_whatever_the_duration(duration):
    looked = []

    def still(t, x):
        looked.append(t)
        return 0.0 * x

    sampled(still, duration)
    assert np.max(np.diff(np.unique(looked))) < 2.0 * 0.005
    looked.clear()
    sampled(still, duration, step=0.1)
    assert 0.01 < np.max(np.diff(np.unique(looked))) < 0.2


def test_a_shorter_step_sees_a_shorter_bend():
    def twitch(t, x):
        return bend(t, 2.6001, 0.0005) * x

    assert np.any(sampled(twitch, 4.0, step=5e-4).values)
    with pytest.raises(ValueError, match="step must be 4e-06 s or more for a duration of 4 s, got 1e-07 s"):
        sampled(twitch, 4.0, step=1e-7)
    with pytest.raises(ValueError, match="step must be > 0 s, got 0"):
        sampled(twitch, 4.0, step=0.0)


def test_rows_are_far_apart_where_the_function_rests():
    law = sampled(lambda t, x: bend(t, 20.3, 0.05) * x, 40.0)
    step = np.diff(law.time)
    assert step.max() > 50.0 * step.min() and len(law.time) < 1000
    assert np.max(step[1:] / step[:-1]) < 2.01 and np.max(step[:-1] / step[1:]) < 2.01


def test_accelerations_are_met_where_rows_change_their_distance():
    half, at = 0.08, 2.9
    law = sampled(lambda t, x: np.exp(-(((t - at) / half) ** 2)) * x, 6.0)
    times = np.linspace(2.4, 3.4, 301)
    square = ((times - at) / half) ** 2
    wanted = (4.0 * square - 2.0) / half**2 * np.exp(-square)
    found = [law.curvature(time, [1.0])[2][0, 2] for time in times]
    assert np.max(np.abs(found - wanted)) < 2e-3 * np.max(np.abs(wanted))


def test_a_rate_that_jumps_is_told_or_refused():
    with pytest.warns(UserWarning, match=r"rate of the curvature's function 'begun' seems to jump near t = 0.9999 s"):
        sampled(lambda t, x: 0.1 * min(t, 1.0) + np.sin(2.0 * math.pi * (x - t)), 2.0, name="begun")
    with pytest.raises(ValueError, match=r"smooth in time: rows .* miss it by .* at t = 1\.5"):
        sampled(lambda t, x: abs(math.sin(2.0 * math.pi * t)) * x, 2.7)


def test_a_noisy_function_is_refused():
    with pytest.raises(ValueError, match="smooth in time"):
        sampled(lambda t, x: np.sin(x - t) + 1e-3 * math.sin(1e6 * t), 3.0)


def test_the_period_does_not_depend_on_where_rows_are_close():
    even = np.linspace(0.0, 8.0, 400)
    time = np.union1d(even, np.linspace(2.0, 2.3, 900))
    places = np.linspace(0.0, 1.0, 15)

    def rows(instants):
        return np.sin(2.0 * math.pi * (places - instants[:, None] / 0.9)) * (0.2 + places)

    assert period_of(time, rows(time)) == pytest.approx(0.9, rel=1e-4)


def test_a_detail_of_a_displacement_is_refused_where_points_pass_over_it():
    def dented(x, t):
        return (0.02 + 0.08 * x**2) * np.sin(2.0 * math.pi * (x - t)) + 1e-3 * np.exp(-(((x - 0.5061) / 0.001) ** 2))

    with pytest.raises(ValueError, match=r"h must be smooth along the body: 129 points miss it by .* m at t = 0"):
        sampled(LateralMidline(dented).curvature, 1.0)
