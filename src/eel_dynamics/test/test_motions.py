# SPDX-License-Identifier: Apache-2.0
"""Functions, files and rows in place of a closed-form law: whole runs, and what their sampling and smoothing do."""

import math
import pickle

import numpy as np
import pytest
from eel_dynamics.accuracy.law_waves import waves_of_rows
from eel_dynamics.commands.simulate import main
from eel_gaits.sources.lateral import LateralMidline
from midline_files import ARC, kern_midline, write_midlines

from eel_dynamics import Body, Run, Scene, Simulation, hydrodynamic_wrench, simulate, simulate_batch
from eel_gaits import Law, Ramp, SampledLaw, Term, kern_fast, sampled, straight

WAVE = Law(Term(amplitude=(1.0, 0.5, 2.0), wavelength=1.0, period=1.0), name="wave")
PLANE = Scene(planar=True, friction="laminar")


@pytest.fixture(scope="module")
def law():
    return sampled(WAVE.curvature, 3.0, name="rows")


@pytest.fixture(scope="module")
def closed():
    return simulate(WAVE, 3.0, scene=PLANE)


@pytest.fixture(scope="module")
def run(law):
    return simulate(law, 3.0, scene=PLANE, accuracy=1e-2)


def mackerel(x, time):
    """h(X, t) of a mackerel (Videler and Hess 1984, after Borazjani and Sotiropoulos 2008), begun over a second."""
    begun = float(Ramp(0.0, 1.0, 1.0).value(time)[0])
    return begun * (0.02 - 0.0825 * x + 0.1625 * x**2) * np.sin(2.0 * math.pi * (x / 0.95 - time))


def test_rows_swim_as_the_closed_form_does_within_the_estimated_error(run, closed):
    distance = np.max(np.linalg.norm(run.position - closed.position, axis=1)) / closed.path_length
    torque = np.max(np.abs(run.torque - closed.torque)) / np.max(np.abs(closed.torque))
    assert 0.0 < run.error_estimate.resampling <= run.error_estimate.worst < 1e-2
    assert distance <= run.error_estimate.position and torque <= run.error_estimate.torque
    assert closed.error_estimate.resampling is None
    assert run.analysis().mean_speed == pytest.approx(closed.analysis().mean_speed, rel=1e-3)
    assert "from the law's rows" in run.summary() and "a function in" in run.summary()


def test_a_function_swims_as_its_rows_do(run):
    def rows(time, x):
        return WAVE.curvature(time, x)

    again = simulate(rows, 3.0, scene=PLANE, accuracy=1e-2)
    assert np.array_equal(again.position, run.position) and again.law.name == "rows"


def test_a_startle_in_a_long_rest_has_the_torque_of_one_in_a_short_rest():
    """The same bend of 0.2 s at 2.06 s and at 10.3 s."""

    def startle(at):
        return lambda t, x: (1.0 - min(((t - at) / 0.1) ** 2, 1.0)) ** 4 * 2.0 * np.sin(math.pi * x)

    early, late = (
        simulate(startle(at), end, scene=PLANE, accuracy=1e-2, sample_period=0.01)
        for at, end in ((2.06, 3.0), (10.3, 12.0))
    )
    assert np.abs(late.torque).max() == pytest.approx(np.abs(early.torque).max(), rel=1e-2)
    first, then = (run.position[int(100 * at + 50)] for run, at in ((early, 2.06), (late, 10.3)))
    assert np.linalg.norm(early.position[-1]) > 0.01 and np.allclose(then, first, atol=2e-3)


@pytest.mark.soak
def test_a_bend_that_is_short_and_local_makes_the_grid_finer():
    def flick(t, x):
        return np.sin(2.0 * math.pi * (x - t)) + bend_at(t) * np.exp(-(((x - 0.62) / 0.03) ** 2))

    def bend_at(t):
        return 5.0 * (1.0 - min(((t - 3.21) / 0.02) ** 2, 1.0)) ** 4

    plain = waves_of_rows(sampled(lambda t, x: np.sin(2.0 * math.pi * (x - t)), 8.0))
    assert waves_of_rows(sampled(flick, 8.0)) > 3.0 * plain


def test_rows_that_are_far_apart_are_seen_in_the_error(law):
    few = SampledLaw(law.time[::16], law.x[::4], law.values[::16, :, :, ::4])
    with pytest.warns(UserWarning, match="most of it comes from the rows of the law"):
        run = simulate(few, 3.0, scene=PLANE)
    assert run.error_estimate.resampling > 1e-3 and run.warnings[0].startswith("the error is estimated")


def test_a_run_of_rows_is_data(run, tmp_path):
    run.save(tmp_path / "run.nc")
    assert Run.load(tmp_path / "run.nc") == run == pickle.loads(pickle.dumps(run))


