# SPDX-License-Identifier: Apache-2.0
"""Points that were not seen: the beat of a film with gaps is that of the whole film."""

from dataclasses import replace

import numpy as np
import pytest
from eel_gaits.film.beat import beat_of
from eel_gaits.film.film import read_film
from filmed import ARC, COUNT, beat_without, hidden, swimming, write_sleap


@pytest.mark.parametrize("kind", ["scattered", "two in a row, often", "one for long", "bursts"])
def test_what_is_hidden_hardly_changes_the_beat_whose_band_holds_the_change(tmp_path, kind):
    points, draw = swimming(noise=1e-3, arc=ARC), np.random.default_rng(4)
    whole = beat_without(tmp_path / "whole.csv", points, np.zeros((COUNT, len(ARC)), dtype=bool))
    for _ in range(2):
        lost = hidden(kind, draw)
        beat = beat_without(tmp_path / "gaps.csv", points, lost)
        filled = np.sum(beat.film.missing)
        assert any(note.startswith(f"{filled} of ") for note in beat.film.notes) and filled > 20
        apart = np.hypot(*(beat.curvature - whole.curvature)[1:3]) / np.max(np.hypot(*whole.curvature[1:3]))
        assert np.mean(apart) < 1.5 * beat.band and np.mean(apart) < 0.05
        assert beat.band > 0.8 * whole.band


def test_bands_are_wider_like_an_error_by_the_root_of_the_segments_that_were_seen(tmp_path):
    lost = hidden("two in a row, often", np.random.default_rng(4))
    beat = beat_without(tmp_path / "gaps.csv", swimming(noise=1e-3, arc=ARC), lost)
    plain = replace(beat, film=beat.film._replace(missing=None)).band
    unseen = np.mean(beat.film.missing[:, 1:] | beat.film.missing[:, :-1])
    assert unseen > 0.1 and beat.band / plain == pytest.approx(1.0 / np.sqrt(1.0 - unseen))


def test_a_point_lost_wherever_the_body_bends_most_is_put_back_by_the_beat(tmp_path):
    points = swimming(arc=ARC)
    lost = np.zeros((COUNT, len(ARC)), dtype=bool)
    bend = np.linalg.norm(points[:, 4] - 2.0 * points[:, 5] + points[:, 6], axis=1)
    lost[bend > np.quantile(bend, 0.6), 5] = True
    beat = beat_without(tmp_path / "gaps.csv", points, lost)
    straight = 0.5 * (points[:, 4] + points[:, 6])
    assert np.max(np.linalg.norm((points[:, 5] - straight)[lost[:, 5]], axis=1)) > 0.02
    found = beat.film.points - points
    assert np.max(np.linalg.norm(found[:, 5], axis=1)) < 0.004


@pytest.mark.parametrize("end", [0, -1])
def test_an_end_that_is_mostly_lost_does_not_make_the_animal_shorter(tmp_path, end):
    lost = np.zeros((COUNT, len(ARC)), dtype=bool)
    lost[np.arange(COUNT) % 5 > 1, end] = True
    found = beat_without(tmp_path / "gaps.csv", swimming(arc=ARC), lost).film
    assert found.points.shape[:2] == (COUNT * 2 // 5, 8) and found.length > 0.97


@pytest.mark.soak
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("seed", range(150))
def test_any_film_gives_a_beat_or_a_sentence(tmp_path, seed):
    draw = np.random.default_rng(seed)
    count, frames = int(draw.choice([5, 8, 20])), int(draw.choice([12, 40, COUNT, COUNT]))
    points = swimming(noise=1e-3, arc=np.linspace(0.0, 1.0, count))
    points[frames:] = np.nan
    points += draw.normal(scale=10.0 ** draw.uniform(-5.0, 0.0), size=points.shape)
    points[draw.random(points.shape[:2]) < draw.choice([0.0, 0.1, 0.3, 0.9])] = np.nan
    points[:, draw.integers(count)] = draw.choice([np.nan, 0.0, 1.0]) * points[:, draw.integers(count)]
    owner = draw.integers(0, 3, COUNT) if draw.random() < 0.5 else np.arange(COUNT) * 3 // COUNT
    tracks = {name: np.where((owner == place)[:, None, None], 1e3 * points, np.nan) for place, name in enumerate("abc")}
    path = write_sleap(tmp_path / "fish.csv", tracks, scores=draw.random((COUNT, count)) ** 0.2)
    try:
        beat = beat_of(read_film(path, units="px", scale=1e-3, rate=50.0), rigid=float(draw.choice([0.0, 0.5])))
        assert np.all(np.isfinite(beat.film.points)) and beat.about()
    except ValueError as error:
        assert "\n" not in str(error) and "fish.csv" in str(error)
