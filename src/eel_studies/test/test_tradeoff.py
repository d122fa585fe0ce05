# SPDX-License-Identifier: Apache-2.0
"""The measured trade: errors against a converged run, fronts, poorer models, and what the command leaves behind."""

from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_studies.tradeoff import measuring, models, table
from eel_studies.tradeoff.command import main
from eel_studies.tradeoff.delivered import Trial, delivered_table
from eel_studies.tradeoff.drawing import _apart
from eel_studies.tradeoff.settings import REFERENCE, settings

from eel_dynamics import Accuracy, Body, Scene, simulate
from eel_gaits import falling, straight

BODY = Body.boyer2010()
COARSE = Accuracy(name="coarse", resolution=8.0, tolerance=1e-2)
MIDDLE = Accuracy(name="middle", resolution=36.0, tolerance=1e-5)
EXACT = Accuracy(name="exact", resolution=110.0, tolerance=1e-8)
FIXED = Accuracy(name="fixed", resolution=36.0, step=0.02)


@pytest.fixture(scope="module")
def trade():
    return measuring.measure(
        falling(), [COARSE, MIDDLE, EXACT, FIXED], duration=2.5, body=BODY, scene=Scene(), repeats=2
    )


@pytest.fixture(scope="module")
def poorer(trade):
    return models.compare(falling(), trade.reference, duration=2.5, body=BODY, scene=Scene())


def test_errors_are_those_of_the_definition(trade):
    row = trade.rows[0]
    run, reference = trade.rows[0].run, trade.reference
    assert row.pose_error == np.linalg.norm(run.position[-1] - reference.position[-1]) / 1.0  # the path is shorter
    sizes = np.linalg.norm(reference.torque, axis=2)
    assert row.torque_error == np.linalg.norm(run.torque - reference.torque, axis=2).max() / sizes.max()
    alone = simulate(falling(), 2.5, body=BODY, accuracy=COARSE)
    assert np.array_equal(alone.position[-1], run.position[-1])  # the switches that cost nothing change nothing


def test_finer_is_more_exact_and_the_reference_has_converged(trade):
    coarse, middle, exact, _ = trade.rows
    assert coarse.error > 10.0 * middle.error > 100.0 * exact.error / 2.0
    assert max(trade.reference_error) < 0.1 * exact.error
    assert coarse.evaluations < middle.evaluations < exact.evaluations
    assert coarse.nodes < middle.nodes < exact.nodes
    for row in trade.rows:
        assert row.seconds > 0.0 and row.times_real_time == 2.5 / row.seconds
        assert row.memory > 8 * 30 * row.nodes  # 30 fields and more


def test_times_nodes_and_memory_are_of_the_run_whose_errors_are_told(trade):
    for row in trade.rows:
        timed = measuring._ready(falling(), BODY, Scene(), row.accuracy)
        timed.advance(2.5)
        assert (row.nodes, row.memory) == (len(timed.grid.x), timed.memory)
        assert row.nodes == row.run.nodes and timed.evaluations[2] == row.evaluations
        assert np.array_equal(timed.head.position, row.run.position[-1])


def test_front_holds_what_nothing_beats():
    rows = [SimpleNamespace(e=e, c=c) for e, c in ((1.0, 1.0), (0.5, 2.0), (0.6, 3.0), (0.5, 2.5), (0.1, 9.0))]
    found = measuring.front(rows, lambda row: row.e, lambda row: row.c)
    assert [(row.e, row.c) for row in found] == [(1.0, 1.0), (0.5, 2.0), (0.1, 9.0)]


def test_poorer_models_are_told_by_what_they_leave_out(trade, poorer):
    found = {model.name: model for model in poorer}
    assert len(found) == len(models.VARIANTS)
    assert found["planar"].torque_error > 0.1  # the gait bends in pitch
    assert found["blended friction"].torque_error < 0.1 * found["no friction"].torque_error
    flat = straight()
    reference = measuring.swim(flat, 1.0, BODY, Scene(), REFERENCE)
    planar = next(
        model
        for model in models.compare(flat, reference, duration=1.0, body=BODY, scene=Scene())
        if model.name == "planar"
    )
    assert max(planar.pose_error, planar.torque_error) < 1e-9  # a gait in the plane loses nothing


def test_tables_name_a_setting_that_is_exact_enough(trade, poorer):
    text = table.model_table(poorer, trade)
    setting, _ = table.exact_enough(next(model for model in poorer if model.name == "no friction"), trade)
    row = next(row for row in trade.rows if row.accuracy.name == setting)
    model = next(model for model in poorer if model.name == "no friction")
    assert row.pose_error <= 0.1 * model.pose_error and row.torque_error <= 0.1 * model.torque_error
    assert text.splitlines()[0].startswith("left out") and len(text.splitlines()) == 1 + len(poorer)
    lines = table.trade_table(trade, everything=True, markdown=True).splitlines()
    assert len(lines) == 2 + 4 and all(line.count("|") == len(table.HEAD) + 1 for line in lines)


def test_a_setting_that_diverges_is_told_apart():
    light = Scene(density=10.0, reactive=False)
    long = Accuracy(name="long steps", resolution=10.0, step=0.05)
    trade = measuring.measure(straight(), [COARSE, long], duration=0.5, body=BODY, scene=light, repeats=1)
    assert trade.unstable == [long] and [row.accuracy for row in trade.rows] == [COARSE]


