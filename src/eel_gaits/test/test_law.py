# SPDX-License-Identifier: Apache-2.0
"""Ramp, Term and Law: exact derivatives, limits, and every refusal."""

import math

import numpy as np
import pytest
from hypothesis import given
from jet import Jet
from law_strategies import laws, numbers, ramps, terms

from eel_gaits import Law, Ramp, Term, natural_spline

STATIONS = np.array([0.0, 0.013, 0.31, 0.5, 0.77, 1.0])


def ramp_jet(ramp, t):
    """Eq. (64), times delta, from the formula alone."""
    if t < ramp.start:
        return Jet(0.0)
    if t >= ramp.end:
        return Jet(ramp.delta)
    duration = ramp.end - ramp.start
    s = Jet((t - ramp.start) / duration, 1.0 / duration)
    return ramp.delta * (s - (2.0 * math.pi * s).sin() * (1.0 / (2.0 * math.pi)))


def term_jet(term, t, x):
    """A term from the words of CurvatureTerm, with its derivatives by automatic differentiation."""
    envelope = Jet(1.0)
    for factor in {ramp.factor for ramp in term.envelope}:
        envelope *= sum((ramp_jet(ramp, t) for ramp in term.envelope if ramp.factor == factor), Jet(0.0))
    if term.knots:
        amplitude = natural_spline(term.knots, term.amplitude, x)
    else:
        amplitude = sum(coefficient * x**power for power, coefficient in enumerate(term.amplitude))
    turns = Jet(x / term.wavelength if term.wavelength else 0.0 * x)
    if term.period:
        turns = turns - Jet(t, 1.0) * (1.0 / term.period)
    return amplitude * envelope * (2.0 * math.pi * turns + term.phase).sin()


@given(ramp=ramps(), t=numbers(-7.0, 10.0))
def test_ramp_has_the_derivatives_of_its_formula(ramp, t):
    value, rate, acceleration = ramp.value(t)
    expected = ramp_jet(ramp, t)
    scale = abs(ramp.delta) * max(1.0, (ramp.end - ramp.start) ** -2) + 1e-300
    assert abs(value - expected.value) < 1e-13 * scale
    assert abs(rate - expected.rate) < 1e-12 * scale
    assert abs(acceleration - expected.acceleration) < 1e-10 * scale


def test_ramp_is_twice_differentiable_at_its_ends():
    """Value, rate and acceleration approach those outside, the acceleration linearly: it is continuous."""
    ramp = Ramp(1.0, 3.0, 0.7)
    for end, outside in ((1.0, 0.0), (3.0, 0.7)):
        for step, bound in ((1e-3, 1e-2), (1e-5, 1e-4)):
            values = np.array([ramp.value(end + side * step) for side in (-1.0, 1.0)])
            assert np.all(np.abs(values - [outside, 0.0, 0.0]) < bound)


def test_ramp_is_exact_outside_and_halfway():
    ramp = Ramp(1.0, 2.0, -0.25)
    for t, expected in ((-5.0, 0.0), (1.0, 0.0), (2.0, -0.25), (1e9, -0.25)):
        assert [float(each) for each in ramp.value(t)] == [expected, 0.0, 0.0]
    np.testing.assert_allclose(ramp.value(1.5), [-0.125, -0.5, 0.0], atol=1e-14)
    assert ramp.value(np.zeros((2, 3)))[2].shape == (2, 3)


@given(term=terms(), t=numbers(-7.0, 10.0))
def test_term_has_the_derivatives_of_its_formula(term, t):
    expected = term_jet(term, t, STATIONS)
    got = term.curvature(t, STATIONS)
    frequency = 2.0 * math.pi / term.period if term.period else 0.0
    fastest = max([1.0, frequency, *(7.0 / (ramp.end - ramp.start) for ramp in term.envelope)])
    height = math.prod(1.0 + abs(ramp.delta) for ramp in term.envelope)
    size = 1.0 + np.max(np.abs(term.amplitude_at(STATIONS))) * height
    for ours, theirs in zip(got, (expected.value, expected.rate, expected.acceleration), strict=True):
        np.testing.assert_allclose(ours, np.broadcast_to(theirs, 6), rtol=0.0, atol=1e-12 * size * fastest**2)


