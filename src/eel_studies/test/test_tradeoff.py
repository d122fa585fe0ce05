# SPDX-License-Identifier: Apache-2.0
"""The measured trade: errors against a converged run, fronts, poorer models, and what the command leaves behind."""

from dataclasses import replace
from io import BytesIO
from itertools import combinations
from pathlib import Path
from shutil import copyfile
from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.model.initial_state import AT_REST
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.runs.swim import Swim
from eel_studies.pictures import spread
from eel_studies.reference import front, reference_of
from eel_studies.tradeoff import measuring, report
from eel_studies.tradeoff.command import main
from eel_studies.tradeoff.measuring import ASKED_FOR, REFERENCE, settings
from eel_studies.tradeoff.report import draw_trade
from matplotlib.figure import Figure
from matplotlib.text import Text

from eel_dynamics import Accuracy, Body, Robot, Scene, SimulationStopped, simulate
from eel_gaits import falling, straight

DOCS = Path(__file__).resolve().parents[3] / "docs"
BODY = Body.boyer2010()
COARSE = Accuracy(name="coarse", resolution=8.0, tolerance=1e-2)
MIDDLE = Accuracy(name="middle", resolution=36.0, tolerance=1e-5)
EXACT = Accuracy(name="exact", resolution=110.0, tolerance=1e-8)
FIXED = Accuracy(name="fixed", resolution=36.0, step=0.02)


def swim_of(law, scene=None, duration=2.5):
    return Swim(law, BODY, scene or Scene(), REFERENCE, duration=duration)


@pytest.fixture(scope="module")
def trade():
    return measuring.measure(measuring.bare(swim_of(falling())), [COARSE, MIDDLE, EXACT, FIXED], repeats=2)


def test_errors_are_those_of_the_definition(trade):
    row = trade.rows[0]
    run, reference = trade.rows[0].run, trade.reference
    later = reference.time >= 1.25
    apart = np.linalg.norm(run.position - reference.position, axis=1)[later].max()
    assert row.position == apart / 1.0  # the path is shorter than the body
    sizes = np.linalg.norm(reference.torque, axis=2)
    assert row.torque == pytest.approx(np.linalg.norm(run.torque - reference.torque, axis=2).max() / sizes.max())
    alone = simulate(falling(), 2.5, body=BODY, accuracy=COARSE)
    assert np.array_equal(alone.position[-1], run.position[-1])  # the switches that cost nothing change nothing


def test_finer_is_more_exact_and_the_reference_has_converged(trade):
    coarse, middle, exact, _ = trade.rows
    assert coarse.error > 10.0 * middle.error > 100.0 * exact.error / 2.0
    assert trade.reference_error < 0.1 * exact.error
    assert coarse.run.evaluations < middle.run.evaluations < exact.run.evaluations
    assert coarse.run.nodes < middle.run.nodes < exact.run.nodes
    for row in trade.rows:
        assert row.seconds > 0.0 and row.times_real_time == pytest.approx(2.5 / row.seconds)


def test_times_and_nodes_are_of_the_run_whose_errors_are_told(trade):
    for row in trade.rows:
        timed = trade.swim.simulation(accuracy=row.accuracy, stations=2)
        timed.advance(2.5)
        assert row.run.nodes == len(timed.grid.x)
        assert timed.evaluations[2] == row.run.evaluations
        assert np.array_equal(timed.head.position, row.run.position[-1])


def test_front_holds_what_nothing_beats():
    rows = [SimpleNamespace(e=e, c=c) for e, c in ((1.0, 1.0), (0.5, 2.0), (0.6, 3.0), (0.5, 2.5), (0.1, 9.0))]
    found = front(rows, lambda row: row.e, lambda row: row.c)
    assert [(row.e, row.c) for row in found] == [(1.0, 1.0), (0.5, 2.0), (0.1, 9.0)]


