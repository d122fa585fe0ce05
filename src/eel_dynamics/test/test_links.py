# SPDX-License-Identifier: Apache-2.0
"""Bodies of links, and bodies as texts: their hull numbers, what may follow a name or file, what is refused."""

import math

import numpy as np
import pytest
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.text import appendages_from_file, body_of

TEXT = "links length=1.62 number=9 half_width=0.05 half_height=0.055 joints=0.65 mass=7.2"


def test_links_have_their_hull_numbers_and_mass():
    body = Body.of_links(1.62, 9, half_width=0.05, half_height=0.055, joints=0.65, mass=7.2)
    assert (body.joint_drag, body.link_length) == (0.65, pytest.approx(0.18))
    assert (body.nose_drag, body.base_drag, body.round_added_mass) == (0.4, 0.2, 0.2)
    assert body.mass == pytest.approx(7.2) and body.half_height(0.0) == 0.055 and body.half_width(1.62) == 0.05
    assert body.nose_added_mass * body.nose[2] == pytest.approx(4.0 / (3.0 * math.pi) * math.sqrt(0.05 * 0.055))
    assert Body.of_links(1.0, 5, 0.03, 0.04, joints="flush").joint_drag == 0.0


def test_a_cap_and_an_edge_take_the_place_of_blunt_ends():
    body = Body.of_links(1.0, 5, 0.03, 0.04, joints=0, nose=0.05, tail=0.2)
    assert body.half_width(0.0) == body.half_height(0.0) == 0.0 and body.nose_drag == 0.036 and body.base_drag == 0.0
    assert body.half_width(0.05 * (1.0 - math.sqrt(0.75))) == pytest.approx(0.5 * 0.03)  # a quarter ellipse
    assert body.half_width(0.9) == pytest.approx(0.015) and body.half_height(0.9) == 0.04
    assert body.pointed_tail and body.kinks == (0.05, 0.8)


def test_a_text_gives_the_same_body_and_what_differs():
    body = body_of(TEXT)
    assert body == Body.of_links(1.62, 9, 0.05, 0.055, joints=0.65, mass=7.2, name=TEXT)
    assert body_of("boyer2010") == Body.boyer2010()
    assert body_of("boyer2010 base_drag=0.2").base_drag == 0.2
    changed = body_of("boyer2010 lateral_drag=by shape joints=0.3 link_length=0.1")
    assert changed.lateral_drag == "by shape" and changed.joint_drag == 0.3


def test_appendages_come_from_a_file_whose_name_may_hold_spaces(tmp_path):
    path = tmp_path / "two arms.csv"
    path.write_text("x,y,drag1,law\n0.1,0.05,0.001,\n0.2,,0.002,speed\n")
    first, second = body_of(f"boyer2010 appendages={path}").appendages
    assert (first.x, first.y, first.drag1, first.law) == (0.1, 0.05, 0.001, "axis")
    assert (second.y, second.drag1, second.law) == (0.0, 0.002, "speed")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("x,drag_1\n0.1,1\n", "column 'drag_1' (did you mean 'drag1'?) must be one of x, y, z"),
        ("y,drag1\n0.1,1\n", "it must have a column x"),
        ("x,drag1\n0.1,a\n", "line 2: drag1 must be a number, got 'a'"),
        ("x,drag1\n0.1,nan\n", "line 2: appendage drag1 must be finite, got nan"),
        ("x,drag1\n0.1,-1\n", "line 2: appendage drag1 must be >= 0"),
        ("x,drag1\n0.1,1,2\n", "line 2: a row must have 2 fields, as the header has, got 3"),
        ("x,law\n0.1,speeds\n", "line 2: appendage law must be one of axis, speed"),
        ("x\n" + "0.1\n" * 1001, "it must have 1000 rows at most"),
    ],
)
def test_a_file_of_appendages_that_does_not_fit_is_one_line(tmp_path, content, words):
    path = tmp_path / "arms.csv"
    path.write_text(content)
    with pytest.raises(ValueError) as error:
        appendages_from_file(path)
    assert words in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("links length=1 number=8 half_width=0.03 half_height=0.04", "body links must have joints.*flush.*0 to 0.87"),
        (TEXT.replace("0.65", "0.9"), "joints must be flush, or the drag coefficient .* got 0.9"),
        (TEXT.replace("0.65", "flash"), "joints must be flush.* got 'flash'"),
        (TEXT.replace("number=9", "number=2.5"), "number of links must be a whole number, 1 to 64, got 2.5"),
        (TEXT.replace("number=9", "number=0"), "number of links must be a whole number"),
        (TEXT + " nose=2", "body nose must be blunt, or a length above 0 and below half"),
        (TEXT + " mass=7", "each once, got 'mass=7'"),
        (TEXT + " lenght=7", "did you mean 'length'"),
        ("boyer2010 length=2", "body 'boyer2010' has no 'length'.*, it has: density"),
        ("boyer2010 joints=0.5", "joint_drag needs a link_length"),
        ("boyer2011", "body must be one of boyer2010, kern2006, links with its numbers, a file"),
        ("none.csv base_drag=1", "there is no such file"),
    ],
)
def test_a_text_that_does_not_fit_names_what_it_got(text, words):
    with pytest.raises(ValueError, match=words):
        body_of(text)


def test_joints_have_no_default():
    with pytest.raises(TypeError, match="joints"):
        Body.of_links(1.0, 8, 0.03, 0.04)
    assert np.isfinite(Body.of_links(1.0, 8, 0.03, 0.04, joints=0.87).joint_drag)
