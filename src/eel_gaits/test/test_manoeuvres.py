# SPDX-License-Identifier: Apache-2.0
"""Manoeuvres against their formulas, written out separately."""

import math

import numpy as np
import pytest
from eel_gaits.laws.midline import curvature_of_lateral
from scipy.integrate import cumulative_simpson
from scipy.special import roots_legendre

from eel_gaits import anguilliform, burst_and_coast, c_start, carangiform, gait, joint_wave, serpenoid, straight

X = np.linspace(0.0, 1.0, 401)
TURN = 2.0 * math.pi


def midline(law, t, lateral, slope):
    """Lateral displacement of the midline that the curvature gives, from the nose's displacement and slope."""
    curvature = law.curvature(t, X)[0][:, 2]
    angle = math.asin(slope) + cumulative_simpson(curvature, x=X, initial=0.0)
    return lateral + cumulative_simpson(np.sin(angle), x=X, initial=0.0)


@pytest.mark.parametrize(
    ("make", "waves", "amplitude"),
    [
        (carangiform, 1.0 / 0.95, lambda x: 0.02 - 0.0825 * x + 0.1625 * x**2),
        (anguilliform, 1.0 / 0.642, lambda x: 0.089 * np.exp(x - 1.0)),
        (lambda: anguilliform(waves=1.0, growth=2.0), 1.0, lambda x: 0.089 * np.exp(2.0 * (x - 1.0))),
    ],
)
@pytest.mark.parametrize("t", [1.0, 1.37, 2.81])
def test_the_midline_of_a_fish_has_the_lateral_displacement_that_was_given(make, waves, amplitude, t):
    def lateral(x):
        return amplitude(x) * np.sin(TURN * (waves * x - t))

    slope = (lateral(1e-6) - lateral(-1e-6)) / 2e-6
    np.testing.assert_allclose(midline(make(), t, lateral(0.0), slope), lateral(X), atol=2e-5)


def test_a_fish_of_another_size_and_period_has_the_same_shape():
    small, x = carangiform(length=0.2, period=0.25), np.linspace(0.0, 0.2, 11)
    big = carangiform().curvature(1.6, 5.0 * x)[0]
    np.testing.assert_allclose(small.curvature(0.4, x)[0], 5.0 * big, rtol=1e-9, atol=1e-9)


def test_a_midline_that_is_too_steep_is_refused():
    with pytest.raises(ValueError, match=r"slope stays below 0.95, got 1\.1"):
        anguilliform(lateral_tail=0.12)
    with pytest.raises(ValueError, match=r"slope of the midline must be below 1, got 1"):
        curvature_of_lateral([0.0, 1.0], [0.0, 0.0])


def test_the_backbone_of_a_serpenoid_turns_by_the_winding_angle():
    law, k = serpenoid(winding_angle=0.7, waves=1.5, left_bend=-0.2), 1.5 * TURN
    for t in (1.2, 2.9):
        angle = cumulative_simpson(law.curvature(t, X)[0][:, 2], x=X, initial=0.0)
        wanted = 0.7 * np.sin(k * X - TURN * t) + 0.2 * X
        np.testing.assert_allclose(angle, wanted - wanted[0], atol=1e-8)


@pytest.mark.parametrize("joints", [1, 6, 10])
@pytest.mark.parametrize(("phase", "eel_like"), [(0.6, 1.0), (0.6, 0.0), (-1.1, 0.5), (0.0, 1.0)])
def test_each_joint_has_the_angle_of_the_formula(joints, phase, eel_like):
    """The integral of the curvature over the joint's segment; joints count from the tail."""
    law = joint_wave(joints=joints, joint_phase=phase, eel_like=eel_like, left_angle=-0.05, length=1.3, period=2.0)
    points, weights = roots_legendre(20)
    half = 0.65 / joints
    for t in (2.1, 3.77):
        for i in range(1, joints + 1):
            x = 1.3 - (2 * i - 1) * half + half * points
            angle = half * weights @ law.curvature(t, x)[0][:, 2]
            g = 1.0 - eel_like + eel_like * (joints - i) / (joints + 1)
            assert angle == pytest.approx(0.35 * g * math.sin(math.pi * t + (i - 1) * phase) + 0.05, abs=1e-13)


def test_bursts_repeat_and_the_body_is_straight_between_them():
    law, wave = burst_and_coast(bursts=3), straight()
    for start in (0.0, 6.0, 12.0):  # two ramps of 1 s, 1 s between them, 3 s of coasting
        np.testing.assert_allclose(law.curvature(start + 1.4, X), wave.curvature(start + 1.4, X), atol=1e-9)
        for t in (start + 3.0, start + 4.5, start + 6.0):
            assert np.max(np.abs(law.curvature(t, X))) < 1e-12
    assert np.max(np.abs(law.curvature(19.5, X))) < 1e-12  # after the last


def test_a_c_start_bends_first_and_is_the_forward_wave_afterwards():
    law = c_start()
    np.testing.assert_allclose(law.curvature(0.5, X)[0][:, 2], 4.0, atol=1e-12)
    np.testing.assert_allclose(law.curvature(2.3, X), straight().curvature(1.8, X), atol=1e-9)


def test_a_roll_over_is_straight_again_at_its_end():
    law = gait("roll_over")
    np.testing.assert_allclose(np.linalg.norm(law.curvature(3.5, X)[0], axis=1), 0.3, rtol=1e-12)
    assert np.max(np.abs(law.curvature(7.2, X))) < 1e-12


@pytest.mark.parametrize(
    ("name", "numbers", "message"),
    [
        ("burst_and_coast", {"bursts": 2.5}, "bursts must be a whole number, got 2.5"),
        ("joint_wave", {"joints": 3.5}, "joints must be a whole number, got 3.5"),
        ("joint_wave", {"eel_like": 2.0}, "eel_like must be <= 1, got 2.0"),
        ("diving", {"bend_end": 2.9}, "bend_end must be > unbend_start (3 s), got 2.9"),
    ],
)
def test_refusals_name_the_number(name, numbers, message):
    with pytest.raises(ValueError) as caught:
        gait(name, **numbers)
    assert str(caught.value) == message
