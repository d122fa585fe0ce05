# SPDX-License-Identifier: Apache-2.0
"""Laws that are made of laws: sums, scales, delays, mirrors, fades, and one after another."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from law_strategies import laws, numbers

from eel_gaits import Law, Ramp, Term, straight, turning

STATIONS = np.array([0.0, 0.31, 0.77, 1.0])
WAVE = Law(Term(amplitude=(1.0, 2.0), wavelength=0.8, period=0.7, phase=0.3), name="wave")  # since ever


def jets(law, t):
    return np.array(law.curvature(t, STATIONS))


def size(law):
    """Order of magnitude of a law's acceleration."""
    total = 1.0
    for term in law.terms:
        rates = [7.0 / (ramp.end - ramp.start) for ramp in term.envelope]
        fastest = max([1.0, 2.0 * math.pi / term.period if term.period else 0.0, *rates])
        height = math.prod(1.0 + abs(ramp.delta) for ramp in term.envelope)
        total += np.max(np.abs(term.amplitude_at(STATIONS))) * height * fastest**2
    return total


@given(laws(), laws(), numbers(-3.0, 3.0), numbers(-4.0, 4.0), numbers(-5.0, 9.0))
@settings(max_examples=20)
def test_sum_scale_delay_and_mirror_are_what_they_say(one, two, scale, delay, t):
    close = {"rtol": 0.0, "atol": 1e-9 * (size(one) + size(two)) * (1.0 + abs(scale))}
    np.testing.assert_allclose(jets(one + two, t), jets(one, t) + jets(two, t), **close)
    np.testing.assert_allclose(jets(scale * one, t), scale * jets(one, t), **close)
    np.testing.assert_allclose(jets(one.delayed(delay), t), jets(one, t - delay), **close)
    np.testing.assert_array_equal(jets(one.mirrored(), t), jets(one, t) * [1.0, 1.0, -1.0])
    np.testing.assert_array_equal(jets(one.mirrored("pitch"), t), jets(one, t) * [1.0, -1.0, 1.0])


@given(laws(), numbers(-4.0, 6.0), numbers(0.1, 3.0))
@settings(max_examples=20)
def test_ramps_leave_a_law_unchanged_on_one_side_and_straight_on_the_other(law, start, duration):
    end, scale = start + duration, 1e-9 * size(law)
    faded_in, faded_out = law.ramped_in(start, end), law.ramped_out(start, end)
    for later in (0.0, 0.3, 2.9):
        np.testing.assert_allclose(jets(faded_in, end + later), jets(law, end + later), rtol=0.0, atol=scale)
        np.testing.assert_allclose(jets(faded_out, start - later), jets(law, start - later), rtol=0.0, atol=scale)
        np.testing.assert_allclose(jets(faded_in, start - later), 0.0, atol=scale)
        np.testing.assert_allclose(jets(faded_out, end + later), 0.0, atol=scale)


@st.composite
def sequences(draw):
    """A law of up to four that follow one another, and the instants at which they do."""
    law, at, instants = draw(laws()), 0.0, []
    for _ in range(draw(st.integers(1, 3))):
        at += draw(numbers(0.2, 4.0))
        blend = draw(numbers(0.1, 3.0))
        law = law.followed_by(draw(laws()), at, blend)
        instants += [at, at + blend]
    return law, instants


@given(sequences(), numbers(-1.0, 12.0))
@settings(max_examples=30)
def test_random_sequences_are_twice_differentiable_in_time(sequence, t):
    """Value and rate are the integrals of rate and acceleration, and no acceleration jumps where a ramp ends."""
    law, instants = sequence
    points, weights = np.polynomial.legendre.leggauss(8)
    step, bound = 1e-3, size(law)
    mean = sum(0.5 * w * jets(law, t + 0.5 * step * (1.0 + p)) for p, w in zip(points, weights, strict=True))
    change = (jets(law, t + step) - jets(law, t)) / step
    np.testing.assert_allclose(change[:2], mean[1:], rtol=0.0, atol=1e-4 * bound)
    ends = {time for term in law.terms for ramp in term.envelope for time in (ramp.start, ramp.end)}
    for time in ends | set(instants):
        jump = np.abs(jets(law, time + 1e-9) - jets(law, time - 1e-9))
        assert np.max(jump) <= 1e-4 * bound, time


@given(laws(), laws(), numbers(0.5, 5.0), numbers(0.1, 2.0))
@settings(max_examples=20)
def test_the_law_that_follows_is_itself_after_the_blend(one, two, at, blend):
    both, scale = one.followed_by(two, at, blend), 1e-9 * (size(one) + size(two))
    np.testing.assert_allclose(jets(both, at - 0.1), jets(one, at - 0.1), rtol=0.0, atol=scale)
    after = at + blend + 0.4
    np.testing.assert_allclose(jets(both, after), jets(two, after - at), rtol=0.0, atol=scale)


def test_gaits_that_start_from_rest_need_no_product_of_ramps():
    law = straight().followed_by(turning(), at=8.0, blend=1.0)
    assert len(law.terms) == 3 and {ramp.factor for term in law.terms for ramp in term.envelope} == {0}
    half_way = straight().followed_by(turning(), at=0.5)  # the first law is still beginning
    assert {ramp.factor for term in half_way.terms for ramp in term.envelope} == {0, 1}


def test_a_term_that_never_begins_is_dropped():
    assert straight().ramped_out(-2.0, -1.0).terms == ()
    assert len(WAVE.ramped_out(-2.0, -1.0).terms) == 1


def test_names_and_transitions_of_what_is_made():
    assert (straight(transition=2.0) + WAVE).name == "straight + wave"
    assert (straight(transition=2.0) + WAVE).transition == 2.0
    assert (2 * WAVE).name == "wave" and (WAVE + WAVE).name == "wave"
    assert len((Law(name="x" * 150) + Law(name="y" * 150)).name) == 200


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: WAVE * math.nan, "scale must be finite, got nan"),
        (lambda: WAVE.delayed("soon"), "delay must be a number, got 'soon'"),
        (lambda: WAVE.mirrored("roll"), "axis must be one of pitch, yaw, got 'roll'"),
        (lambda: WAVE.mirrored(["yaw"]), "axis must be one of pitch, yaw, got ['yaw']"),
        (lambda: WAVE.ramped_in(2.0, 2.0), "end must be > start (2 s), got 2"),
        (lambda: WAVE.ramped_out(2.0, math.inf), "end must be finite, got inf"),
        (lambda: WAVE.followed_by(WAVE, at=1.0, blend=0.0), "blend must be > 0 s, got 0.0"),
        (lambda: WAVE.followed_by("straight", at=1.0), "the law that follows must be a Law, got 'straight'"),
        (lambda: Ramp(0.0, 1.0, 1.0, 0.5), "factor must be a whole number from 0 to 255, got 0.5"),
        (lambda: Ramp(0.0, 1.0, 1.0, 256), "factor must be a whole number from 0 to 255, got 256"),
    ],
)
def test_refusals(make, message):
    with pytest.raises(ValueError) as caught:
        make()
    assert str(caught.value) == message


def test_only_laws_add_and_only_numbers_scale():
    for make in (lambda: WAVE + 1.0, lambda: WAVE * WAVE):
        with pytest.raises(TypeError):
            make()