def test_rates_are_the_differences_of_the_values():
    """Independent of any formula: sixth-order central differences of what the law itself returns."""
    law = Law(
        Term(
            axis="yaw",
            amplitude=(1.0, 0.5, 2.0),
            wavelength=0.8,
            period=1.3,
            phase=0.4,
            envelope=(Ramp(0.0, 2.0, 1.0),),
        ),
        Term(axis="pitch", amplitude=(0.1, 0.7, -0.3), knots=(0.0, 0.4, 1.0), wavelength=-1.7, period=0.6),
        Term(axis="pitch", amplitude=(0.5,), phase=math.pi / 2.0, envelope=(Ramp(0.5, 1.5, 1.0), Ramp(1.0, 3.0, -1.0))),
    )
    step, weights = 1e-2, np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60.0
    for t in (0.3, 0.77, 1.21, 2.4):
        near = [law.curvature(t + index * step, STATIONS) for index in range(-3, 4)]
        for order in (0, 1):
            difference = sum(weight * each[order] for weight, each in zip(weights, near, strict=True)) / step
            np.testing.assert_allclose(near[3][order + 1], difference, atol=5e-6 * (2.0 * math.pi / 0.6) ** 2)


def test_columns_are_none_pitch_yaw_and_terms_add():
    pitch = Term(axis="pitch", amplitude=(0.3,), phase=math.pi / 2.0)
    yaw = Term(axis="yaw", amplitude=(0.0, 2.0), phase=math.pi / 2.0)
    value, rate, acceleration = Law(pitch, yaw, yaw).curvature(0.0, STATIONS)
    assert value.shape == rate.shape == acceleration.shape == (6, 3)
    np.testing.assert_array_equal(value[:, 0], 0.0)
    np.testing.assert_allclose(value[:, 1], 0.3, rtol=1e-15)
    np.testing.assert_allclose(value[:, 2], 4.0 * STATIONS, rtol=1e-15)
    assert not rate.any() and not acceleration.any()


def test_no_term_is_the_straight_body():
    for each in Law().curvature(3.0, STATIONS):
        np.testing.assert_array_equal(each, np.zeros((6, 3)))


@pytest.mark.parametrize(("wavelength", "speed"), [(0.8, 0.4), (-0.8, -0.4)])
def test_a_positive_wavelength_runs_to_the_tail_a_negative_one_to_the_head(wavelength, speed):
    """K(t, X) depends on X - speed t alone, speed = wavelength / period."""
    law = Law(Term(amplitude=(1.0,), wavelength=wavelength, period=2.0, phase=0.3))
    later = law.curvature(0.25, STATIONS + 0.25 * speed)[0]
    np.testing.assert_allclose(later, law.curvature(0.0, STATIONS)[0], atol=1e-14)


def test_each_quotient_is_dropped_where_its_divisor_is_zero():
    standing = Law(Term(amplitude=(1.0,), period=2.0)).curvature(0.5, STATIONS)[0][:, 2]
    np.testing.assert_allclose(standing, math.sin(-math.pi / 2.0), rtol=1e-15)
    frozen = Law(Term(amplitude=(1.0,), wavelength=2.0)).curvature(123.4, STATIONS)
    np.testing.assert_allclose(frozen[0][:, 2], np.sin(math.pi * STATIONS), atol=1e-15)
    assert not frozen[1].any() and not frozen[2].any()


@given(law=laws())
def test_laws_are_values(law):
    same = Law(*law.terms, name=law.name, transition=law.transition)
    assert same == law and hash(same) == hash(law)
    assert law != Law(*law.terms, Term(amplitude=(1.0,)), name=law.name, transition=law.transition)
    with pytest.raises(AttributeError):
        law.name = "other"


def test_arrays_and_integers_become_floats():
    term = Term(
        amplitude=np.array([1, 2]), knots=[0, np.float32(1.0)], wavelength=1, period=2, envelope=[Ramp(0, 1, 1)]
    )
    assert term == Term(
        amplitude=(1.0, 2.0), knots=(0.0, 1.0), wavelength=1.0, period=2.0, envelope=(Ramp(0.0, 1.0, 1.0),)
    )
    assert all(type(each) is float for each in (*term.amplitude, *term.knots, term.wavelength, term.envelope[0].end))


