# SPDX-License-Identifier: Apache-2.0
"""Films that lie are told, with the names of the points; good films are not."""

import numpy as np
import pytest
from eel_gaits.film.beat import beat_of
from eel_gaits.film.film import Film, read_film
from filmed import TIMES, WAVE, swimming, write_sleap
from measured import midline_of

from eel_gaits import Law, Term

ARC = np.linspace(0.0, 1.0, 10)
NAMES = tuple(f"p{place}" for place in range(10))
ASIDE = np.array([0.6, 0.8])  # across the way of `swimming` and along it


def doubts(points):
    return beat_of(Film("fish.csv", TIMES, points, (), NAMES)).doubts


def seen(seed=5):
    """A good film: errors of 2 % of the points' distance, which last for several frames."""
    return swimming(noise=2e-3, arc=ARC, seed=seed)


def read(tmp_path, points):
    path = write_sleap(tmp_path / "fish.csv", {"": 1e3 * points}, NAMES)
    return read_film(path, units="px", scale=1e-3, rate=50.0)


def test_good_films_are_not_doubted():
    for seed in range(6):
        assert doubts(seen(seed)) == []
    nearer = swimming(noise=2e-3, arc=ARC) * (1.0 + 0.2 * TIMES / TIMES[-1])[:, None, None]  # to the camera
    assert doubts(nearer) == []


@pytest.mark.parametrize("first", [5, 7])
def test_a_tail_that_is_moved_as_a_whole_is_told(first):
    points = seen()
    points[:, first:] += 0.08 * ASIDE
    (told,) = [text for text in doubts(points) if "as a whole" in text]
    assert told.startswith(f"{', '.join(NAMES[first:])} moved as a whole against {', '.join(NAMES[:first])}")
    assert f"from p{first - 1} to p{first}" in told


def test_points_that_stand_aside_where_the_body_hardly_bends_are_told():
    flat = Law(Term(amplitude=(0.0, 0.0, 6.0), knots=(0.0, 0.5, 1.0), wavelength=0.7, period=0.26))
    points = np.array([midline_of(flat, time, ARC) for time in TIMES])
    points[:, 2:, 1] += 0.07
    assert any("p2" in text and "askew by" in text and "from p1 to p2 alone" in text for text in doubts(points))


def test_a_point_that_slips_along_the_body_is_told():
    points, part = seen(), np.linspace(0.0, 0.6, len(TIMES))[:, None]
    points[:, 4] += part * (points[:, 5] - points[:, 4])
    (told,) = doubts(points)
    assert told.startswith("p4 slipped along the body: the distance from p3 to p4 changes by")


def test_points_that_are_off_for_some_frames_are_told():
    points = seen()
    points[10:16, 5:7] += 0.06 * (points[10:16, 5:6] - points[10:16, 4:5]) / 0.11
    points[50:56, 5:7] += 0.06 * (points[50:56, 5:6] - points[50:56, 4:5]) / 0.11
    moved = "p5, p6, p7, p8, p9 moved as a whole against p0, p1, p2, p3, p4: the distance from p4 to p5 changes by"
    assert any(text.startswith(moved) for text in doubts(points))


def test_two_trackers_that_slip_together_are_told():
    points = seen()
    middle, part = 0.5 * (points[:, 6] + points[:, 7]), np.linspace(0.0, 0.7, len(TIMES))[:, None]
    for place in (6, 7):
        points[:, place] += part * (middle - points[:, place])
    assert any("p6, p7 slipped along the body" in text for text in doubts(points))


@pytest.mark.parametrize(("one", "other"), [(0, 1), (4, 5), (3, 6), (8, 9)])
def test_points_that_were_exchanged_for_a_time_are_put_back_and_told(tmp_path, one, other):
    points = seen()
    wrong = points.copy()
    wrong[20:40, [one, other]] = points[20:40, [other, one]]
    found = read(tmp_path, wrong)
    assert f"p{one} and p{other} were exchanged in 20 frames: put back" in found.notes
    assert np.allclose(found.points, points, atol=1e-9)


def bent(turn):
    """A film of a body that is bent by 0.6 rad in the mean, and turns by `turn` [rad] in a beat."""
    law, found = WAVE + Law(Term(amplitude=(0.6,), phase=0.5 * np.pi)), []
    for time in TIMES:
        angle = turn * time / 0.26
        matrix = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        found.append((midline_of(law, time, ARC) - 0.5) @ matrix.T - 1.9 * time * np.array([1.0, 0.0]))
    return np.array(found)


def test_a_bent_body_that_swims_straight_on_is_told_and_one_that_turns_is_not():
    (told,) = doubts(bent(0.0))
    assert "the body is bent by 0.4" in told and "from p1 to p8, yet turns by" in told
    assert doubts(bent(0.6)) == []


def test_doubts_are_printed_and_named_where_a_film_is_refused():
    points = seen()
    points[:, 5:] += 0.08 * ASIDE
    lines = beat_of(Film("fish.csv", TIMES, points, (), NAMES)).about()
    assert any(name == "doubtful" and "moved as a whole" in text for name, text in lines)
    points = seen()
    points[20:40, [4, 5]] = points[20:40, [5, 4]]
    with pytest.raises(ValueError, match=r"does not repeat.*; p4, p5 fold the line back in 20 of 80 frames: exchanged"):
        beat_of(Film("fish.csv", TIMES, points, (), NAMES))
