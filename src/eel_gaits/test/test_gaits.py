# SPDX-License-Identifier: Apache-2.0
"""The gaits against their sources, written out separately, and the registry."""

import dataclasses
import inspect
import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import eel_gaits
from eel_gaits import GAITS, Law, falling, gait, straight, turning

STATIONS = np.linspace(0.0, 1.0, 23)
TIMES = (0.0, 0.4, 1.0, 1.3, 2.0, 2.71, 4.0, 6.5, 7.0, 7.9, 8.0, 9.99)


def f_r(t, begin, end):
    """Eq. (64) as printed."""
    if t < begin:
        return 0.0
    if t >= end:
        return 1.0
    s = (t - begin) / (end - begin)
    return s - math.sin(2.0 * math.pi * s) / (2.0 * math.pi)


def gamma(t):
    """Below eq. (66), case by case as printed; t1 ... t6 = 1, 2, 3, 6, 7, 8 s."""
    if t < 2.0:
        return f_r(t, 1.0, 2.0)
    if t < 6.0:
        return 1.0 - f_r(t, 2.0, 3.0)
    if t < 7.0:
        return -f_r(t, 6.0, 7.0)
    return f_r(t, 7.0, 8.0) - 1.0


def forward_wave(t, x):
    """Eq. (65) with the numbers of section 7.2.2."""
    return (2.0 * x**2 + 0.5 * x + 1.0) * np.sin(2.0 * math.pi * (x / 1.0 - t / 1.0))


@pytest.mark.parametrize("t", TIMES)
def test_falling_is_the_law_of_the_paper(t):
    value = falling().curvature(t, STATIONS)[0]
    np.testing.assert_allclose(value[:, 1], 0.5 * gamma(t), atol=1e-14)
    np.testing.assert_allclose(value[:, 2], f_r(t, 0.0, 1.0) * forward_wave(t, STATIONS), atol=1e-13)


@pytest.mark.parametrize("t", TIMES)
def test_the_other_gaits_of_the_family(t):
    wave = f_r(t, 0.0, 1.0) * forward_wave(t, STATIONS)
    falls, rises = falling().curvature(t, STATIONS)[0], gait("rising").curvature(t, STATIONS)[0]
    np.testing.assert_array_equal(rises, falls * [1.0, -1.0, 1.0])
    forward = straight().curvature(t, STATIONS)[0]
    np.testing.assert_allclose(forward[:, 2], wave, atol=1e-13)
    assert not forward[:, 1].any()
    turn = turning(left_bend=0.7).curvature(t, STATIONS)[0]
    np.testing.assert_allclose(turn[:, 2], wave - 0.7 * f_r(t, 1.0, 2.0), atol=1e-13)
    backward = gait("backward").curvature(t, STATIONS)[0][:, 2]
    to_the_head = np.polyval([2.0, 0.5, 1.0], STATIONS) * np.sin(2.0 * math.pi * (-STATIONS - t))
    np.testing.assert_allclose(backward, f_r(t, 0.0, 1.0) * to_the_head, atol=1e-13)


@pytest.mark.parametrize(
    ("name", "scaled", "waves"),
    [
        ("kern_fast", [1.51, 0.48, 5.74, 2.73], 1.44),
        ("kern_efficient", [3.34, 1.67, 2.0 * math.pi, 2.0 * math.pi], 1.72),
    ],
)
@pytest.mark.parametrize(("length", "period"), [(1.0, 1.0), (0.25, 0.4)])
def test_kern_gaits_in_body_lengths(name, scaled, waves, length, period):
    """kappa = K(s) sin 2 pi (t/T - tau s/L), once the start is over; K L is what the source prints."""
    law, s = gait(name, length=length, period=period), STATIONS * length
    spline = CubicSpline(np.linspace(0.0, length, 4), np.array(scaled) / length, bc_type="natural")
    for t in (period, 1.37 * period, 5.2 * period):
        expected = spline(s) * np.sin(2.0 * math.pi * (t / period - waves * s / length))
        np.testing.assert_allclose(law.curvature(t, s)[0][:, 2], expected, atol=1e-12 / length)