def test_rows_in_a_batch_swim_as_alone(run, law):
    batch = simulate_batch([law, WAVE], 3.0, scenes=PLANE, accuracy=1e-2, stations=51, sample_period=0.05)
    assert np.array_equal(batch.position[0], run.position) and batch[0].law == law
    assert batch.error_estimates[0].resampling and batch.error_estimates[1].resampling is None


def test_rows_take_over_in_mid_swim_without_a_jump(law):
    simulation = Simulation(measure_error=True, scene=PLANE, law=straight())
    simulation.advance(0.5)
    before = simulation.observe().curvature
    simulation.adopt(law, origin=-0.7, transition=0.6)
    assert np.allclose(simulation.observe().curvature, before, atol=1e-12)
    simulation.advance(1.4)
    wanted = law.curvature(2.1, simulation.x)[0]
    assert np.allclose(simulation.observe().curvature, wanted, atol=1e-9)
    assert simulation.sampled and simulation.error_estimate.position < 1e-2
    with pytest.raises(ValueError, match="cannot join the rows of law 'rows'"):
        simulation.add_samples(1.5, [0.0, 1.0], *np.zeros((6, 2)))
    simulation.advance(3.0)  # the last row was at 2.3
    assert simulation.resting
    simulation.reset()
    simulation.advance(0.3)
    assert np.allclose(simulation.observe().curvature, law.curvature(0.3, simulation.x)[0], atol=1e-9)


def test_what_does_not_fit_a_motion_is_said(law):
    with pytest.raises(ValueError, match="duration must be at most 3 s, that of the motion 'rows', got 4 s"):
        simulate(law, 4.0)
    with pytest.raises(ValueError, match="duration must be at most 3 s"):
        simulate_batch([law], 4.0)
    with pytest.raises(
        ValueError,
        match=r"law must be a Law, .*, a function K\(t, X\) or a table \(.csv, .txt ...\) or .npz file, got 3",
    ):
        simulate(3)
    with pytest.raises(ValueError, match=r"law 'rows' is for a body of 1 m, the body has 2 m"):
        Simulation(law=law, body=longer())
    with pytest.raises(ValueError, match="law 'pitched' has a pitch term"):
        simulate(sampled(lambda t, x: np.stack((x, x)), 1.0, name="pitched"), 1.0, scene=PLANE)
    with pytest.raises(ValueError, match="law must be a Law, got SampledLaw"):
        hydrodynamic_wrench(Simulation().body, law, 0.0, np.zeros(6), np.zeros(6))


def longer():
    x = np.linspace(0.0, 2.0, 41)
    return Body(x=x, half_width=0.05 * np.sqrt(x), half_height=0.06 * np.sqrt(x))


@pytest.mark.parametrize("fish", ["eel", "mackerel"])
def test_a_published_midline_from_a_noisy_file_has_the_speed_of_the_closed_form(fish, tmp_path):
    """Noise of 1/1000 of the body's length on each coordinate; the file turns and swims otherwise than the model."""
    if fish == "eel":
        law, midline = kern_fast(), kern_midline
    else:
        shape = LateralMidline(mackerel)
        law, midline = sampled(shape.curvature, 4.0), lambda time: shape.position(time, ARC)
    exact = simulate(law, 4.0, scene=PLANE, estimate=False).mean_speed
    path = write_midlines(tmp_path / "fish.csv", midline, noise=1e-3)
    measured = simulate(path, 4.0, scene=PLANE, estimate=False)
    assert measured.mean_speed == pytest.approx(exact, rel=0.05)
    assert "generalised cross-validation" in measured.summary()


def test_the_command_swims_a_file_and_says_what_smoothing_does(tmp_path, capsys):
    arc = np.linspace(0.0, 1.0, 9)
    draw, lines = np.random.default_rng(2), ["time,arc_length,yaw"]
    for time in np.arange(151) / 50.0:
        bends = WAVE.curvature(time, arc)[0][:, 2] + 0.05 * draw.normal(size=9)
        lines += [f"{time},{x},{bend}" for x, bend in zip(arc, bends, strict=True)]
    path = tmp_path / "bends.csv"
    path.write_text("\n".join(lines))
    assert main(["--file", str(path), "--scene", "planar=on", "--accuracy", "draft"]) == 0
    told = capsys.readouterr().out
    assert "bends: boyer2010" in told and "residual (RMS)" in told and "times, RMS torque" in told
    assert main(["--file", str(path), "falling"]) == 2
    assert "--file takes the place of a gait, got 'falling' too" in capsys.readouterr().err
    assert main(["falling", "--scale", "2"]) == 2 and "belong to --file" in capsys.readouterr().err
    assert main(["--file", str(tmp_path / "none.csv")]) == 2 and "no such file" in capsys.readouterr().err
