# SPDX-License-Identifier: Apache-2.0
"""`eel compare`: the measures of two runs, their difference, a picture."""

import pytest
from eel_dynamics.model.body.body import Body
from eel_studies.comparison.command import main

from eel_dynamics import simulate
from eel_gaits import straight


@pytest.fixture
def kept(tmp_path):
    """A file with a run of 1.5 s in a light body."""
    simulate(straight(), 1.5, body=Body.boyer2010().changed(lateral_drag=1.0), accuracy=1e-2).save(tmp_path / "run.nc")
    return tmp_path / "run.nc"


def rows_of(text: str) -> dict[str, list[str]]:
    return {line.split()[0]: line.split()[1:] for line in text.splitlines()}


def test_a_gait_swims_in_the_body_and_time_of_the_file(kept, capsys):
    assert main([str(kept), "straight", "--accuracy", "1e-2"]) == 0
    rows = rows_of(capsys.readouterr().out)
    assert rows["duration"][:2] == ["1.5", "1.5"]
    assert rows["head_x"][0] == rows["head_x"][1] and float(rows["head_x"][2]) == 0.0  # the same swim


def test_the_difference_is_that_of_the_second_from_the_first(capsys):
    assert main(["straight", "turning", "--set", "period=0.7", "--duration", "2", "--accuracy", "1e-2"]) == 0
    first, second, change, relative, unit = rows_of(capsys.readouterr().out)["actuator_work"]
    assert float(change) == pytest.approx(float(second) - float(first), rel=1e-2) and unit == "J"
    assert float(relative.rstrip("%")) == pytest.approx(100.0 * float(change) / float(first), abs=0.1)


def test_a_picture_of_both(kept, tmp_path, capsys):
    assert main([str(kept), str(kept), "--out", str(tmp_path / "pair.png")]) == 0
    assert (tmp_path / "pair.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    "words, told",
    [
        (["straight", "turnin"], "unknown gait 'turnin' (did you mean 'turning'?)"),
        (["straight", "no.nc"], "no.nc"),
        (["straight", "turning", "--out", "pair.gif"], "--out must end in .rrd, .png, .svg or .pdf, got 'pair.gif'"),
    ],
)
def test_bad_input_is_one_line(words, told, capsys):
    assert main([*words, "--duration", "0.1"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("eel compare: ") and told in said and said.count("\n") == 1
