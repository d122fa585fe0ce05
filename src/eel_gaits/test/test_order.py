# SPDX-License-Identifier: Apache-2.0
"""Points of a film stand along the body in their order: what does not is refused by its names, and bodies that bend
hard are not."""

import re

import numpy as np
import pytest
from eel_gaits.film.beat import beat_of
from eel_gaits.film.film import read_film
from eel_gaits.sources.motion_file import read_midlines
from eel_gaits.sources.order import check_order
from filmed import TIMES, swimming, with_eyes_and_fins, write_deeplabcut, write_long, write_sleap
from measured import moved

PIXELS = {"units": "px", "scale": 1e-3, "rate": 50.0}
ARC = np.linspace(0.0, 1.0, 8)
BODY = ["snout", "p1", "p2", "p3", "p4", "p5", "p6", "tail"]


def sleap(path, names, noise=2e-3):
    """A film in which SLEAP's skeleton has the parts of these `names`, in this order."""
    parts = with_eyes_and_fins(1e3 * swimming(arc=ARC), ARC, reach=1e3)
    points = np.stack([parts[name] for name in names], axis=1)
    points = points + 1e3 * noise * np.random.default_rng(0).normal(size=points.shape)
    return write_sleap(path, {"": points}, names)


def bent(angle, *, arc=ARC, noise=0.0, gaps=0.0, seed=0):
    """Points (N, n, 2) of a body whose direction along it is angle(time, s) [rad] of arrays (N, 1), (1, 401)."""
    draw, s = np.random.default_rng(seed), np.linspace(0.0, 1.0, 401)
    turned = angle(TIMES[:, None], s[None])
    line = np.cumsum(np.stack((np.cos(turned), np.sin(turned)), axis=-1), axis=1) / len(s)
    points = np.array([moved(each, time) for each, time in zip(line, TIMES, strict=True)])
    points = points[:, np.round(400 * np.asarray(arc)).astype(int)]
    points = points + noise * draw.normal(size=points.shape)
    points[draw.random(points.shape[:2]) < gaps] = np.nan
    return points


def test_the_order_of_the_body_is_taken_and_told(tmp_path):
    found = read_film(sleap(tmp_path / "fish.csv", BODY), **PIXELS)
    assert found.names == tuple(BODY) and found.length == pytest.approx(1.0, rel=0.02)
    assert ("points", ", ".join(BODY)) in beat_of(found).about()


@pytest.mark.parametrize(
    ("names", "told"),
    [
        (["snout", "p2", "p1", *BODY[3:]], {"p1", "p2"}),
        ([*BODY[:6], "tail", "p6"], {"tail"}),
        (["p1", "snout", *BODY[2:]], {"snout"}),
        (["p4", "snout", "p2", "tail", "p1", "p5", "p3", "p6"], {"snout", "tail"}),
        (["snout", "left_eye", "right_eye", *BODY[1:]], {"left_eye", "right_eye"}),
        (["snout", "left_eye", *BODY[1:]], {"left_eye"}),
        ([*BODY[:4], "right_fin", *BODY[4:]], {"right_fin"}),
        ([*BODY, "left_fin", "right_fin"], {"left_fin", "right_fin"}),
        (
            ["snout", "left_eye", "right_eye", "p1", "left_fin", "right_fin", *BODY[2:]],
            {"left_eye", "right_eye", "left_fin", "right_fin"},
        ),
    ],
)
def test_points_out_of_order_or_beside_the_body_are_named_with_an_order_that_is_one(tmp_path, names, told):
    path = sleap(tmp_path / "fish.csv", names)
    with pytest.raises(ValueError) as error:
        read_film(path, **PIXELS)
    text, _, line = str(error.value).partition(": give the points along the body in their order, such as ")
    assert told <= set(re.findall(r"\w+", text))
    found = read_film(path, **PIXELS, points=line.strip('"').split(", "))
    assert found.names in (tuple(BODY), tuple(BODY[::-1]))
    assert beat_of(found).film.names == tuple(BODY)  # the wave tells the head