def test_a_model_without_a_term_is_as_far_off_as_its_swim(trade):
    assert trade.terms["third dimension"].torque > 0.1  # the gait bends in pitch
    other = simulate(falling(), 2.5, scene=Scene(wake=False), accuracy=REFERENCE, estimate=False)
    assert trade.terms["wake"].position == pytest.approx(relative_errors(other, trade.reference).position, rel=1e-3)


def test_tables_have_the_front_and_all_settings(trade):
    lines = report.trade_table(trade, everything=True).markdown().splitlines()
    assert len(lines) == 2 + 4 and all(line.count("|") == len(report.COLUMNS) + 2 for line in lines)
    marked = [line.split("|")[2].strip() for line in lines if line.startswith("| * |")]
    assert marked == [row.accuracy.name for row in trade.front()]
    digits = report.digits_table(trade).rows
    assert [row[1] for row in digits if row[1] != "-"] and digits[0][1] == report.cheapest(trade)[0].accuracy.name


def test_a_setting_that_diverges_is_told_apart():
    light = Scene(density=10.0, reactive=False)
    long = Accuracy(name="long steps", resolution=10.0, step=0.05)
    trade = measuring.measure(measuring.bare(swim_of(straight(), light, 0.5)), [COARSE, long], repeats=1)
    assert trade.unstable == [long] and [row.accuracy for row in trade.rows] == [COARSE]


def test_a_dear_scene_gets_fewer_settings(monkeypatch):
    many, rounds = measuring.affordable(measuring.bare(swim_of(straight())), False, 2)
    assert rounds == 2 and len(many) > 300
    monkeypatch.setattr(measuring, "MOST_SECONDS", 0.0)
    few, rounds = measuring.affordable(measuring.bare(swim_of(straight())), False, 2)
    assert rounds == 1 and [each.name for each in few] == [*ASKED_FOR]


def test_a_robot_has_settings_of_its_one_method():
    robot = swim_of(straight()).changed(robot=Robot.named("passive_tail"))
    found = settings(robot)[: -len(ASKED_FOR)]
    assert {each.method for each in found} == {"dormand_prince", "classical"}
    assert len({(each.resolution, each.tolerance, each.step) for each in found}) == len(found)


def test_a_budget_of_time_takes_the_most_exact_that_keeps_to_it(trade):
    seconds = [row.seconds for row in trade.rows]
    best, asked = trade.within(1.001 * max(seconds) / 2.5)
    assert best.error == min(row.error for row in trade.rows) and asked is None
    best, _ = trade.within(1.001 * min(seconds) / 2.5)
    assert best.seconds == min(seconds)
    with pytest.raises(ValueError, match="1e-09 ms per second cannot be met here: the fastest run takes"):
        trade.within(1e-12)


def test_a_scene_that_is_too_sensitive_for_its_reference_is_said(monkeypatch):
    """Out of its plane the straight gait rolls over: the errors of any pair grow to the size of the body."""
    pair = (MIDDLE, Accuracy(name="other", resolution=50.0, tolerance=1e-6, method="adams", order=5))
    monkeypatch.setattr("eel_studies.reference.REFERENCES", (pair,))
    start = AT_REST._replace(twist=np.array([0.01, 0.0, 0.0, 0.0, 0.0, 0.0]))
    tumbling = Swim(straight(), BODY, Scene(), REFERENCE, start, duration=20.0, stations=5)
    run, apart = reference_of(tumbling, 1e-9)
    assert run.time[-1] == 20.0 and apart > 1e-5
    said = report.reference_line(SimpleNamespace(reference_error=apart, unstable=[]))
    assert said.startswith(f"Two methods on two grids agree to {apart:.0e}, where 1e-09 is wanted; smaller errors")
    long = Accuracy(name="long steps", resolution=10.0, step=0.05)
    monkeypatch.setattr("eel_studies.reference.REFERENCES", ((long, long),))
    with pytest.raises(SimulationStopped):
        reference_of(swim_of(straight(), Scene(density=10.0, reactive=False)), 1e-9)


