# SPDX-License-Identifier: Apache-2.0
"""The scripts in evidence/ run on their smallest case: `make evidence` writes the pages."""

import csv
import importlib
import re
from pathlib import Path as FilePath

import delivered
import drafting
import fault_table
import figures
import laws
import manoeuvres
import midlines
import numpy as np
import pytest
import report_tables
import robot_log
import robot_swims
import steering
from eel_gaits.gaits.registry import GAITS
from eel_gaits.pilot.goals import Path
from eel_gaits.pilot.settings import PilotSettings
from everything import SCRIPTS
from matplotlib.figure import Figure
from midline_files import kern_midline, write_midlines
from others.speed_chart import speed_chart
from studied import ballast, courses, cylinder, laws_of_swimming

ROOT = FilePath(__file__).resolve().parents[1]


def test_every_script_is_named_and_can_be_imported():
    scripts = {path.stem for path in (ROOT / "evidence").glob("*.py")} - {"everything"}
    assert scripts == set(SCRIPTS)
    for name in scripts:
        assert callable(importlib.import_module(name).main)


@pytest.mark.soak
def test_figures_of_the_paper(tmp_path):
    assert figures.main(["--accuracy", "draft", "--format", "png", "--out", str(tmp_path)]) == 0
    assert {path.stem for path in tmp_path.glob("*.png")} == set(figures.FIGURES)


def test_a_law_of_swimming(monkeypatch, tmp_path):
    monkeypatch.setattr(laws_of_swimming, "OF_SLIP", np.array([1e-4, 1e-8]))
    monkeypatch.setattr(laws_of_swimming, "BENDS", (0.1, 1.0))
    assert laws.main(["lighthill", "--out", str(tmp_path / "law.png"), "--out", str(tmp_path / "law.csv")]) == 0
    assert (tmp_path / "law.png").stat().st_size > 5000


@pytest.mark.soak
def test_steering(monkeypatch, tmp_path):
    monkeypatch.setattr(steering, "GAITS", dict([next(iter(ballast.GAITS.items()))]))
    monkeypatch.setattr(steering, "LOOKS", steering.LOOKS[:1])
    monkeypatch.setattr(steering, "SHOWN", (0.0, 0.01))
    assert steering.main(["--points", "2", "--out", str(tmp_path)]) == 0
    assert (tmp_path / "steering.png").stat().st_size > 5000


@pytest.mark.soak
def test_drafting(monkeypatch, tmp_path):
    monkeypatch.setattr(cylinder, "SETTLE", 3)
    monkeypatch.setattr(cylinder, "MEASURED", 2)
    monkeypatch.setattr(drafting, "SPACINGS", (1.0, 2.0))
    assert drafting.main(["--phases", "1", "--out", str(tmp_path)]) == 0
    assert (tmp_path / "drafting.png").is_file()


def test_the_street_comes_from_a_cylinder_ahead():
    """Between the rows the water follows the cylinder; as the caption has it, to the right."""
    axes = Figure().subplots()
    drafting._draw_street(axes, cylinder.Wake(1.0, 1.0))
    assert axes.get_xlabel().endswith("the cylinder is ahead, to the right")
    (arrows,) = [each for each in axes.collections if hasattr(each, "U")]
    middle = np.isclose(arrows.Y, 0.0, atol=0.03)
    assert middle.any() and np.mean(arrows.U[middle]) > 0.0


def test_a_robot_log_with_its_band(tmp_path, capsys):
    data, out = ROOT / "docs/data", tmp_path / "log.csv"
    words = f"{data}/amphibot_joints.csv --links 0.094x7 --section 0.0275,0.0165 --seen {data}/amphibot_leds.csv"
    words += " --joint-drag flush"
    assert robot_log.main([*words.split(), *f"--samples 1 --duration 1.5 --accuracy 1e-2 --out {out}".split()]) == 0
    assert "lateral_added_mass" in capsys.readouterr().out and "x_low" in out.read_text()


@pytest.mark.soak
def test_robots_swim_as_the_page_says():
    rows = {row[1]: row for row in robot_swims.amphibot()}
    before, after = rows["without the new terms"], rows["c_s 0, as its coasting says"]
    assert float(before[2]) == pytest.approx(0.755, rel=0.02)  # m/s; the target is 1e-2
    assert float(after[2]) == pytest.approx(0.597, rel=0.02) and 0.96 < float(after[4]) < 1.04
    film = robot_swims.beat("2.00")
    assert film.measured.speed == pytest.approx(0.2021, abs=1e-4)
    for finite, hung, other in ((True, False, 1.046), (True, True, 0.281)):  # m/s, of an independent planar code
        (speed,) = robot_swims.computed([film], robot_swims.tendon_fish(finite=finite, hung=hung))
        assert speed == pytest.approx(other, rel=0.06)


def test_midlines_come_out_as_they_went_in(tmp_path, capsys):
    path = write_midlines(tmp_path / "fish.csv", kern_midline, end=2.0)
    assert midlines.main(["--out", str(tmp_path / "fish.png"), str(path)]) == 0
    apart = float(re.search(r"midlines +([0-9.]+)% of the body's length apart", capsys.readouterr().out)[1])
    assert 0.0 < apart < 0.3 and (tmp_path / "fish.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.soak
def test_delivered(tmp_path):
    assert delivered.main(["--count", "2", "--seed", "3", "--out", str(tmp_path)]) == 0
    assert (tmp_path / "delivered.png").is_file()


def test_a_course_of_the_pilot():
    whole = courses.random_path(np.random.default_rng(7), PilotSettings())
    _, voyage = courses.swim_path(Path(whole.points[:1], whole.speed))
    assert len(voyage.misses) == 1 and voyage.misses[0] < 0.25


def test_the_page_of_manoeuvres_has_the_figures_of_a_swim_and_every_gait():
    swim, page = manoeuvres.Swim("c_start"), (ROOT / "docs/reference/manoeuvres.md").read_text()
    with (ROOT / "docs/reference/manoeuvres.csv").open(newline="") as file:
        *row, note = next(row for row in csv.reader(file) if row[0] == "c_start")
    assert row == swim.row() and f" | {' | '.join(row[-3:])} |" in page
    assert manoeuvres.NOTES["c_start"](swim, {"straight": swim}).split(";")[0] == note.split(";")[0]
    for name in GAITS:
        assert f"| [{name}](../images/manoeuvres/{name}.png) |" in page


@pytest.mark.parametrize("page", report_tables.BLOCKS)
def test_tables_are_those_of_the_newest_reports(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    assert report_tables.with_figures(text, report_tables.BLOCKS[page]) == text


def test_the_chart_of_speed_is_that_of_the_newest_reports():
    assert report_tables.CHART.read_text(encoding="utf-8") == speed_chart(report_tables.others())


def test_every_fault_is_told_once_below_a_heading_of_the_page():
    told, page = fault_table.faults(), fault_table.PAGE.read_text()
    assert {row.group for row in told} == set(fault_table.GROUPS)
    assert [heading for heading in fault_table.GROUPS.values() if f"- **{heading}**" not in page] == []
    assert len({row.fault for row in told}) == len(told)