def test_labels_keep_apart_about_where_they_belong():
    assert _apart([0.0, 0.0, 5.0], 1.0) == [-0.5, 0.5, 5.0]
    moved = _apart([0.0, 0.1, 0.9, 4.0], 1.0)
    assert np.all(np.diff(moved) >= 1.0 - 1e-12) and moved[-1] == 4.0
    assert np.mean(moved[:3]) == pytest.approx(np.mean([0.0, 0.1, 0.9]))
    assert _apart([0.0, 4.5, 4.8, 4.9], 1.0, highest=5.0) == [0.0, 3.0, 4.0, 5.0]


def test_command_leaves_picture_page_table_and_recording(tmp_path, capsys):
    words = f"straight --quick --repeats 1 --duration 1 --csv --pictures {tmp_path}/images --page {tmp_path}/page.md"
    pytest.importorskip("rerun")
    (tmp_path / "images").mkdir()
    assert main([*words.split(), "--rerun", str(tmp_path / "trade.rrd")]) == 0
    said = capsys.readouterr().out
    for preset in ("draft", "standard", "fine", "reference"):
        assert preset in said
    for name in ("images/tradeoff_straight.png", "images/tradeoff_straight.svg", "page.md", "trade.rrd"):
        assert (tmp_path / name).stat().st_size > 1500, name
    page, tables = ((tmp_path / name).read_text() for name in ("page.md", "page_tables.md"))
    assert "](images/tradeoff_straight.png)" in page and page.count("\n| ") == 7 and tables.count("\n| ") > 20
    lines = (tmp_path / "images" / "tradeoff_straight.csv").read_text().splitlines()
    assert len(lines) == 1 + len(settings(Scene(), quick=True))
    from rerun.chunk import RrdReader

    entities = {chunk.entity_path for chunk in RrdReader(str(tmp_path / "trade.rrd")).stream()}
    assert "/straight/runs/standard" in entities and "/straight/table" in entities


@pytest.mark.parametrize(
    "words, named",
    [
        ("wriggling", "wriggling"),
        ("--set period", "period"),
        ("--set period=1 --set period=2 --quick", "period must be given once"),
        ("--repeats 0", "repeats"),
        ("--duration 0 --quick", "--duration must be finite and >= 0.05 s, got 0.0"),
        ("--duration nan --quick", "--duration"),
        ("--duration -1 --quick", "--duration"),
        ("--pictures /nowhere/at/all", "/nowhere/at must be a folder that exists"),
    ],
)
def test_bad_input_is_named(words, named, capsys):
    assert main(words.split()) == 2
    assert named in capsys.readouterr().err


def test_the_counts_of_delivered_errors():
    """Errors and estimates that are given here: one swim misses its target in silence, one is told, one is unknown."""

    def trial(error, estimate, told=False, uncertainty=0.0):
        known = None if error is None else ErrorEstimate(error, None)
        return Trial({"accuracy": 1e-3}, known, uncertainty, ErrorEstimate(estimate, None), told, 1.5)

    trials = [trial(1e-5, 1e-4), trial(4e-3, 1e-3), trial(5e-3, 6e-3, told=True), trial(None, 1e-2, told=True)]
    assert [each.missed for each in trials] == [False, True, False, False]
    assert trial(3e-5, 1e-5, uncertainty=2.5e-5).underestimated == pytest.approx(0.5)  # a reference of no more worth
    row = delivered_table(trials, markdown=True).splitlines()[2]
    cells = [cell.strip() for cell in row.split("|")[1:-1]]
    assert cells == ["position, motion alone", "4", "3", "2", "1", "1", "1", "1", "0.833", "4.00", "0", "1.50"]


@pytest.mark.parametrize(
    "words, told",
    [
        ("--delivered straight", "--delivered does not go with GAIT"),
        ("--delivered --set period=0.5 --duration 10", "--delivered does not go with --set, --duration"),
        ("--delivered --body kern2006 --repeats 0", "--delivered does not go with --body, --repeats"),
        ("--delivered --quick --all --csv", "--delivered does not go with --quick, --all, --csv"),
        ("--delivered --rerun trade.rrd", "--delivered does not go with --rerun"),
        ("--count 500 --seed 0", "--delivered must be given for --count, --seed"),
    ],
)
def test_options_that_do_not_go_together_are_named(words, told, capsys):
    assert main(words.split()) == 2
    assert capsys.readouterr() == ("", f"eel tradeoff: {told}\n")


def test_pictures_of_what_is_delivered_need_no_page(tmp_path, capsys):
    folder = tmp_path / "new"  # made, as `figures --out` makes it
    assert main(["--delivered", "--count", "2", "--seed", "3", "--pictures", str(folder)]) == 0
    assert sorted(path.name for path in folder.iterdir()) == [
        *("delivered.png", "delivered.svg"),
        *("price.png", "price.svg"),
    ]
    assert main(["--delivered", "--pictures", str(folder / "none" / "at all")]) == 2
    assert "must be a folder that exists" in capsys.readouterr().err


@pytest.mark.parametrize("words, named", [("--count 0", "--count"), ("--seed -1", "--seed")])
def test_bad_numbers_of_random_swims_are_named(words, named, capsys):
    assert main(["--delivered", *words.split()]) == 2
    assert named in capsys.readouterr().err
