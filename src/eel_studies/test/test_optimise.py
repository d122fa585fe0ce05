# SPDX-License-Identifier: Apache-2.0
"""The gait of least cost at each speed: by gradients and by CMA-ES, on the command line, and what is refused."""

import csv

import numpy as np
import pytest
from eel_dynamics.runs.scene_file import save_scene, swim_of
from eel_studies.optimisation.command import main

from eel_dynamics import Scene, simulate_batch
from eel_gaits import sampled, straight
from eel_studies import optimise

PLANE = Scene(friction="blended", planar=True)
BOUNDS = {"period": (0.6, 2.5), "amplitude_0": (0.2, 2.0)}
NUMBERS = {"amplitude_1": 0.0, "amplitude_2": 1.0}
QUICK = {"scene": PLANE, "numbers": NUMBERS, "periods": 8, "accuracy": 1e-2, "progress": False}


@pytest.fixture(scope="module")
def front():
    return optimise(BOUNDS, [0.5, 0.3], **QUICK)


def test_the_gaits_have_the_speeds_and_cost_least_of_a_scan(front):
    assert front.wanted.tolist() == [0.3, 0.5] and front.values.shape == (2, 2) and len(front) == 2
    assert front.speed == pytest.approx(front.wanted, rel=0.01) and front.warnings == ()
    # a scan over the amplitude, in which the period follows from the speed: that of a gait goes nearly like 1/T
    sizes = np.linspace(*BOUNDS["amplitude_0"], 9)
    found = []
    for size in sizes:
        periods = np.linspace(*BOUNDS["period"], 5)
        laws = [straight(period=period, amplitude_0=size, **NUMBERS) for period in periods]
        twist = (0.0, 0.0, 0.0, 0.5, 0.0, 0.0)
        batch = simulate_batch(laws, 12.0, scenes=PLANE, accuracy=1e-2, stations=2, twists=twist, estimate=False)
        speed, cost = np.array([(a.mean_speed, a.cost_of_transport) for a in (run.analysis() for run in batch)]).T
        order = np.argsort(speed)
        if speed.min() <= 0.5 <= speed.max():
            found.append(np.exp(np.interp(np.log(0.5), np.log(speed[order]), np.log(cost[order]))))
    assert len(found) >= 4
    assert front.cost[1] <= 1.02 * min(found) and front.cost[1] >= 0.9 * min(found)


def test_a_faster_gait_costs_more_and_the_bounds_that_decide_are_told(front):
    assert front.cost[0] < front.cost[1] and not front.dominated.any()
    inside = (front.values >= front.low) & (front.values <= front.high)
    assert inside.all()
    place = (front.values - front.low) / (front.high - front.low)
    assert (front.at_bound == ((place < 1e-3) | (place > 0.999))).all()
    lines = front.table().splitlines()
    assert len(lines) == 3 and lines[0].split()[0] == "speed" and "0.3" in lines[1]
    assert front == front and repr(front) == "Front(2 speeds, cost_of_transport by period, amplitude_0)"
    for run in front.runs:
        assert run.error_estimate.position < 1e-2 and run.analysis().settled
    assert len(front.tried) > 20 and np.isfinite(front.tried).all()


@pytest.mark.soak
def test_cma_finds_what_gradients_find(front):
    other = optimise(BOUNDS, [0.5], method="cma", **QUICK | {"seed": 3})
    assert other.speed == pytest.approx([0.5], rel=0.01)
    assert other.cost[0] == pytest.approx(front.cost[1], rel=0.02)


@pytest.mark.fault(
    "parameters",
    "`optimise` for a speed that no gait within the bounds reaches",
    "one line with the speeds of the gaits that were tried; the other speeds are kept",
)
@pytest.mark.soak
def test_a_speed_out_of_reach_is_told():
    with pytest.warns(UserWarning, match=r"no gait within the bounds was found for 9 m/s; the gaits .* 0\.\d+ to \d"):
        found = optimise({"period": (0.6, 2.5)}, [0.4, 9.0], **QUICK)
    assert found.wanted.tolist() == [0.4] and len(found.warnings) == 1
    with pytest.raises(
        ValueError, match=r"^speeds: no gait .* for 9 m/s; the gaits that were tried swim at 0\.\d+ to 0"
    ):
        optimise({"period": (1.0, 1.5)}, [9.0], **QUICK)


