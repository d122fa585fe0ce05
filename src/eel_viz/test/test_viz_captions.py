# SPDX-License-Identifier: Apache-2.0
"""What the words of the run say of colours is what is drawn."""

import colorsys

import pytest
from eel_viz.recording.run_text import look_text
from eel_viz.scene3d import colours
from eel_viz.settings import Settings

HUES = {  # degrees, of colours that are neither grey nor white
    "red": (345, 375),
    "orange": (20, 40),
    "brown": (20, 40),
    "yellow": (45, 65),
    "lime": (65, 110),
    "green": (140, 180),
    "blue": (180, 250),
    "violet": (250, 285),
    "magenta": (310, 345),
}


def word_of(colour: colours.Colour) -> set[str]:
    """The words that a colour may be called by."""
    hue, saturation, value = colorsys.rgb_to_hsv(*(channel / 255.0 for channel in colour))
    if saturation < 0.2:
        return {"white"} if value > 0.9 else {"grey"}
    fitting = {word for word, (low, high) in HUES.items() if low <= (360.0 * hue - low) % 360.0 + low <= high}
    return fitting - ({"brown"} if value > 0.75 else {"orange"})


def test_the_words_beside_the_swimmer_say_the_colours_of_the_scene():
    said = look_text(Settings()).lower()
    for words, colour in (
        ("red and blue on its flanks: the torque **c3**", colours.DIVERGING[-64]),
        ("blue on its flanks: the torque **c3**", colours.DIVERGING[64]),
        ("magenta at nose and tail", colours.ENDS),
        ("violet ribbon: what the tail leaves in the **wake**", colours.WAKE),
        ("white arrow", colours.NOTE),
    ):
        assert words in said and words.split()[0] in word_of(colour)
    assert word_of(colours.FIN) == {"lime"} and word_of(colours.LOADS[-1]) == {"red"}


@pytest.mark.parametrize(("limit", "words"), [(0.0, "of the last 3 s"), (0.25, "up to 0.25 N m")])
def test_the_words_say_what_the_scale_of_the_torque_is(limit, words):
    assert f"on the scale {words} below the picture" in look_text(Settings(colour_limit=limit))
