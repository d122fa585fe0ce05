# SPDX-License-Identifier: Apache-2.0
"""What trackers do to a film: points they are not sure of, and names that change."""

import numpy as np
import pytest
from eel_gaits.film.film import read_film
from filmed import (
    TIMES,
    swimming,
    with_scores,
    write_deeplabcut,
    write_deeplabcut_h5,
    write_sleap,
    write_sleap_h5,
)
from measured import write

PIXELS = {"units": "px", "scale": 1e-3, "rate": 50.0}
PARTS = [f"part{place}" for place in range(20)]


def doubted():
    """Points of a fish in px, of which a tenth are nonsense, and their scores."""
    points, draw = 1e3 * swimming(), np.random.default_rng(3)
    low = np.zeros(points.shape[:2], dtype=bool)
    low[10:40, 7] = low[draw.choice(80, 20, replace=False), 13] = True
    return np.where(low[..., None], points + draw.normal(scale=60.0, size=points.shape), points), np.where(
        low, 0.1, 0.8
    )


@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("dlc.csv", lambda path, animals, scores: write_deeplabcut(path, animals, scores)),
        ("dlc.h5", lambda path, animals, scores: write_deeplabcut_h5(path, animals, "table", scores)),
        ("sleap.csv", lambda path, animals, scores: write_sleap(path, animals, scores=scores)),
        ("sleap.h5", lambda path, animals, scores: write_sleap_h5(path, animals, PARTS, scores=scores)),
        (
            "turned.h5",
            lambda path, animals, scores: write_sleap_h5(
                path, animals, PARTS, ["frame", "track", "node", "xy"], scores
            ),
        ),
    ],
)
def test_points_that_a_tracker_doubts_count_as_missing_in_all_forms(tmp_path, name, write):
    points, scores = doubted()
    found = read_film(write(tmp_path / name, {"": points}, scores), **PIXELS)
    assert "50 of 1600 points have a likelihood below 0.6 and count as missing: part7, part13" in found.notes
    assert np.array_equal(found.missing, scores < 0.6)
    trusted = read_film(tmp_path / name, **PIXELS, likely=0.05)
    assert not any("likelihood" in note for note in trusted.notes)
    with pytest.raises(ValueError, match="likely must be <= 1, got 3"):
        read_film(tmp_path / name, **PIXELS, likely=3.0)
    with pytest.raises(ValueError, match="likely must be a number, got 'x'"):
        read_film(tmp_path / name, **PIXELS, likely="x")


@pytest.mark.parametrize("name", ["part{}_likelihood", "score.part{}", "part{}_confidence"])
def test_scores_beside_named_points_count_too(tmp_path, name):
    points, scores = doubted()
    heads = [each for part in range(20) for each in (f"part{part}_x", f"part{part}_y", name.format(part))]
    rows = [[frame, *row] for frame, row in enumerate(with_scores(points, scores).reshape(80, -1).tolist())]
    found = read_film(write(tmp_path / "flat.csv", ("frame", *heads), rows), **PIXELS)
    assert np.array_equal(found.missing, scores < 0.6) and any("part7, part13" in note for note in found.notes)


def test_points_without_a_score_are_seen(tmp_path):
    points = 1e3 * swimming()
    found = read_film(write_sleap(tmp_path / "by_hand.csv", {"": points}, scores=np.full((80, 20), np.nan)), **PIXELS)
    assert not found.notes and np.allclose(found.points, 1e-3 * points)


def cut(points, *frames):
    """The points of the fish in these frames alone."""
    return np.where(np.isin(np.arange(len(TIMES)), np.concatenate(frames))[:, None, None], points, np.nan)


def test_one_animal_under_successive_names_is_joined_and_told(tmp_path):
    points = 1e3 * swimming()
    whole = np.arange(80)
    names = {"fish_3": cut(points, whole[:25]), "fish_7": cut(points, whole[27:50]), "": cut(points, whole[50:])}
    found = read_film(write_sleap(tmp_path / "sleap.csv", names), **PIXELS)
    assert any("'fish_3', 'fish_7', ''" in note and "joined" in note for note in found.notes)
    assert len(found.time) == 78 and np.allclose(found.points, 1e-3 * points[np.delete(whole, [25, 26])])
    nonsense = names | {"elsewhere": cut(points + 900.0, whole[25:27])}
    found = read_film(write_sleap(tmp_path / "nonsense.csv", nonsense), **PIXELS)
    assert "animal 'fish_3', 'fish_7', '' taken, left out: 'elsewhere'" in found.notes and len(found.time) == 78
    flicker = {"a": cut(points, whole[::2]), "b": cut(points, whole[1::2])}
    assert len(read_film(write_sleap(tmp_path / "flicker.csv", flicker), **PIXELS).time) == 80


