# SPDX-License-Identifier: Apache-2.0
"""Coefficients from measured motions: their intervals on made data, what is not determined, the command, and what is
refused."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.model.initial_state import AT_REST
from eel_studies.identification.command import main
from eel_studies.identification.statistics import Block, correlation_of, gauss_newton_covariance, whitened

from eel_dynamics import Body, Gust, Scene, Swim, simulate
from eel_gaits import sampled, straight, turning
from eel_studies import MeasuredPath, MeasuredSpeed, identify

PLANE = Scene(friction="blended", planar=True)
TRUTH = {"body.lateral_drag": 1.98, "body.nose_drag": 0.036}  # of the paper's robot
GUESS = {"body.lateral_drag": 1.4, "body.nose_drag": 0.1}
TURN = 0.4  # rad, of the laboratory's axes
NOISE = 0.005  # m
FAST = {"scene": PLANE, "accuracy": 1e-2, "threads": 1}


def correlated(rng, count: int, factor: float) -> np.ndarray:
    """Errors (count, 2) of size 1, each correlated with the next by `factor`."""
    errors = rng.standard_normal((count, 2))
    for k in range(1, count):
        errors[k] = factor * errors[k - 1] + np.sqrt(1.0 - factor**2) * errors[k]
    return errors


@pytest.fixture(scope="module")
def true_path():
    """Times and positions of the head in a laboratory, from a run that is finer than those of the fits."""
    run = simulate(turning(period=0.8), 5.0, scene=PLANE, accuracy=1e-6, sample_period=0.05, stations=2)
    cosine, sine = np.cos(TURN), np.sin(TURN)
    return run.time[2:], run.position[2:, :2] @ np.array([[cosine, sine], [-sine, cosine]]) + [1.0, -2.0]


def fitted(true_path, seed: int, factor: float = 0.0, **options):
    time, position = true_path
    position = position + NOISE * correlated(np.random.default_rng(seed), len(time), factor)
    path = MeasuredPath(time, position, numbers={"period": 0.8})
    return identify(GUESS, path, gait="turning", **FAST | options)


@pytest.mark.soak
@pytest.mark.parametrize("factor", [0.0, 0.7])
def test_intervals_cover_the_truth_as_often_as_they_say(true_path, factor):
    """8 trials of 2 parameters: 0.95 of 16 is 15.2, and 12 or fewer have a chance of 1 %; the seeds are fixed.

    The whole measure, of 100 trials, stands in docs/howto/identify.md.
    """
    found = [fitted(true_path, seed, factor) for seed in range(8)]
    covered = sum(low <= TRUTH[name] <= high for each in found for name in TRUTH for _, low, high in [each[name]])
    assert covered >= 13
    assert np.mean([each.noise for each in found]) == pytest.approx(NOISE, rel=0.1)
    assert np.mean([each.correlation for each in found]) == pytest.approx(factor, abs=0.08)
    # the stated errors are those that the trials show
    spread = np.std([each.value for each in found], axis=0, ddof=1)
    stated = np.mean([each.error for each in found], axis=0)
    assert np.all(spread < 1.8 * stated) and np.all(spread > 0.4 * stated)
    assert found[0].table().count("interval") == 2 and found[0].warnings == ()


@pytest.mark.soak
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("factor", [0.0, 0.8])
def test_intervals_of_a_hundred_trials_cover_the_truth_in_90_to_99(true_path, factor):
    found = [fitted(true_path, seed, factor) for seed in range(100)]
    for name, true in TRUTH.items():
        covered = sum(low <= true <= high for each in found for _, low, high in [each[name]])
        print(f"errors correlated by {factor}: the 95 % interval of {name} covers the truth in {covered} of 100 trials")
        assert 90 <= covered <= 99


def test_a_path_without_errors_gives_the_truth(true_path):
    found = identify(
        GUESS, MeasuredPath(*true_path, numbers={"period": 0.8}), gait="turning", **FAST | {"accuracy": 1e-4}
    )
    assert found.value == pytest.approx(list(TRUTH.values()), rel=2e-3)
    assert found.numbers.keys() == TRUTH.keys() and found.residuals[0].shape == (len(true_path[0]), 2)
    assert found == found and repr(found).startswith("Identified(body.lateral_drag=1.98")


def test_heights_that_no_parameter_moves_make_the_errors_no_smaller(true_path):
    time, position = true_path
    position = position + NOISE * correlated(np.random.default_rng(0), len(time), 0.0)
    flat, high = (
        identify(GUESS, MeasuredPath(time, rows, numbers={"period": 0.8}), gait="turning", **FAST)
        for rows in (position, np.column_stack((position, np.zeros(len(time)))))
    )
    assert high.error == pytest.approx(flat.error) and high.noise == pytest.approx(flat.noise)


def test_speeds_of_several_gaits_give_a_coefficient():
    periods, wanted = (0.7, 1.0, 1.4, 2.0), 1.5
    body = Body.boyer2010().changed(lateral_drag=wanted)
    rng = np.random.default_rng(5)
    measured = []
    for period in periods:
        run = simulate(straight(period=period), 20 * period, body=body, scene=PLANE, accuracy=1e-5, stations=2)
        measured.append(MeasuredSpeed(run.mean_speed + 0.002 * rng.standard_normal(), {"period": period}))
    found = identify({"body.lateral_drag": 2.0}, measured, noise=0.002, **FAST)
    value, low, high = found["body.lateral_drag"]
    assert low < wanted < high and abs(value - wanted) < 0.1
    assert found.noise == 0.002 and found.correlation == 0.0 and len(found.runs) == 4
    one = identify({"body.lateral_drag": 2.0}, measured[0], noise=0.002, **FAST)
    assert one.error[0] > found.error[0]  # one speed and one coefficient: the interval is that of the noise given
    with pytest.warns(UserWarning, match="residuals are .* times the noise: the model does not fit"):
        identify({"body.lateral_drag": 2.0}, measured, noise=1e-5, **FAST)


def test_a_whole_swim_keeps_its_body_water_and_start():
    body, gust = Body.boyer2010().changed(lateral_drag=1.5, nose_drag=0.2), Gust()
    swim = Swim(straight(), body, PLANE, 1e-4, flow=gust, start=AT_REST._replace(twist=0.3 * np.eye(6)[3]))
    run = swim.run(duration=3.0, sample_period=0.05, stations=2)
    path = MeasuredPath(run.time[2:], run.position[2:, :2])
    found = identify({"body.lateral_drag": 1.3}, path, gait=swim, accuracy=1e-4, threads=1)
    assert found.value == pytest.approx([1.5], rel=2e-3)


def test_the_friction_is_blended_where_no_scene_is_given():
    found = identify({"body.lateral_drag": 2.0}, MeasuredSpeed(0.6), noise=0.01, accuracy=1e-2, threads=1)
    assert found.runs[0].scene.friction == "blended"


def test_whitened_errors_have_the_covariance_of_an_autoregression():
    step, errors = np.array([1.0, 2.0, 0.5]), np.array([0.3, -1.0, 0.7, 2.0])
    time = np.concatenate(([0.0], np.cumsum(step)))
    covariance = 0.6 ** np.abs(time[:, None] - time)
    white, rows, log = whitened([Block(step, errors, errors[:, None] ** 2)], 0.6)
    assert white @ white == pytest.approx(errors @ np.linalg.solve(covariance, errors))
    assert white @ rows[:, 0] == pytest.approx(errors @ np.linalg.solve(covariance, errors**2))
    assert log == pytest.approx(np.linalg.slogdet(covariance)[1])


def test_correlated_errors_are_weighted_as_least_squares_asks():
    """A straight line through 400 errors with rho = 0.8: its slope's error against trials, and rho itself."""
    time, slopes, stated, factors = np.arange(400.0), [], [], []
    derivative = np.column_stack((time / 400.0, np.ones(400)))
    for seed in range(60):
        errors = correlated(np.random.default_rng(seed), 400, 0.8)[:, 0]
        block = Block(np.ones(399), errors, derivative)
        factors.append(correlation_of([block]))
        covariance, squares = gauss_newton_covariance([block], factors[-1])
        stated.append(np.sqrt(squares / 398 * covariance[0, 0]))
        slopes.append(np.polyfit(time / 400.0, errors, 1)[0])
    assert np.mean(factors) == pytest.approx(0.8, abs=0.02)
    assert np.mean(stated) == pytest.approx(np.std(slopes), rel=0.25)


