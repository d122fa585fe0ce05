# SPDX-License-Identifier: Apache-2.0
"""The command `figures`: what is drawn is what was simulated, what the page says is what was read off, bad input."""

import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib
import numpy as np
import pytest
from eel_studies.figures import command, drawings, notes
from eel_studies.figures.readings import (
    OWN,
    PRINTED,
    READINGS,
    swim_kern,
    swim_readings,
    table_of_kern,
    table_of_readings,
)
from eel_studies.outputs import Outputs
from eel_studies.pictures import SETTINGS, letter_panels
from matplotlib.figure import Figure

from eel_dynamics import Body, simulate
from eel_gaits import straight

FOLDER = Path(__file__).resolve().parents[3] / "docs" / "figures"
in_repository = pytest.mark.skipif(not FOLDER.is_dir(), reason="the package is tested alone: there is no docs/figures")


@pytest.fixture(scope="module")
def readings():
    return swim_readings(accuracy="standard", sample_period=0.05, stations=41)


@pytest.fixture(scope="module")
def runs(readings):
    return readings[OWN], readings[PRINTED]


@pytest.fixture(scope="module")
def kern():
    return swim_kern()


def drawn(fill, *arguments):
    figure = Figure(layout="constrained")
    fill(figure, *arguments)
    return figure


def lines_of(axes):
    """The curves of `axes` (n, 2), without the line at zero, in the order they were drawn."""
    return [line.get_xydata() for line in axes.lines if len(line.get_xdata()) > 2]


def test_body_is_drawn_at_its_true_size():
    body = Body.boyer2010()
    side, above, sections = drawn(drawings.draw_body, SimpleNamespace(body=body)).axes
    for axes, half in ((side, body.half_height), (above, body.half_width)):
        outline = axes.collections[0].get_paths()[0].vertices
        assert np.all(np.abs(outline[:, 1]) <= half(np.clip(outline[:, 0], 0.0, 1.0)) + 1e-12)
        assert outline[:, 1].max() == pytest.approx(half(np.linspace(0.0, 1.0, 401)).max(), rel=1e-3)
        assert axes.get_aspect() == 1.0
    for patch, place in zip(sections.patches, drawings.SECTIONS, strict=True):
        width, height = np.ptp(patch.get_xy(), axis=0)
        assert width == pytest.approx(2.0 * body.half_width(place)) and height == pytest.approx(
            2.0 * body.half_height(place)
        )


def test_configurations_are_two_a_second(runs):
    run, _ = runs
    space, above, side, _bar = drawn(drawings.draw_configurations, run).axes
    assert len(space.lines) == len(lines_of(above)) == len(lines_of(side)) == 21
    for k, (seen_above, seen_side) in enumerate(zip(lines_of(above), lines_of(side), strict=True)):
        backbone = run.backbone[10 * k, ::2]
        assert np.array_equal(seen_above, backbone[:, :2]) and np.array_equal(seen_side, backbone[:, [0, 2]])
        assert np.array_equal(np.array(space.lines[k].get_data_3d()).T, backbone)


def test_wrench_curves_are_those_of_the_runs(runs):
    station, sample = 20, 140  # X = 0.5 m, t = 7 s
    assert runs[0].x[station] == pytest.approx(0.5) and runs[0].time[sample] == pytest.approx(7.0)
    along = drawn(drawings.draw_wrench_along_the_body, *runs).axes
    in_time = drawn(drawings.draw_wrench_in_time, *runs).axes
    for panel, (field, column) in enumerate((("force", 0), ("torque", 1), ("torque", 2))):
        for k, run in enumerate(runs):
            values = getattr(run, field)[..., column]
            assert np.array_equal(lines_of(along[panel])[k], np.column_stack((run.x, values[sample])))
            assert np.array_equal(lines_of(in_time[panel])[k], np.column_stack((run.time, values[:, station])))


def test_head_velocity(runs):
    run, printed = runs
    for axes, column in zip(drawn(drawings.draw_head_velocity, run, printed).axes, (3, 0), strict=True):
        for curve, each in zip(lines_of(axes), runs, strict=True):
            assert np.array_equal(curve[:, 1], each.twist[:, column])


def test_maps_of_the_torque_cover_run_and_body(runs):
    run, _ = runs
    maps = [each for each in drawn(drawings.draw_torque, run).axes if each.get_ylabel().endswith("tail")]
    for plane, column in zip(maps, (1, 2), strict=True):
        assert plane.get_xlim() == (0.0, 10.0) and plane.get_ylim() == (1.0, 0.0)  # nose at the top
        size = np.abs(run.torque[..., column]).max()
        assert plane.collections[0].get_clim() == pytest.approx((-size, size))