def test_of_two_animals_that_share_no_frame_the_longer_seen_counts_and_is_told(tmp_path):
    points, whole = 1e3 * swimming(), np.arange(80)
    two = {"small": cut(points + 900.0, whole[:20]), "large": cut(points, whole[20:])}
    for path in (write_sleap(tmp_path / "s.csv", two), write_deeplabcut(tmp_path / "d.csv", two)):
        found = read_film(path, **PIXELS)
        assert "animal 'large' taken, left out: 'small'" in found.notes
        assert np.allclose(found.points, 1e-3 * points[20:])
        assert len(read_film(path, **PIXELS, animal="small").time) == 20


def test_animals_that_share_frames_need_a_choice_of_tracks(tmp_path):
    points, whole = 1e3 * swimming(), np.arange(80)
    four = {
        "a": cut(points, whole[:41]),
        "b": cut(points + 900.0, whole[:39]),
        "c": cut(points + 900.0, whole[39:]),
        "d": cut(points, whole[41:]),
    }
    path = write_sleap(tmp_path / "sleap.csv", four)
    with pytest.raises(ValueError, match="it has 4 animals, 'a', 'b', 'c', 'd': say which one"):
        read_film(path, **PIXELS)
    found = read_film(path, **PIXELS, animal="a, d")
    both = {"a": cut(points, whole[:41]), "d": cut(points + 3.0, whole[40:])}
    handed_over = read_film(write_sleap(tmp_path / "handed_over.csv", both), **PIXELS, animal="a,d")
    assert len(handed_over.time) == 80 and np.allclose(handed_over.points[40], 1e-3 * points[40])
    assert len(found.time) == 80 and np.allclose(found.points, 1e-3 * points)
    with pytest.raises(ValueError, match="there is no animal 'e', there are: 'a', 'b', 'c', 'd'"):
        read_film(path, **PIXELS, animal="a,e")


@pytest.mark.parametrize("form", ["likelihood0 beside x0", "a row for each point", "a row for each point by number"])
def test_scores_count_in_all_forms_of_columns(tmp_path, form):
    points, scores = doubted()
    values, path = with_scores(points, scores), tmp_path / "fish.csv"
    if form == "likelihood0 beside x0":
        heads = [f"{what}{part}" for part in range(20) for what in ("x", "y", "likelihood")]
        write(path, ("frame", *heads), [[frame, *row] for frame, row in enumerate(values.reshape(80, -1).tolist())])
    else:
        named = form.endswith("number")
        rows = [
            (frame, *([f"part{place}"] if named else []), *row)
            for frame, rows in enumerate(values.tolist())
            for place, row in enumerate(rows)
        ]
        write(path, ("frame", *(["point"] if named else []), "x", "y", "likelihood"), rows)
    found = read_film(path, **PIXELS)
    assert np.array_equal(found.missing, scores < 0.6) and any("50 of 1600" in note for note in found.notes)


def test_scores_that_are_not_read_or_are_in_percent_are_told(tmp_path):
    points, scores = doubted()
    with pytest.raises(ValueError, match=r"fish.csv.*must be from 0 to about 1, got 80: in percent\?"):
        read_film(write_deeplabcut(tmp_path / "fish.csv", {"": points}, 100.0 * scores), **PIXELS)
    heads = [f"{axis}{part}" for part in range(20) for axis in "xy"]
    rows = [[frame, *row, 0.9] for frame, row in enumerate(1e3 * swimming().reshape(80, -1))]
    path = write(tmp_path / "flat.csv", ("frame", *heads, "likelihood"), rows)
    assert "no scores from ['likelihood'], which name no point" in read_film(path, **PIXELS).read
    with pytest.raises(ValueError, match=r"flat.csv.*no likelihoods or scores of its points: likely has no place"):
        read_film(path, **PIXELS, likely=0.6)


@pytest.mark.parametrize(("animal", "chance"), [(None, 0.01), ("a,b", 0.01), ("a,b", 0.9)])
def test_a_track_that_is_lost_at_low_likelihood_makes_way_for_the_next(tmp_path, animal, chance):
    points, whole = 1e3 * swimming(), np.arange(80)
    tracks = {"a": np.where((whole < 40)[:, None, None], points, points[40]), "b": points}
    path, rows = write_deeplabcut(tmp_path / "fish.csv", tracks), []
    for row in path.read_text().splitlines():
        cells = row.split(",")
        if cells[0].isdigit():
            lost = 1 if int(cells[0]) >= 40 else 61
            cells[lost + 2 : lost + 60 : 3] = [str(chance), *["0.01"] * 19]
        rows.append(",".join(cells))
    path.write_text("\n".join(rows))
    found = read_film(path, **PIXELS, animal=animal)
    assert len(found.time) == 80 and np.allclose(found.points, 1e-3 * points)
    assert any("tracks 'a', 'b' joined" in note for note in found.notes)


def test_a_track_of_low_likelihood_is_named_or_refused(tmp_path):
    points = 1e3 * swimming()
    path = write_deeplabcut(tmp_path / "low.csv", {"": points}, np.full((80, 20), 0.1))
    with pytest.raises(ValueError, match=r"low.csv.*all its points are missing or have a likelihood below 0.6"):
        read_film(path, **PIXELS)