@pytest.mark.fault(
    "parameters",
    "`identify` of coefficients that the measurements do not determine",
    "one line that names their combination",
)
@pytest.mark.parametrize(
    "guess, told",
    [
        (
            {"body.lateral_drag": 2.0, "body.vertical_drag": 1.0},
            r"do not change with body.vertical_drag \(\+1%\): leave",
        ),
        (
            {"scene.density": 1000.0, "scene.fluid_density": 1000.0},
            r"scene.density \(\+1%\) with scene.fluid_density \(\+1%\)",
        ),
    ],
)
def test_coefficients_that_cannot_be_told_apart_are_named(true_path, guess, told):
    with pytest.raises(ValueError, match=told):
        identify(guess, MeasuredPath(*true_path, numbers={"period": 0.8}), gait="turning", **FAST)


def rows(period=1.0):
    """A gait without terms."""
    return sampled(straight(period=period).curvature, 3.0)


TIME, PLACES = np.arange(10.0) / 10.0, np.zeros((10, 2))
NO_TERMS = "^gait must return a Law, whose terms are known, got SampledLaw"


@pytest.mark.parametrize(
    "make, words",
    [
        (
            lambda: MeasuredPath(TIME, np.where(TIME[:, None] == 0.3, np.nan, PLACES)),
            r"finite, got \[nan, nan\] at index 3",
        ),
        (lambda: MeasuredPath(TIME[:3], PLACES[:3]), "path must have 4 samples or more, got 3"),
        (lambda: MeasuredPath(TIME[::-1], PLACES), "path time must rise from 0 s or later"),
        (lambda: MeasuredPath(TIME, PLACES[:, :1]), r"2 or 3 coordinates at each of 10 times, got \(10, 1\)"),
        (lambda: MeasuredPath(TIME, PLACES, station=-0.1), "path station must be >= 0 m, got -0.1"),
        (lambda: MeasuredSpeed(0.0), "measured speed must be > 0 m/s, got 0.0"),
        (lambda: identify({}, MeasuredSpeed(0.3)), "parameters must be a dict of names and first guesses"),
        (
            lambda: identify(GUESS, []),
            "measured must be of one kind of MeasuredPath, MeasuredAngles, MeasuredSpeed, got none",
        ),
        (
            lambda: identify(GUESS, [MeasuredSpeed(0.3), MeasuredPath(TIME, PLACES)]),
            "MeasuredSpeed, got MeasuredPath, MeasuredSpeed",
        ),
        (lambda: identify(GUESS, None), "measured must be of one kind of .*, got NoneType"),
        (lambda: identify(GUESS, MeasuredSpeed(0.3), numbers=[1.0]), r"numbers must be a dict, got \[1.0\]"),
        (lambda: identify({"body.lateral_drg": 1.0}, MeasuredSpeed(0.3)), r"did you mean 'lateral_drag'\?"),
        (
            lambda: identify({"body.lateral_drag": 1.0}, MeasuredSpeed(0.3), scene=PLANE),
            "2 numbers or more for 1 unknowns",
        ),
        (lambda: identify(GUESS, MeasuredSpeed(0.3), noise=0.0), "noise must be > 0"),
        (lambda: identify(GUESS, MeasuredSpeed(0.3), level=1.0), "level must be below 1, got 1"),
        (
            lambda: identify(GUESS, MeasuredPath(TIME, PLACES, station=3.0)),
            "path station must be at most the body's 1 m",
        ),
        (lambda: identify(GUESS, MeasuredPath(TIME, PLACES), gait=rows), NO_TERMS),
        (lambda: identify(GUESS, MeasuredSpeed(0.3), gait=rows), NO_TERMS),
    ],
)
def test_bad_input_is_refused_in_one_line(make, words):
    with pytest.raises(ValueError, match=words) as error:
        make()
    assert "\n" not in str(error.value)