def test_ledger_curves_close(runs):
    run, _ = runs
    power, work, residual = drawn(drawings.draw_ledger, run).axes
    names = ("actuator", "drag", "wake", "nose")
    for name, curve in zip(names, lines_of(power), strict=True):
        assert np.array_equal(curve[:, 1], run.energy[f"{name}_power"])
    *works, kinetic = (curve[:, 1] for curve in lines_of(work))
    left = np.abs(kinetic - kinetic[0] - sum(works))
    assert np.nanmax(np.abs(lines_of(residual)[0][:, 1] - left)) < 1e-12


def test_readings_do_what_their_physics_says(readings):
    own, perimeter, blended, laminar, mass, printed = readings.values()
    speed = own.analysis().mean_speed
    assert own.scene.added_mass == "corrected"
    assert perimeter.analysis().mean_speed > 1.05 * speed  # half the friction
    assert laminar.analysis().mean_speed > perimeter.analysis().mean_speed  # less than a third of it
    assert np.linalg.norm(blended.position[-1] - own.position[-1]) < 0.02  # the jump is smoothed, hardly shifted
    assert own.position[-1, 2] < -2.0 < -0.5 < mass.position[-1, 2]  # without tail there is no dive
    assert mass.greatest_torque()[0] < 0.6 * own.greatest_torque()[0]
    assert printed.scene.perimeter == printed.scene.added_mass == "printed"
    table = table_of_readings(readings).rows
    apart = np.linalg.norm(printed.position[-1] - own.position[-1])
    assert len(table) == len(READINGS)
    assert table[0][2:4] == ("0.000", f"{speed:.3f}") and table[-1][2] == f"{apart:.3f}"


def test_kern_body_and_gaits(kern):
    fast, efficient = kern
    assert Body.kern2006().volume == pytest.approx(0.0059326, abs=5e-8)  # L^3, the digits published
    assert fast.mean_speed / efficient.mean_speed - 1.0 == pytest.approx(0.42, abs=0.15)  # soft: see the page
    assert fast.propulsive_efficiency < efficient.propulsive_efficiency
    assert fast.hydromechanical_efficiency < efficient.hydromechanical_efficiency
    for analysis in kern:
        assert 2e3 < analysis.reynolds < 5e3 and 0.4 < analysis.strouhal < 0.8
    speed, *_ = table_of_kern(*kern).rows
    assert speed[3] == f"{fast.stride / efficient.stride - 1.0:+.1%}" and speed[1] == f"{fast.stride:.4g}"


@in_repository
def test_page_names_every_figure_and_takes_its_numbers_from_the_runs(readings, kern, runs, tmp_path):
    control = simulate(straight())
    shutil.copy(FOLDER / "README.md", tmp_path)
    outputs = outputs_in(tmp_path)
    outputs.page = tmp_path / "README.md"
    said = []
    for other in (control, runs[0]):
        outputs.write({}, notes.values_of(readings, other, kern[0]))
        said.append(outputs.page.read_text())
    page, other = (re.sub("<!--[a-z_]+-->|<!--/-->", "", each) for each in said)
    assert set(re.findall(r"\]\((\w+)\.svg\)", page)) == set(command.FIGURES)
    x, y, z = runs[0].position[-1]
    assert f"({x:+.2f}, {y:+.2f}, {z:+.2f}) m" in " ".join(page.split())
    assert "nan" not in page and "None" not in page
    assert f"ends at y = {control.position[-1, 1]:+.2f} m" in " ".join(page.split())
    assert f"ends at y = {y:+.2f} m" in " ".join(other.split())


@in_repository
def test_kept_figures_are_small_and_complete():
    names = {f"{name}.{suffix}" for name in command.FIGURES for suffix in command.FORMATS[:2]}
    assert {path.name for path in FOLDER.iterdir()} == names | {"README.md", "corrections.csv", "kern.csv"}
    for name in names:
        assert (FOLDER / name).stat().st_size < (300e3 if name.endswith("svg") else 200e3), name


