# SPDX-License-Identifier: Apache-2.0
"""The command `figures`: what is drawn is what was simulated, what the page says is what was read off, bad input."""

import os
import re
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import matplotlib
import numpy as np
import pytest
from eel_studies.figures import (
    command,
    corrections,
    further_drawings,
    kern_comparison,
    notes,
    orders,
    paper_drawings,
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
    return corrections.swim(accuracy="standard", sample_period=0.05, stations=41)


@pytest.fixture(scope="module")
def runs(readings):
    by_label = {row.label: row.run for row in readings}
    return by_label[corrections.OWN], by_label[corrections.PRINTED]


@pytest.fixture(scope="module")
def comparison():
    return kern_comparison.compare()


@pytest.fixture(scope="module")
def errors():
    """Of one evaluation as measured; in time made up, for the drawing and the page."""
    steps = np.array([0.01, 0.02, 0.04])
    made_up = {drag: orders.ConvergenceErrors(steps, steps**4, 3.0 * steps**4) for drag in (False, True)}
    return {"in_space": {drag: orders.in_space(drag) for drag in (False, True)}, "in_time": made_up}


def drawn(fill, *arguments):
    figure = Figure(layout="constrained")
    fill(figure, *arguments)
    return figure


def lines_of(axes):
    """The curves of `axes` (n, 2), without the line at zero, in the order they were drawn."""
    return [line.get_xydata() for line in axes.lines if len(line.get_xdata()) > 2]


def test_body_is_drawn_at_its_true_size():
    body = Body.boyer2010()
    side, above, sections = drawn(paper_drawings.draw_body, SimpleNamespace(body=body)).axes
    for axes, half in ((side, body.half_height), (above, body.half_width)):
        outline = axes.collections[0].get_paths()[0].vertices
        assert np.all(np.abs(outline[:, 1]) <= half(np.clip(outline[:, 0], 0.0, 1.0)) + 1e-12)
        assert outline[:, 1].max() == pytest.approx(half(np.linspace(0.0, 1.0, 401)).max(), rel=1e-3)
        assert axes.get_aspect() == 1.0
    for patch, place in zip(sections.patches, paper_drawings.SECTIONS, strict=True):
        width, height = np.ptp(patch.get_xy(), axis=0)
        assert width == pytest.approx(2.0 * body.half_width(place)) and height == pytest.approx(
            2.0 * body.half_height(place)
        )


def test_configurations_are_two_a_second(runs):
    run, _ = runs
    space, above, side, _bar = drawn(paper_drawings.draw_configurations, run).axes
    assert len(space.lines) == len(lines_of(above)) == len(lines_of(side)) == 21
    for k, (seen_above, seen_side) in enumerate(zip(lines_of(above), lines_of(side), strict=True)):
        backbone = run.backbone[10 * k, ::2]
        assert np.array_equal(seen_above, backbone[:, :2]) and np.array_equal(seen_side, backbone[:, [0, 2]])
        assert np.array_equal(np.array(space.lines[k].get_data_3d()).T, backbone)


def test_wrench_curves_are_those_of_the_runs(runs):
    station, sample = 20, 140  # X = 0.5 m, t = 7 s
    assert runs[0].x[station] == pytest.approx(0.5) and runs[0].time[sample] == pytest.approx(7.0)
    along = drawn(paper_drawings.draw_wrench_along_the_body, *runs).axes
    in_time = drawn(paper_drawings.draw_wrench_in_time, *runs).axes
    for panel, (field, column) in enumerate((("force", 0), ("torque", 1), ("torque", 2))):
        for k, run in enumerate(runs):
            values = getattr(run, field)[..., column]
            assert np.array_equal(lines_of(along[panel])[k], np.column_stack((run.x, values[sample])))
            assert np.array_equal(lines_of(in_time[panel])[k], np.column_stack((run.time, values[:, station])))


def test_head_velocity_and_path(runs):
    run, printed = runs
    for axes, column in zip(drawn(paper_drawings.draw_head_velocity, run, printed).axes, (3, 0), strict=True):
        for curve, each in zip(lines_of(axes), runs, strict=True):
            assert np.array_equal(curve[:, 1], each.twist[:, column])
    for axes, column in zip(drawn(further_drawings.draw_head_path, run).axes, (1, 2), strict=True):
        head, centre, seconds = lines_of(axes)
        assert np.array_equal(head, run.position[:, [0, column]])
        assert np.array_equal(seconds, run.position[::20, [0, column]])
        assert centre[-1] == pytest.approx(run.center_of_mass[-21:-1, [0, column]].mean(axis=0))


def test_torque_surface_covers_run_and_body(runs):
    run, _ = runs
    axes = drawn(further_drawings.draw_torque_surface, run).axes
    maps = [each for each in axes if each.get_ylabel().endswith("tail")]
    spaces = [each for each in axes if hasattr(each, "zaxis")]
    for plane, space, column in zip(maps, spaces, (1, 2), strict=True):
        assert plane.get_xlim() == (0.0, 10.0) and plane.get_ylim() == (1.0, 0.0)  # nose at the top
        size = np.abs(run.torque[..., column]).max()
        assert plane.collections[0].get_clim() == pytest.approx((-size, size))
        assert space.get_zlim() == pytest.approx((-size, size), rel=0.1)


def test_ledger_curves_close(runs):
    run, _ = runs
    power, work, residual = drawn(further_drawings.draw_ledger, run).axes
    names = ("actuator", "drag", "wake", "nose")
    for name, curve in zip(names, lines_of(power), strict=True):
        assert np.array_equal(curve[:, 1], run.energy[f"{name}_power"])
    *works, kinetic = (curve[:, 1] for curve in lines_of(work))
    left = np.abs(kinetic - kinetic[0] - sum(works))
    assert np.nanmax(np.abs(lines_of(residual)[0][:, 1] - left)) < 1e-12


def test_convergence_curves(errors):
    by_nodes, by_step = drawn(further_drawings.draw_convergence, None, None, errors).axes
    curves = iter(lines_of(by_nodes))
    for drag in (False, True):
        for name in ("motion", "torque"):
            assert np.array_equal(next(curves)[:, 1], getattr(errors["in_space"][drag], name))
    assert len(by_step.lines) == 5 and by_step.get_yscale() == "log"


def test_measured_orders(errors):
    smooth, kinked = errors["in_space"][False], errors["in_space"][True]
    fine = slice(notes.FINE, None)
    assert smooth.order("motion", fine) < -5.5 and smooth.order("torque", fine) < -5.5  # the Magnus series has order 6
    assert kinked.motion[-1] < 1e-11  # the kinks of V|V| are located
    steps = np.array([0.01, 0.02, 0.04])
    assert orders.ConvergenceErrors(steps, 7.0 * steps**3, steps**5).order("motion") == pytest.approx(3.0)


def test_order_in_time_is_that_of_the_method():
    measured = orders.in_time(False, duration=1.5)
    assert measured.order("motion") == pytest.approx(4.0, abs=0.2)
    assert measured.order("torque") == pytest.approx(4.0, abs=0.3)  # also of the stations' shape, and of fewer digits


def test_corrections_do_what_their_physics_says(readings):
    own, perimeter, blended, laminar, mass, printed = readings
    assert own.apart == 0.0 and own.run.scene.added_mass == "corrected"
    assert perimeter.mean_speed > 1.05 * own.mean_speed  # half the friction
    assert laminar.mean_speed > perimeter.mean_speed  # less than a third of it
    assert blended.apart < 0.02  # the jump is smoothed, hardly shifted
    assert own.run.position[-1, 2] < -2.0 < -0.5 < mass.run.position[-1, 2]  # without tail there is no dive
    assert mass.run.greatest_torque()[0] < 0.6 * own.run.greatest_torque()[0]
    assert printed.run.scene.perimeter == printed.run.scene.added_mass == "printed"
    table = corrections.table_of(readings).splitlines()
    assert len(table) == 2 + len(corrections.READINGS)
    assert f"| {own.mean_speed:.3f} |" in table[2] and f"| {printed.apart:.3f} |" in table[-1]


def test_kern_body_and_gaits(comparison):
    assert comparison.volume == pytest.approx(kern_comparison.VOLUME, abs=5e-8)  # the digits published
    assert comparison.faster == pytest.approx(kern_comparison.PUBLISHED_FASTER, abs=0.15)  # soft: see the page
    assert comparison.less("propulsive_efficiency") > 0.0 and comparison.less("hydromechanical_efficiency") > 0.0
    for analysis in (comparison.fast, comparison.efficient):
        assert 2e3 < analysis.reynolds < 5e3 and 0.4 < analysis.strouhal < 0.8
    table = kern_comparison.table_of(comparison)
    assert f"| {comparison.faster:+.1%} |" in table and f"| {comparison.fast.stride:.3f} |" in table
    assert all(line.count("|") == 5 for line in table.splitlines())


@in_repository
def test_page_names_every_figure_and_takes_its_numbers_from_the_runs(readings, comparison, errors, runs, tmp_path):
    control = simulate(straight())
    shutil.copy(FOLDER / "README.md", tmp_path)
    outputs = outputs_in(tmp_path)
    outputs.page = tmp_path / "README.md"
    said = []
    for other in (control, runs[0]):
        outputs.write(notes.parts_of(readings, comparison), notes.values_of(readings, other, comparison, errors))
        said.append(outputs.page.read_text())
    page, other = (re.sub("<!-- [a-z_]+ -->|<!-- / -->", "", each) for each in said)
    assert set(re.findall(r"\]\((\w+)\.svg\)", page)) == set(command.FIGURES)
    x, y, z = runs[0].position[-1]
    assert f"({x:+.2f}, {y:+.2f}, {z:+.2f}) m" in " ".join(page.split())
    assert "nan" not in page and "None" not in page
    assert f"ends at y = {control.position[-1, 1]:+.2f} m" in " ".join(page.split())
    assert f"ends at y = {y:+.2f} m" in " ".join(other.split())


@in_repository
def test_kept_figures_are_small_and_complete():
    names = {f"{name}.{suffix}" for name in command.FIGURES for suffix in command.FORMATS}
    assert {path.name for path in FOLDER.iterdir()} == names | {"README.md"}
    for name in names:
        assert (FOLDER / name).stat().st_size < (300e3 if name.endswith("svg") else 200e3), name


@in_repository
def test_kept_page_tells_of_these_runs(readings):
    rows = (FOLDER / "README.md").read_text().splitlines()
    for reading in readings:
        (row,) = (row for row in rows if row.startswith(f"| {reading.label} |"))
        numbers = [float(number) for number in re.findall(r"[-+]?\d+\.\d+", row.removeprefix(f"| {reading.label} |"))]
        expected = [*reading.run.position[-1], reading.apart, reading.mean_speed, reading.run.greatest_torque()[0]]
        # the kept one is of more samples, and sees a higher peak of the torque
        assert numbers[:6] == pytest.approx(expected, abs=1e-2), "docs/figures is out of date: run figures"


def test_files_are_written(readings, errors, tmp_path):
    outputs = outputs_in(tmp_path)
    some = ("figure5_body", "figure9_head_velocity", "head_path")
    links = command.draw(outputs, some, readings, errors, ["png"])
    assert len(links) == 3 and links[0].endswith("figure5_body.png)")
    assert all((tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG") for name in some)
    for columns, suffix in ((None, "svg"), (1, "pdf")):
        first, second = (drawing_of(outputs, readings, errors, suffix, columns) for _ in "ab")
        assert first == second  # the same drawing is the same file


def outputs_in(folder):
    return Outputs("eel figures", SimpleNamespace(out=folder, page=None))


def drawing_of(outputs, readings, errors, suffix, columns):
    command.draw(outputs, ["figure5_body"], readings, errors, [suffix], columns)
    return (outputs.folder / f"figure5_body.{suffix}").read_bytes()


def test_a_figure_is_as_wide_as_a_journal_s_column_or_page():
    assert command.size_of("figure8_wrench_in_time", 1)[0] == 3.4
    assert command.size_of("figure8_wrench_in_time", 2)[0] == 7.0
    assert command.size_of("torque_surface", 1)[0] == 7.0  # panels side by side
    assert command.size_of("head_path", None) == command.FIGURES["head_path"][1:]


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
def test_every_letter_of_a_panel_lies_within_its_figure(columns, readings, errors):
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
    command.draw(SimpleNamespace(draw=check), command.FIGURES, readings, errors, ["png"], columns)
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


def test_errors_fall_with_more_points(errors):
    smooth = errors["in_space"][False].motion
    assert all(after < before for before, after in pairwise(smooth[3:]))
