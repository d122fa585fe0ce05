# SPDX-License-Identifier: Apache-2.0
"""Filmed swimmers beside what was measured: known drag comes out, and files are told what they lack."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from eel_gaits.film.beat import Beat, beat_of
from eel_gaits.film.film import Film
from eel_gaits.laws.law import Law
from eel_gaits.laws.term import Term
from eel_studies.life.command import main as life
from eel_studies.life.command import table_of_robot
from eel_studies.life.lamprey import lamprey, wave_of
from eel_studies.life.leave_out import PLANAR, choices, computed

from eel_dynamics import Body, simulate

X = np.linspace(0.0, 1.0, 41)
BODY = Body.spindle(1.0, 8.0)


def beat(period: float, *, nose_drag: float = 0.036) -> Beat:
    """The beat of a film of a swim with this drag of the nose, filmed when it has settled."""
    law = Law(Term(amplitude=(1.0, 2.0, 4.0), knots=(0.0, 0.5, 1.0), wavelength=0.8, period=period))
    body = BODY.changed(nose_drag=nose_drag)
    run = simulate(law, 20.0 * period, body=body, scene=PLANAR, accuracy=1e-2, sample_period=period / 16.0, stations=21)
    last = run.time > 14.0 * period
    return beat_of(Film("film.csv", run.time[last], run.backbone[last, :, :2], ()))


def test_drag_that_a_swim_had_is_found_and_predicts_the_other_swim():
    beats = [beat(0.5, nose_drag=2.0), beat(0.8, nose_drag=2.0)]
    measured = np.array([each.measured.speed for each in beats])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a guess far away has not settled at the end
        guessed = computed(beats, BODY)
        found = choices(beats, BODY, {"nose_drag": 0.5}, 1)
    assert np.all(guessed > 1.05 * measured)  # nothing fitted: the drag is too small
    for each in found:
        assert each.values["nose_drag"] == pytest.approx(2.0, rel=0.1)
        assert len(each.left_out(measured)) == 1
        assert np.max(np.abs(each.left_out(measured))) < 0.02 * np.max(measured)
    table = table_of_robot(beats, guessed, found)
    assert len(table.rows) == 5 and table.rows[2][1].endswith("*") and not table.rows[2][2].endswith("*")


def test_a_wave_as_it_was_is_the_beat_and_more_waves_are_more_waves():
    found = beat(0.5)
    law, same = found.law(1.0), wave_of(found, 1.0, found.period, 1.0)
    bends = [[each.curvature(t, X)[0][:, 2] for t in np.linspace(0.0, 0.5, 9)[:-1]] for each in (law, same)]
    apart = np.subtract(*bends)
    assert np.max(np.abs(apart - apart.mean(axis=0))) < 0.02 * np.max(np.abs(bends))  # without the mean bend
    more = wave_of(found, 1.0, 0.5, 1.5)
    turns = [np.unwrap(np.angle(_harmonic(each, 0.5)))[[4, 36]] for each in (same, more)]
    assert np.diff(turns[1]) / np.diff(turns[0]) == pytest.approx(1.5, rel=0.02)


def _harmonic(law: Law, period: float) -> np.ndarray:
    times = period * np.arange(16) / 16.0
    return np.exp(-2j * np.pi * times / period) @ [law.curvature(t, X)[0][:, 2] for t in times]


def test_a_lamprey_has_its_widths_and_its_fin(tmp_path):
    path = tmp_path / "widths.csv"
    path.write_text("s_by_length,lamprey_width_by_length\n0,0.016\n0.3,0.019\n1,0.001\n")
    body = lamprey(0.154, 0.03, path)
    assert body.half_width(0.3 * 0.154) == pytest.approx(0.019 * 0.154, rel=0.02)
    assert body.half_height(0.95 * 0.154) == pytest.approx(0.03 * 0.154, rel=1e-3)
    assert 0.4 < body.mass / (1000.0 * 0.154**3 * np.pi * 0.017**2) < 1.5
    path.write_text("s,width\n0,0.016\n1,0.001\n")
    with pytest.raises(ValueError, match=r"widths.csv.*columns s_by_length, lamprey_width_by_length"):
        lamprey(0.154, 0.03, path)


def test_the_command_says_what_it_lacks(tmp_path, capsys):
    rows = beat(0.5).film
    film = tmp_path / "film.csv"
    lines = [f"{t},{x},{y}" for t, frame in zip(rows.time, rows.points, strict=True) for x, y in frame]
    film.write_text("\n".join(["time_s,x_m,y_m", *lines]))
    for arguments, words in (
        (["lamprey", str(film)], "lamprey takes one film, and the --widths"),
        (["robot", str(film), "--fit", "1"], "robot needs more films than the 1 that --fit takes, got 1"),
        (["lamprey", str(tmp_path / "none.csv")], "there is no such file"),
    ):
        assert life(arguments) == 2
        assert words in capsys.readouterr().err


def test_a_scene_and_numbers_of_the_body_change_the_swim():
    beats = [beat(0.5)]
    as_it_is = computed(beats, BODY)
    thick = replace(PLANAR, viscosity=1e-4)
    assert computed(beats, BODY, thick)[0] < 0.95 * as_it_is[0]
    assert computed(beats, BODY, replace(thick, friction="taylor"))[0] < 0.95 * computed(beats, BODY, thick)[0]
    assert computed(beats, BODY, PLANAR, lateral_added_mass=0.5)[0] < as_it_is[0]