@in_repository
def test_kept_page_tells_of_these_runs(readings):
    with (FOLDER / "corrections.csv").open(newline="") as file:
        rows = {label: " ".join(cells) for label, *cells in csv.reader(file)}
    for label, run in readings.items():
        numbers = [float(number) for number in re.findall(r"[-+]?\d+\.\d+", rows[label])]
        apart = np.linalg.norm(run.position[-1] - readings[OWN].position[-1])
        expected = [*run.position[-1], apart, run.analysis().mean_speed, run.greatest_torque()[0]]
        # the kept one is of more samples, and sees a higher peak of the torque
        assert numbers[:6] == pytest.approx(expected, abs=1e-2), "docs/figures is out of date: run figures"


def test_files_are_written_and_alike(readings, tmp_path, monkeypatch):
    monkeypatch.setattr(command, "FIGURES", {name: command.FIGURES[name] for name in ("figure5_body", "torque")})
    (tmp_path / "again").mkdir()
    for columns, suffix in ((None, "png"), (None, "svg"), (1, "pdf")):
        for folder in (tmp_path, tmp_path / "again"):
            command.draw(outputs_in(folder), readings, (suffix,), columns)
        first, second = ((folder / f"torque.{suffix}").read_bytes() for folder in (tmp_path, tmp_path / "again"))
        assert first == second and (tmp_path / f"figure5_body.{suffix}").exists()  # the same drawing is the same file
    assert (tmp_path / "torque.png").read_bytes().startswith(b"\x89PNG")


def outputs_in(folder):
    return Outputs("eel figures", SimpleNamespace(out=folder, page=None))


def test_a_figure_is_as_wide_as_a_journal_s_column_or_page(readings):
    for columns, wide in ((None, 6.8), (1, 3.4), (2, 7.0)):
        sizes = {}
        draw = lambda name, title, fill, size, *others, sizes=sizes: sizes.update({name: size})  # noqa: E731
        command.draw(SimpleNamespace(draw=draw), readings, columns=columns)
        assert sizes["figure8_wrench_in_time"][0] == wide and sizes["figure5_body"][0] == 7.0


def test_panels_have_letters_and_colour_bars_none():
    figure = Figure()
    above, below = figure.subplots(2, 1)
    figure.colorbar(above.imshow([[0.0, 1.0]]), ax=above)
    letter_panels(figure)
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["(a)", "(b)", ""]
    assert below.get_title(loc="left") == "(b)"
    alone = Figure()
    letter_panels(alone.subplots().figure)
    assert alone.axes[0].get_title(loc="left") == ""


@pytest.mark.parametrize("columns", [None, 1])
def test_every_letter_of_a_panel_lies_within_its_figure(columns, readings):
    def check(name, title, draw, size, suffixes, settings):
        figure = Figure(figsize=size, layout="constrained")
        with matplotlib.rc_context(SETTINGS | (settings or {})):
            draw(figure)
            figure.draw_without_rendering()
        letters = [text for axes in figure.axes for text in [axes._left_title] if text.get_text()]
        assert [text.get_text() for text in letters] == [f"({letter})" for letter in "abcdef"[: len(letters)]]
        page = figure.bbox
        for text in letters:
            box = text.get_window_extent()
            assert page.x0 <= box.x0 and page.y0 <= box.y0 and box.x1 <= page.x1 and box.y1 <= page.y1, (name, text)
        seen.append(len(letters))

    seen = []
    command.draw(SimpleNamespace(draw=check), readings, ("png",), columns)
    assert len(seen) == len(command.FIGURES) and max(seen) >= 3


def test_bad_input(tmp_path, capsys):
    occupied = tmp_path / "file"
    occupied.write_text("")
    assert command.main(["--out", str(occupied)]) == 2
    for accuracy in ("splendid", "1e-12"):
        assert command.main(["--out", str(tmp_path / "new" / "folder"), "--accuracy", accuracy]) == 2
        assert not (tmp_path / "new").exists()
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 3 and "file" in said[0] and "splendid" in said[1] and "1e-12" in said[2]
    with pytest.raises(SystemExit):
        command.main(["--format", "gif"])


def test_says_when_matplotlib_is_missing(tmp_path):
    code = "import sys; sys.modules['matplotlib'] = None\n"
    code += "from eel_studies.figures.command import main; sys.exit(main())"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "eel_studies[pictures]" in done.stderr and len(done.stderr.splitlines()) == 1
    assert os.listdir(tmp_path) == []


def test_library_does_not_import_matplotlib():
    code = "import sys, eel_dynamics, eel_studies.figures.command; assert 'matplotlib' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