@pytest.fixture(scope="module")
def files(true_path, tmp_path_factory):
    """A folder with a path with errors, the run of another swim, and a table of speeds."""
    folder, (time, position) = tmp_path_factory.mktemp("measured"), true_path
    position = position + NOISE * correlated(np.random.default_rng(0), len(time), 0.0)
    np.savetxt(folder / "path.csv", np.column_stack((time, position)), delimiter=",", header="time,x,y", comments="")
    np.savez(folder / "path.npz", time=time, x=position[:, 0], y=position[:, 1])
    scene = Scene(friction="blended", planar=True)
    run = simulate(turning(period=0.8), 3.0, scene=scene, twist=(0, 0, 0.1, 0.3, 0, 0), stations=3, sample_period=0.05)
    run.save(folder / "run.nc")
    replace(run, body=run.body.changed(lateral_drag=1.2)).save(folder / "other_body.nc")
    replace(run, scene=replace(run.scene, fluid_density=900.0)).save(folder / "other_scene.nc")
    leaning = np.tile((0.1, 0.0, 0.0, np.sqrt(0.99)), (len(run.time), 1))
    replace(run, orientation=leaning).save(folder / "leaning.nc")
    turned, current = np.tile((0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)), (len(run.time), 1)), (-0.3, 0.0, 0.0)
    replace(run, orientation=turned, scene=replace(run.scene, current=current)).save(folder / "turned.nc")
    run = simulate(straight(period=0.8), 16.0, scene=scene, accuracy=1e-3, stations=2)
    (folder / "speeds.csv").write_text(f"speed,period\n{run.mean_speed},0.8\n")
    (folder / "bad.csv").write_text("time,x,y\n0,0,0\n1,nan,0\n")
    (folder / "back.csv").write_text("time,x,y\n0,0,0\n0,1,0\n")
    (folder / "other.csv").write_text("time,height\n0,0\n")
    (folder / "backward.csv").write_text("speed\n-0.3\n")
    return folder