def test_helix_and_rolling_turn_the_bend_about_the_backbone():
    """Pitch and yaw a quarter of a period apart: with equal amplitudes the bend keeps its size."""
    for name, size in (("helix", 1.5), ("rolling", 1.0)):
        for t in (1.0, 1.3, 2.9):
            value = gait(name).curvature(t, STATIONS)[0]
            np.testing.assert_allclose(np.hypot(value[:, 1], value[:, 2]), size, rtol=1e-13)
    value = gait("rolling").curvature(1.3, STATIONS)[0]
    assert np.ptp(value[:, 1]) == 0.0 and np.ptp(value[:, 2]) == 0.0
    assert np.ptp(gait("helix").curvature(1.3, STATIONS)[0][:, 2]) > 1.0


@pytest.mark.parametrize("name", sorted(GAITS))
def test_every_gait_starts_smoothly_from_the_straight_body(name):
    law = gait(name)
    assert isinstance(law, Law) and law.name == name
    for each in law.curvature(0.0, STATIONS):
        assert not each.any()
    near = [np.abs(each).max() for each in law.curvature(1e-4, STATIONS)]
    assert near[0] < 1e-7 and near[1] < 1e-3 and near[2] < 1.0
    assert name == "still" or np.abs(law.curvature(1.7, STATIONS)[0]).max() > 0.1


@pytest.mark.parametrize("name", sorted(GAITS))
def test_every_number_tells_its_unit_bounds_and_meaning(name):
    function = GAITS[name]
    assert getattr(eel_gaits, name) is function and function.__doc__
    for entry in dataclasses.fields(function.numbers):
        about = entry.metadata
        assert about["description"] and isinstance(about["unit"], str)
        assert about["minimum"] <= entry.default <= about["maximum"]
        assert inspect.signature(function).parameters[entry.name].default == entry.default


@pytest.mark.parametrize("name", sorted(set(GAITS) - {"still"}))
def test_every_number_changes_the_law(name):
    """No number is declared and then forgotten."""
    streamed = {"convergence", "following", "length"} if name == "cpg" else set()  # of its start alone: test_cpg.py
    for entry in dataclasses.fields(GAITS[name].numbers):
        if entry.name in streamed:
            continue
        value = 0.9 * entry.default or 0.1
        changed = gait(name, **{entry.name: value})
        assert changed.terms != gait(name).terms, entry.name


def test_transition_belongs_to_the_law():
    assert falling(transition=2).transition == 2.0
    assert falling() == gait("falling", transition=0.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: gait("swim"),
            "unknown gait 'swim', must be one of anguilliform, backward, burst_and_coast, c_start, carangiform",
        ),
        (lambda: gait(3), "unknown gait 3, must be one of"),
        (lambda: gait(["falling"]), "unknown gait ['falling'], must be one of"),
        (lambda: gait("falling", yaw_bend=1.0), "gait 'falling' has no number 'yaw_bend', it has: period, start"),
        (lambda: turning(left_bent=1.0), "gait 'turning' has no number 'left_bent' (did you mean 'left_bend'?), it"),
        (lambda: gait("still", period=1.0), "gait 'still' has no number 'period', it has: none"),
        (lambda: falling(period=-1.0), "period must be >= 0.001 s, got -1.0"),
        (lambda: falling(period=1e9), "period must be <= 10000 s, got 1000000000.0"),
        (lambda: falling(period="fast"), "period must be a number, got 'fast'"),
        (lambda: falling(period=math.nan), "period must be finite, got nan"),
        (lambda: falling(bend_full=0.5), "bend_full must be > bend_start (1 s), got 0.5"),
        (lambda: falling(counter_end=7.0), "counter_end must be > counter_full (7 s), got 7.0"),
        (lambda: turning(bend_start=2), "bend_full must be > bend_start (2 s), got 2.0"),
        (lambda: falling(transition=-1), "transition must be >= 0 s, got -1"),
    ],
)
def test_refuses_with_the_number_and_what_it_got(make, message):
    with pytest.raises(ValueError) as caught:
        make()
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", GAITS)
def test_help_on_a_gait_tells_each_number(name):
    text = inspect.getdoc(GAITS[name])
    for item in dataclasses.fields(GAITS[name].numbers):
        about = item.metadata
        bounds = f">= {about['minimum']:g} {about['unit']}".rstrip()
        assert f"{item.name} = {item.default!r}: {about['description']}" in text and bounds in text
    assert "transition = 0.0: duration of the blend into the law" in text
