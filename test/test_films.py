# SPDX-License-Identifier: Apache-2.0
"""Filmed swimmers swim: with a motion that is known, and a lamprey as its data were published."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from eel_dynamics.commands.filmed import speeds_of
from eel_dynamics.commands.simulate import main as simulate_command
from eel_gaits.film.beat import beat_of
from eel_gaits.film.film import Film, read_film
from filmed import ARC, TIMES, WAVE, beat_without, hidden, swimming, write_long, write_sleap
from life import main as life

from eel_dynamics import Body, Scene, simulate

ROOT = Path(__file__).resolve().parents[1]
LAMPREY = ROOT / "docs" / "data" / "lamprey_midlines.csv"
HINGES = sorted(LAMPREY.parent.glob("tendon_fish_hinges_*.csv"))
PLANAR = Scene(planar=True, friction="blended", internal_wrench=False)


def test_a_noisy_film_swims_as_fast_as_the_motion_that_was_filmed():
    beat = beat_of(Film("fish.csv", TIMES, swimming(noise=3e-3), ()))
    body = Body.kern2006()
    (found,) = speeds_of([beat], body, PLANAR)
    true = simulate(WAVE, "settled", body=body, scene=PLANAR, accuracy=1e-2).mean_speed
    assert found == pytest.approx(true, rel=0.05)  # the noise is 6 % of the points' distance


@pytest.mark.parametrize("path", [LAMPREY, *HINGES], ids=lambda path: path.stem)
def test_published_films_are_not_doubted(path):
    assert beat_of(read_film(path), rigid=0.64 if path in HINGES else 0.0).doubts == []


def speed_told(path, capsys):
    """Speed, and its band, that the command tells of a film in px."""
    options = ["--units", "px", "--scale", "1e-3", "--rate", "50", "--scene", "planar=on", "--accuracy", "1e-2"]
    assert simulate_command(["--midlines", str(path), *options]) == 0
    told = capsys.readouterr().out
    return told, [float(each) for each in re.search(r"speed +([0-9.]+) m/s, ([0-9.]+) to ([0-9.]+) m/s", told).groups()]


@pytest.mark.soak
def test_two_points_that_a_tracker_lost_in_a_third_of_the_frames_leave_the_speed(tmp_path, capsys):
    points, draw = 1e3 * swimming(noise=1e-3, arc=ARC), np.random.default_rng(6)
    scores = np.full(points.shape[:2], 0.9)
    scores[np.ix_(draw.choice(80, 28, replace=False), [5, 6])] = 0.05
    nonsense = points + draw.normal(scale=80.0, size=points.shape) * (scores < 0.5)[..., None]
    _, (whole, _, _) = speed_told(write_sleap(tmp_path / "whole.csv", {"": points}), capsys)
    told, (speed, low, high) = speed_told(write_sleap(tmp_path / "lost.csv", {"": nonsense}, scores=scores), capsys)
    assert "56 of 640 points have a likelihood below 0.6 and count as missing: part5, part6" in told
    assert low < whole < high and speed == pytest.approx(whole, rel=0.01)


@pytest.mark.soak
@pytest.mark.parametrize("kind", ["scattered", "two in a row, often", "one for long", "bursts"])
def test_bands_hold_the_speed_of_the_whole_film_over_forty_random_losses(tmp_path, kind):
    points, draw, held = swimming(noise=1e-3, arc=ARC), np.random.default_rng(8), 0
    body = Body.kern2006()
    (true,) = speeds_of(
        [beat_without(tmp_path / "whole.csv", points, np.zeros(points.shape[:2], dtype=bool))], body, PLANAR
    )
    for _ in range(40):
        beat = beat_without(tmp_path / "gaps.csv", points, hidden(kind, draw))
        speed, *others = speeds_of([beat, *beat.others], body, PLANAR)
        held += abs(speed - true) <= beat.half_band(others)
    assert held >= 37


def test_the_lamprey_swims_from_its_file_as_it_was_published(capsys):
    assert simulate_command(["--midlines", str(LAMPREY), "--units", "mm", "--accuracy", "1e-2"]) == 0
    told = capsys.readouterr().out
    assert re.search(r"period 0\.26\d* \+- \d\.\d+ s \(95 %\), 6 beats, 1 harmonic kept", told)
    assert "2 of 80 frames left out: empty" in told and re.search(r"residual \d\.\d+ mm \(RMS\)", told)
    share = float(re.search(r"([0-9.]+)% of the variance", told)[1])
    assert 85.0 < share < 92.0
    speed, low, high = map(float, re.search(r"speed +([0-9.]+) m/s, ([0-9.]+) to ([0-9.]+) m/s by the", told).groups())
    measured = float(re.search(r"beside the film +([0-9.]+) m/s measured", told)[1])
    assert low < speed < high and measured == pytest.approx(0.270, abs=0.003)  # as its authors' data give
    by_count = [
        float(each) for each in re.search(r"speed by harmonics +(.*) m/s", told)[1].replace(",", "").split()[1::2]
    ]
    assert len(by_count) == 5 and np.ptp(by_count) < 0.05 * speed


def test_options_of_films_need_a_film_and_a_body_its_length(tmp_path, capsys):
    for option, value in (("--units", "mm"), ("--points", "snout,tail")):
        assert simulate_command(["straight", option, value]) == 2
    assert "belong to --midlines, which is not given" in capsys.readouterr().err
    path = str(write_long(tmp_path / "fish.csv", 0.2 * swimming()))
    assert simulate_command(["--midlines", path, "--body", "boyer2010"]) == 2
    assert "is 1 m long, the swimmer in the film 0.1999 m" in capsys.readouterr().err
    assert simulate_command(["--midlines", path, "--file", path]) == 2
    assert "--midlines takes the place of a gait" in capsys.readouterr().err


@pytest.mark.parametrize("name", sorted(each.name for each in LAMPREY.parent.glob("tendon_fish_hinges_*.csv")))
def test_the_films_of_a_robot_with_close_markers_are_read(name):
    found = read_film(LAMPREY.with_name(name))
    assert found.names[:2] == ("0", "1") and len(found.names) >= 6


def test_a_film_without_measurements_in_thick_water_has_none_beside_it(tmp_path, capsys):
    film, widths = tmp_path / "own_fish.csv", LAMPREY.with_name("widths.csv")
    shutil.copy(LAMPREY, film)
    arguments = ["lamprey", str(film), "--widths", str(widths), "--out", str(tmp_path / "own_fish.png")]
    assert life(arguments) == 0
    told = capsys.readouterr().out
    assert "viscosity" not in told and "own_fish.csv: points 1, 2, 3" in told
    (tmp_path / "own_fish_thick_water.csv").write_text("times_viscosity,speed_mm_s\n1,221\n")
    assert life(arguments) == 2
    assert "own_fish_thick_water.csv': speeds in thick water must have the columns" in capsys.readouterr().err


def test_the_lamprey_is_held_against_its_measured_speed_as_a_band(tmp_path, capsys):
    table, picture = tmp_path / "lamprey.csv", tmp_path / "lamprey.png"
    widths = LAMPREY.with_name("widths.csv")
    arguments = ["lamprey", str(LAMPREY), "--widths", str(widths), "--out", str(table), "--out", str(picture)]
    assert life(arguments) == 0
    rows = {line.partition(",")[0]: line for line in table.read_text().splitlines()}
    low, high = map(float, rows["speed [m/s]"].split(",")[2].split(" to "))
    assert 0.26 < low < high < 0.33  # m/s: what the page says, within the grids of other processors
    assert "-42%" in rows["fall at 10 x viscosity"] and picture.read_bytes().startswith(b"\x89PNG")
    assert "head's yaw" in capsys.readouterr().out
