# SPDX-License-Identifier: Apache-2.0
"""What the user has set: carry-over between gaits, and refusals that change nothing."""

import pytest
from eel_gaits.gaits.settings import Settings

from eel_gaits import falling, gait, turning


def test_starts_with_the_falling_gait():
    assert Settings.start({}).law() == falling()


def test_overrides_of_other_gaits_and_other_nodes_wait_or_are_left_aside():
    start = Settings.start({"gait": "falling", "period": 2, "left_bend": -0.25, "rate": 100, "scene.planar": True})
    assert start.law() == falling(period=2.0)
    assert start.changed({"gait": "turning"}).law() == turning(period=2.0, left_bend=-0.25)


def test_what_the_user_set_carries_over_and_defaults_do_not():
    settings = Settings().changed({"period": 2, "bend_start": 0.5, "transition": 3})
    turned = settings.changed({"gait": "turning"})
    assert turned.law() == turning(period=2.0, bend_start=0.5, transition=3.0)
    rolled = turned.changed({"gait": "rolling"})
    assert rolled.law() == gait("rolling", period=2.0, transition=3.0)
    assert rolled.changed({"gait": "kern_efficient"}).law().terms == gait("kern_efficient", period=2.0).terms
    assert rolled.changed({"gait": "falling"}).law() == settings.law()


def test_the_numbers_are_those_of_the_gait():
    settings = Settings(gait="turning")
    assert settings.law() == turning() and settings.numbers()["left_bend"] == turning.numbers().left_bend
    assert settings.changed({"left_bend": 0.75}).law() == turning(left_bend=0.75)
    with pytest.raises(ValueError, match=r"left_bend must be >= -100000 rad/m, got -1000000.0"):
        settings.changed({"left_bend": -1e6})


def test_a_gait_and_its_numbers_together():
    together = Settings().changed({"gait": "turning", "left_bend": 1, "period": 3})
    assert together.law() == turning(left_bend=1.0, period=3.0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"gait": "swim"}, "unknown gait 'swim'"),
        ({"gait": None}, "unknown gait None"),
        ({"left_bend": 1.0}, "gait 'falling' has no parameter 'left_bend' (did you mean 'pitch_bend'?), it has"),
        ({"gait": "turning", "pitch_bend": 1.0}, "gait 'turning' has no parameter 'pitch_bend'"),
        ({"period": 0.0}, "period must be >= 0.001 s, got 0.0"),
        ({"period": True}, "period must be a number, got True"),
        ({"period": None}, "period must be a number, got None"),
        ({"period": 2.0, "bend_start": 2.0}, "bend_full must be > bend_start (2 s), got 2.0"),
        ({"transition": -1.0}, "transition must be >= 0 s, got -1.0"),
    ],
)
def test_refuses_and_stays_as_it_was(changes, message):
    settings = Settings(chosen={"wavelength": 0.8})
    with pytest.raises(ValueError) as caught:
        settings.changed(changes)
    assert message in str(caught.value)
    assert settings.law() == falling(wavelength=0.8)


def test_a_number_that_does_not_suit_the_new_gait_is_named():
    settings = Settings().changed({"bend_start": 4.0, "bend_full": 5.0, "bend_end": 6.0})
    assert settings.changed({"gait": "turning"}).law() == turning(bend_start=4.0, bend_full=5.0)
    with pytest.raises(ValueError, match="bend_end must be > bend_full"):
        Settings(gait="turning").changed({"bend_full": 3.5}).changed({"gait": "falling"})