def test_no_two_names_of_the_picture_overlap(trade):
    row = trade.rows[0]
    close = {f"target {k}": (1e-4 * (1.0 + 0.01 * k), 1.0 + 0.001 * k) for k in range(4)}
    asked = [
        replace(
            row, accuracy=replace(row.accuracy, name=name), position=error, torque=error, seconds=row.seconds * slow
        )
        for name, (error, slow) in close.items()
    ]
    named = {each.accuracy.name: "" for each in asked}
    figure = Figure(figsize=report.SIZE, layout="constrained")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(measuring, "ASKED_FOR", named)
        draw_trade(figure, replace(trade, rows=[*trade.rows, *asked]))
    figure.savefig(BytesIO())
    for axes in figure.axes:
        boxes = [Text.get_window_extent(text) for text in axes.texts]  # without arrows
        assert len(boxes) == len(trade.terms) + len(named) + 1
        for first, second in combinations(boxes, 2):
            assert not first.overlaps(second)
        assert all(axes.bbox.y0 <= box.y0 and box.y1 <= axes.bbox.y1 + 1.0 for box in boxes)


@pytest.mark.parametrize(
    "given, apart",
    [
        ([0.0, 3.0], [0.0, 3.0]),
        ([1.0, 1.0, 1.0], [0.0, 1.0, 2.0]),
        ([2.0, 0.2, 0.0], [2.0, 0.6, -0.4]),
    ],
)
def test_values_are_spread_with_the_least_movement(given, apart):
    assert spread(given, 1.0) == pytest.approx(apart)
    assert spread(given, 1.0, low=0.0).min() >= 0.0 and np.diff(np.sort(spread(given, 1.0, low=0.0))).min() > 1.0 - 1e-9
    assert len(spread([], 1.0)) == 0


def test_command_leaves_pictures_a_page_and_a_table(tmp_path, capsys):
    words = f"straight --quick --repeats 1 --duration 1 --csv --out {tmp_path}/images --page {tmp_path}/page.md"
    (tmp_path / "images").mkdir()
    assert main(words.split()) == 0
    said = capsys.readouterr().out
    for preset in ("draft", "standard", "fine", "reference"):
        assert preset in said
    for name in ("images/tradeoff_straight.png", "images/tradeoff_straight.svg"):
        assert (tmp_path / name).stat().st_size > 1500, name
    page = (tmp_path / "page.md").read_text()
    assert "](images/tradeoff_straight.png)" in page and page.count("\n| ") == 7 + 2
    lines = (tmp_path / "images" / "tradeoff_straight.csv").read_text().splitlines()
    assert len(lines) == 1 + len(settings(swim_of(straight()), quick=True))
    assert all(f" {name} " in said for name in ASKED_FOR)


@pytest.mark.parametrize(
    "words, named",
    [
        ("wriggling", "wriggling"),
        ("--set period", "period"),
        ("--set period=1 --set period=2 --quick", "period must be given once"),
        ("--repeats 0", "repeats"),
        ("--duration 0.01 --quick", "--duration must be >= 0.05 s, got 0.01"),
        ("--duration nan --quick", "duration must be"),
        ("--duration -1 --quick", "duration must be > 0 s, got -1.0"),
        ("--within 5 --quick", "--within must be a time above 0 such as '5 ms' (us, ms or s), got '5'"),
        ("--out /nowhere/at/all", "/nowhere/at/all"),
    ],
)
def test_bad_input_is_named(words, named, capsys):
    assert main(words.split()) == 2
    assert named in capsys.readouterr().err


@pytest.mark.skipif(not DOCS.is_dir(), reason="the package is tested alone: there is no docs")
def test_the_kept_page_is_written_anew_and_keeps_its_words(tmp_path):
    page = tmp_path / "tradeoff.md"
    copyfile(DOCS / "appendix/tradeoff.md", page)
    words = f"straight --quick --repeats 1 --duration 1 --page {page} --out {tmp_path}"
    assert main(words.split()) == 0
    text = page.read_text()
    assert "the scene <!--gait-->straight<!--/-->" in text and "](tradeoff_straight.png)" in text