@pytest.mark.parametrize(
    "given, words",
    [
        ({"bounds": {}}, "bounds must be a dict of parameters and .low, high., got {}"),
        ({"bounds": {"period": 1.0}}, "bounds 'period' must be .low, high., got 1.0"),
        ({"bounds": {"period": (2.0, 1.0)}}, "bounds 'period' must have low < high, got .2, 1."),
        ({"bounds": {"period": (1.0, float("nan"))}}, "bounds 'period' must be finite, got nan"),
        ({"bounds": {"perod": (1.0, 2.0)}}, r"no number 'perod' \(did you mean 'period'\?\), it has"),
        ({"bounds": {"body.lateral_drg": (1.0, 2.0)}}, r"did you mean 'lateral_drag'\?"),
        ({"bounds": {"period": (-1.0, 1.0)}}, "optimise at period=-1.0: period must be >= 0.001 s, got -1.0"),
        ({"speeds": []}, r"speeds must be one or more, > 0 m/s, none twice, got \[\]"),
        ({"speeds": [0.3, 0.3]}, "none twice"),
        ({"speeds": [-0.3]}, "speeds must be one or more, > 0 m/s"),
        ({"speeds": [float("nan")]}, "speeds must be finite, got nan at index 0"),
        ({"method": "simplex"}, "method must be one of gradient, cma, got 'simplex'"),
        ({"periods": 2}, "periods must be a whole number >= 4, got 2"),
        ({"cost": "price"}, "cost must be one of head_x, .* got 'price'"),
        ({"gait": "still", "bounds": {"scene.density": (900.0, 1000.0)}}, "law 'still' has no periodic term"),
        (
            {"gait": lambda period: sampled(straight(period=period).curvature, 3.0)},
            "^optimise gait must return a Law, whose terms are known, got SampledLaw",
        ),
    ],
)
def test_bad_input_is_refused_in_one_line(given, words):
    given = {"bounds": {"period": (0.6, 2.5)}, "speeds": [0.3], **given}
    with pytest.raises(ValueError, match=words) as error:
        optimise(**given, scene=PLANE)
    assert "\n" not in str(error.value)


def test_the_scene_of_a_file_is_optimised(tmp_path, capsys):
    words = {"gait": "straight", "amplitude_2": 1.0, "scene": {"planar": True, "friction": "laminar"}}
    swim = swim_of({**words, "flow": "uniform velocity=0.1,0,0"})
    path = tmp_path / "scene.yaml"
    save_scene(swim, path)
    out = tmp_path / "a.csv"
    told = ["--bound", "period=0.6:2.5", "--speeds", "0.45", "--periods", "8", "--accuracy", "1e-2"]
    assert main([str(path), *told, "--out", str(out)]) == 0
    front = optimise({"period": (0.6, 2.5)}, [0.45], gait=swim, periods=8, accuracy=1e-2)
    rows = list(csv.DictReader(out.open()))
    (run,) = front.runs
    assert float(rows[0]["period"]) == front.values[0, 0]
    assert run.scene.friction == "laminar" and run.flow == swim.flow and run.law.terms[0].amplitude[2] == 1.0


@pytest.mark.fault(
    "parameters",
    "`eel optimise --method cma` without the package cma",
    "one line that names it and its extra, status 2",
)
def test_a_missing_package_is_named(monkeypatch, capsys):
    def without(name):
        raise ModuleNotFoundError(f"No module named {name!r}")

    monkeypatch.setattr("eel_dynamics.runs.storage.tables.import_module", without)
    assert main(["--bound", "period=1:2", "--speeds", "0.3", "--method", "cma"]) == 2
    *_, line = capsys.readouterr().err.splitlines()  # a slow machine tells of its progress before
    assert "method 'cma' of optimise needs cma" in line and "pip install cma" in line


def test_the_command_prints_the_front_and_writes_what_was_asked_for(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = ["straight", "--bound", "period=0.6:2.5", "--speeds", "0.45:0.5:2", "--scene", "planar=on"]
    words += ["--set", "amplitude_2=1", "--periods", "8", "--accuracy", "1e-2", "--out", "a.png", "--out", "a.csv"]
    assert main(words) == 0
    out = capsys.readouterr().out
    assert "cost_of_transport [J/(kg m)]" in out and "written to a.png" in out and "gaits tried" in out
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    rows = list(csv.DictReader((tmp_path / "a.csv").open()))
    assert [float(row["speed"]) for row in rows] == pytest.approx([0.45, 0.5], rel=0.02) and float(
        rows[0]["period"]
    ) > 0.6
    for bad, told in [
        (["--bound", "period=1"], "--bound must be NAME=LOW:HIGH, got 'period=1'"),
        (["--speeds", "fast"], "--speeds must be start:end:count, count >= 1, or a,b,c in m/s, got 'fast'"),
        (["--out", "front.gif"], "--out must end in .png, .svg, .pdf or .csv, got 'front.gif'"),
        (["--set", "amplitude_2=x"], "--set must be NAME=NUMBER"),
    ]:
        assert main(["--bound", "amplitude_0=1:2", "--speeds", "0.3", *bad]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert told in line