def term(**changes):
    return Term(**{"amplitude": (1.0, 2.0), **changes})


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: term(axis="roll"), "axis must be one of pitch, yaw, got 'roll'"),
        (lambda: term(axis=3), "axis must be one of pitch, yaw, got 3"),
        (lambda: term(axis=["yaw"]), "axis must be one of pitch, yaw, got ['yaw']"),
        (lambda: term(amplitude=()), "amplitude must have at least 1 coefficient, got none"),
        (lambda: term(amplitude=(1.0, math.nan)), "amplitude[1] must be finite, got nan"),
        (lambda: term(amplitude=2.0), "amplitude must be a row of numbers, got 2.0"),
        (lambda: term(amplitude=("a",)), "amplitude[0] must be a number, got 'a'"),
        (lambda: term(knots=(0.0,)), "knots must be none or at least 2, got 1"),
        (lambda: term(knots=(0.0, 0.5, 1.0)), "amplitude must have one value per knot (3), got 2 values"),
        (lambda: term(knots=(0.5, 0.5)), "knots must be strictly increasing [m], got [0.5, 0.5]"),
        (lambda: term(knots=(0.5, 0.1)), "knots must be strictly increasing [m], got [0.5, 0.1]"),
        (lambda: term(knots=(0.0, math.inf)), "knots[1] must be finite, got inf"),
        (lambda: term(knots=(0.0, 5e-324)), "knots must lie far enough apart"),
        (lambda: term(period=-1.0), "period must be >= 0 s, got -1.0"),
        (lambda: term(period=1e-300), "period must be 0 or long enough for finite rates, got 1e-300"),
        (lambda: term(period=math.inf), "period must be finite, got inf"),
        (lambda: term(wavelength=math.nan), "wavelength must be finite, got nan"),
        (lambda: term(wavelength=-1e-300), "wavelength must be 0 or long enough"),
        (lambda: term(phase="north"), "phase must be a number, got 'north'"),
        (lambda: term(phase=True), "phase must be a number, got True"),
        (lambda: term(phase=10**400), "phase must be a number, got 1"),
        (lambda: term(envelope=(1.0,)), "envelope must hold Ramps, got 1.0"),
        (lambda: term(envelope=1.0), "envelope must be a row of Ramps, got 1.0"),
        (lambda: Ramp(1.0, 1.0, 1.0), "end must be > start (1.0 s), got 1.0"),
        (lambda: Ramp(1.0, 0.0, 1.0), "end must be > start (1.0 s), got 0.0"),
        (lambda: Ramp(math.nan, 0.0, 1.0), "start must be finite, got nan"),
        (lambda: Ramp(0.0, 1.0, math.inf), "delta must be finite, got inf"),
        (lambda: Ramp(0.0, 1e-200, 1.0), "end must lie so after start (0.0 s) that rates are finite, got 1e-200"),
        (lambda: Ramp(-1e308, 1e308, 1.0), "start must be 0 to 1e+30 in size"),
        (lambda: Law(*[term()] * 1001), "terms must be at most 1000, got 1001"),
        (lambda: Law(Ramp(0.0, 1.0, 1.0)), "terms[0] must be a Term, got Ramp"),
        (lambda: Law(transition=-0.5), "transition must be >= 0 s, got -0.5"),
        (lambda: Law(transition=math.nan), "transition must be finite, got nan"),
    ],
)
def test_refuses_with_the_field_and_the_value(make, message):
    with pytest.raises(ValueError) as caught:
        make()
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_thousand_terms_are_taken():
    assert len(Law(*[term()] * 1000).terms) == 1000


def test_terms_may_be_a_sequence():
    one, two = Term(amplitude=(1.0,)), Term(axis="pitch", amplitude=(0.5,))
    assert Law([one, two], name="both") == Law(one, two, name="both") == Law((one, two), name="both")
    assert Law([]) == Law() and repr(Law([one], transition=2.0)) == "Law('law', 1 term, transition=2 s)"
    with pytest.raises(ValueError, match=r"terms\[1\] must be a Term, got 3"):
        Law([one, 3])