GAIT = ["--gait", "turning", "--set", "period=0.8", "--scene", "planar=on", "--accuracy", "1e-2"]
ONE = ["--first", "body.lateral_drag=1.6"]


def test_the_command_finds_what_the_function_finds_and_writes_it(files, true_path, tmp_path, capsys):
    first = [word for name, value in GUESS.items() for word in ("--first", f"{name}={value}")]
    outs = ["--out", str(tmp_path / "fit.png"), "--out", str(tmp_path / "fit.csv")]
    assert main([str(files / "path.csv"), *GAIT, *first, *outs]) == 0
    said = capsys.readouterr().out
    found = fitted(true_path, 0)
    assert (
        found.table() in said and "252 measured numbers" not in said and f"{found.residuals[0].size} measured" in said
    )
    assert (tmp_path / "fit.png").read_bytes()[:4] == b"\x89PNG"
    rows = {row["name"]: row for row in csv.DictReader((tmp_path / "fit.csv").open())}
    for name in GUESS:
        assert [float(rows[name][key]) for key in ("value", "low", "high")] == pytest.approx(found[name], rel=1e-6)


def test_a_run_tells_law_start_body_and_scene(files, tmp_path, capsys):
    assert (
        main([str(files / "run.nc"), "--station", "0.5", *ONE, "--accuracy", "1e-3", "--out", f"{tmp_path}/a.csv"]) == 0
    )
    (row,) = csv.DictReader((tmp_path / "a.csv").open())
    assert float(row["value"]) == pytest.approx(TRUTH["body.lateral_drag"], rel=1e-3)


def test_speeds_in_a_table_have_the_numbers_of_their_swims(files, tmp_path, capsys):
    words = ["--gait", "straight", "--scene", "planar=on", "--noise", "0.003", "--accuracy", "1e-2"]
    assert (
        main([str(files / "speeds.csv"), *words, *ONE, "--out", f"{tmp_path}/a.csv", "--out", f"{tmp_path}/a.svg"]) == 0
    )
    (row,) = csv.DictReader((tmp_path / "a.csv").open())
    assert float(row["low"]) < TRUTH["body.lateral_drag"] < float(row["high"])
    assert "</svg>" in (tmp_path / "a.svg").read_text()


@pytest.mark.fault(
    "parameters",
    "`identify` of a file that is missing, foreign, or holds no path or speed",
    "one line that names the file, and line and column of a table; status 2",
)
@pytest.mark.parametrize(
    "words, told",
    [
        (["nothing.csv", *GAIT], "nothing.csv': there is no such file"),
        (["nothing.nc"], "nothing.nc' cannot be read: there is no such file"),
        (["bad.csv", *GAIT], "bad.csv', line 3: x must be finite, got nan"),
        (["back.csv", *GAIT], "back.csv', line 3: time must rise"),
        (["other.csv", *GAIT], "its columns must be time, x, y (a path), or speed, got ['time', 'height']"),
        (["backward.csv", *GAIT], "backward.csv', line 2: speed must be > 0 m/s, got -0.3"),
        (["path.csv"], "--gait must be given: "),
        (["run.nc", "other_body.nc"], "--body must be given: the files do not have one body"),
        (["run.nc", "other_scene.nc"], "--scene must be given: the files do not have one scene"),
        (["leaning.nc"], "leaning.nc': its head must be level at the start"),
        (["turned.nc"], "in a current its head must point along x at the start, got a heading of 90 deg"),
        (["run.nc", "--set", "period=1"], "--set belongs to --gait, which is not given"),
        (
            ["run.nc", "--station", "0.3"],
            "--station must be one of its 3 stations, the nearest are 0, 0.5, 1 m, got 0.3",
        ),
        (["path.csv", "speeds.csv", *GAIT], "MeasuredSpeed, got MeasuredPath, MeasuredSpeed"),
        (["path.npz", *GAIT, "--level", "2"], "level must be below 1, got 2"),
        (["path.csv", *GAIT, "--first", "body.drag"], "--first must be NAME=VALUE, got 'body.drag'"),
        (["path.csv", *GAIT, "--first", "body.drag=x"], "--first must be NAME=NUMBER, got 'body.drag=x'"),
        (["path.csv", *GAIT, "--out", "fit.gif"], "--out must end in .png, .svg, .pdf or .csv, got 'fit.gif'"),
    ],
)
def test_the_command_refuses_bad_input_in_one_line(files, words, told, capsys, monkeypatch):
    monkeypatch.chdir(files)
    assert main([*words, *ONE]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("eel identify: ") and told in line, line