def test_any_other_order_of_the_body_is_refused(tmp_path):
    draw, points = np.random.default_rng(3), swimming(arc=ARC, noise=3e-3)
    for _ in range(100):
        order = draw.permutation(len(ARC))
        if list(order) in (sorted(order), sorted(order)[::-1]):
            continue
        with pytest.raises(ValueError, match="folds back at"):
            check_order(points[:, order], [BODY[each] for each in order], range(len(ARC)))


def test_rows_of_points_and_midlines_out_of_order_are_refused(tmp_path):
    points = swimming(noise=1e-3)
    points[:, [7, 8]] = points[:, [8, 7]]
    with pytest.raises(ValueError, match=r"fish.csv.*folds back at 8, 9: give the points along the body"):
        read_film(write_long(tmp_path / "fish.csv", points))
    text = write_long(tmp_path / "midlines.csv", points, numbered=False, factor=1.0).read_text()
    (tmp_path / "midlines.csv").write_text(text.replace("time_s,x_mm,y_mm", "time,x,y"))
    with pytest.raises(ValueError, match=r"midlines.csv.*folds back at 8, 9"):
        read_midlines(tmp_path / "midlines.csv")


def test_points_are_chosen_by_names_and_patterns(tmp_path):
    names = ["tail", "left_eye", *BODY[1:7], "snout"]
    path = sleap(tmp_path / "fish.csv", names)
    found = read_film(path, **PIXELS, points=["snout", "p*", "tail"])
    assert found.names == tuple(BODY)
    assert "points left out, as they are not among those given: left_eye" in found.notes
    for points, words in (
        (["snout", "belly"], "there is no point 'belly', there are: tail, left_eye, p1"),
        (["p*", "p2"], "points must be named once, got p2 twice"),
        (["snout", "tail"], "5 points in 16 frames or more, got 2 in 80"),
        (["snout", "p2", "p1", "p3", "p4", "p5", "p6"], "folds back at p2, p1"),
        ("snout,tail", "points must be a row of names, got 'snout,tail'"),
    ):
        with pytest.raises(ValueError, match=re.escape(words)):
            read_film(path, **PIXELS, points=points)


def test_deeplabcuts_parts_are_chosen_of_each_animal(tmp_path):
    points = 1e3 * swimming(arc=ARC)
    path = write_deeplabcut(tmp_path / "two.csv", {"a": points[:, ::-1], "b": points})
    found = read_film(path, **PIXELS, animal="b", points=[f"part{place}" for place in range(1, 8)])
    assert found.names == tuple(f"part{place}" for place in range(1, 8)) and np.allclose(
        found.points, 1e-3 * points[:, 1:]
    )


SHARP = {
    "a C-start of 3.3 rad in the middle of the film": lambda t, s: 3.3 * s * np.exp(-(((t - 0.8) / 0.2) ** 2)),
    "a body that stays bent by half a turn": lambda t, s: np.pi * s + 0.3 * s * np.cos(24.0 * (0.5 * s - t)),
    "an eel that bends by a right angle each way": lambda t, s: 1.5 * np.cos(2.0 * np.pi * (1.4 * s - t / 0.26)),
    "a joint that bends to one side": lambda t, s: (s > 0.5) * (1.2 + 0.4 * np.cos(24.0 * t)),
}


@pytest.mark.parametrize("what", SHARP)
@pytest.mark.parametrize("arc", [np.linspace(0.0, 1.0, 5), ARC, np.linspace(0.0, 1.0, 20), [0.0, 0.5, 1.0]])
def test_a_fish_that_bends_hard_stands_along_its_body(what, arc):
    for noise, gaps in ((0.0, 0.0), (0.01, 0.0), (0.005, 0.2)):
        points = bent(SHARP[what], arc=arc, noise=noise, gaps=gaps)
        check_order(points, [str(each) for each in arc], range(len(arc)), parts=True)


def test_two_points_on_one_another_do_not_fold(tmp_path):
    arc = np.sort([*ARC, 0.4, 0.4, 0.401])
    points = bent(SHARP["an eel that bends by a right angle each way"], arc=arc, noise=0.01)
    found = read_film(write_sleap(tmp_path / "fish.csv", {"": 1e3 * points}), **PIXELS)
    assert any("as they lie on the one ahead" in note for note in found.notes)
