# SPDX-License-Identifier: Apache-2.0
"""Limits of the hull's coefficients and of slender tails are told, each with what to do."""

import numpy as np
import pytest

from eel_dynamics import Body, Scene, simulate
from eel_gaits import straight

PLANE = Scene(planar=True, friction="blended")


def told(body, words, **numbers):
    run = simulate(straight(**numbers), 4.0, body=body, scene=PLANE, accuracy=1e-2)
    return any(words in text for text in run.warnings)


@pytest.mark.parametrize(("amplitude", "factor", "words"), [(4.0, 1.0, "try round_added_mass=0.2"), (0.2, 0.2, "=1")])
def test_round_sections_whose_added_mass_does_not_fit_the_motion_are_told(amplitude, factor, words):
    body = Body.of_links(1.0, 8, 0.03, 0.03, joints="flush", round_added_mass=factor)
    assert told(body, words, amplitude_0=amplitude, amplitude_1=0.0, amplitude_2=0.0)
    other = body.changed(round_added_mass=1.2 - factor)
    assert not told(other, "round_added_mass", amplitude_0=amplitude, amplitude_1=0.0, amplitude_2=0.0)


def test_flat_sections_keep_the_whole_added_mass():
    assert not told(Body.of_links(1.0, 8, 0.01, 0.05, joints="flush", round_added_mass=1.0), "round_added_mass")


def test_a_tail_that_waves_shortly_is_told_until_its_added_mass_is_given():
    body = Body.of_links(1.0, 8, 0.01, 0.09, joints="flush")
    assert told(body, "k a =", wavelength=0.6)
    assert not told(body.changed(lateral_added_mass=lambda x: 1.0 - 0.3 * x), "k a =", wavelength=0.6)
    assert not told(Body.of_links(1.0, 8, 0.01, 0.03, joints="flush"), "k a =", wavelength=0.6)


def test_a_tail_that_rises_suddenly_is_a_wing():
    x = np.linspace(0.0, 1.0, 41)
    body = Body(
        x=x, half_width=np.full(41, 0.01), half_height=np.where(x < 0.95, 0.03, 0.1), blunt_nose=True, name="winged"
    )
    assert told(body, "such a tail is a wing")
    slow = body.changed(half_height=0.03 + 0.07 * np.clip((x - 0.6) / 0.4, 0.0, 1.0))
    assert not told(slow, "such a tail is a wing")


def test_a_high_strouhal_number_is_told():
    slow = Body.of_links(1.0, 8, 0.03, 0.04, joints=0.87, nose_drag=5.0)
    assert told(slow, "Strouhal number") and not told(Body.boyer2010(), "Strouhal number")
