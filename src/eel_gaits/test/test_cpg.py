# SPDX-License-Identifier: Apache-2.0
"""The chain of oscillators: it settles at one wave term, and nothing jumps when its numbers change."""

import numpy as np
import pytest
from eel_gaits.gaits.cpg import Oscillation, Oscillators

from eel_gaits import cpg, straight


def test_its_steady_state_is_one_wave_term_and_a_bend():
    chain = Oscillators(Oscillation(left_bend=-0.3))
    for time in (10.0, 10.37):
        chain.advance(time)
        expected = cpg(left_bend=-0.3).curvature(time, chain.x)
        for ours, law in zip(chain.curvature(), expected, strict=True):
            np.testing.assert_allclose(ours, law[:, 2], atol=1e-4 * np.max(np.abs(law)))
    assert cpg().terms == straight().terms


def test_after_a_change_it_settles_at_the_wave_of_the_new_numbers():
    """The phase depends on the way there, so it is taken from the chain itself."""
    chain = Oscillators(Oscillation())
    chain.advance(3.0)
    chain.numbers = Oscillation(period=0.7, wavelength=0.8, amplitude_2=1.0, amplitude_0=0.5)
    chain.advance(15.0)
    amplitude = 0.5 + 0.5 * chain.x + chain.x**2
    value, rate, _ = chain.curvature()
    w = 2.0 * np.pi / 0.7
    np.testing.assert_allclose(np.hypot(value, rate / w), amplitude, rtol=1e-3)
    phase = np.unwrap(np.arctan2(-value, -rate / w))  # theta, which falls by k X
    np.testing.assert_allclose(phase[0] - phase, 2.0 * np.pi / 0.8 * chain.x, atol=1e-3)


@pytest.mark.parametrize("change", [{"convergence": 2.0}, {"following": 1.0}])
def test_slower_numbers_make_a_slower_start(change):
    slow, usual = Oscillators(Oscillation(**change)), Oscillators(Oscillation())
    for chain in (slow, usual):
        chain.advance(1.0)
    assert np.max(np.abs(slow.curvature()[0])) < 0.8 * np.max(np.abs(usual.curvature()[0]))


def test_it_begins_at_rest():
    np.testing.assert_allclose(Oscillators(Oscillation()).curvature(), 0.0, atol=1e-12)


@pytest.mark.parametrize(
    "change", [{"period": 0.5}, {"wavelength": 2.0}, {"amplitude_0": 3.0}, {"left_bend": -1.0}, {"amplitude_2": -2.0}]
)
def test_no_rate_and_no_acceleration_jumps_when_a_number_changes(change):
    chain = Oscillators(Oscillation())
    chain.advance(4.3)
    before = chain.curvature()
    chain.numbers = Oscillation(**change)
    np.testing.assert_allclose(chain.curvature(), before, atol=1e-9)
    rows = [before]
    for step in range(1, 41):
        chain.advance(4.3 + 0.005 * step)
        rows.append(chain.curvature())
    rows = np.array(rows)
    jumps = np.max(np.abs(np.diff(rows, axis=0)), axis=(0, 2))
    assert np.all(jumps < [0.2, 2.0, 25.0])  # of 3.5 rad/m, 22 rad/m/s and 138 rad/m/s^2
    quotient = (rows[2:, :2] - rows[:-2, :2]) / 0.01  # central differences
    np.testing.assert_allclose(quotient[:, 0], rows[1:-1, 1], atol=0.02)
    np.testing.assert_allclose(quotient[:, 1], rows[1:-1, 2], atol=0.2)
