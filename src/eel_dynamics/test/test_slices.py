# SPDX-License-Identifier: Apache-2.0
"""A march can be interrupted and goes on as if nothing had been; what a swim costs is foreseen, and limited."""

import itertools
import math
import re
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from eel_dynamics.commands.simulate import main

import eel_core
from eel_dynamics import Scene, Simulation, SimulationStopped, simulate, simulate_batch
from eel_gaits import Law, Ramp, Term, falling, straight


def quick(period, name="quick"):
    """A law of a short period."""
    return Law(Term(amplitude=(5.0, 1.0), wavelength=1.0, period=period), name=name)


def slices_of(monkeypatch, nodes):
    """Marches come back to Python after so many `nodes`, at the end of a step."""
    made = eel_core.March

    def march(*arguments):
        result = made(*arguments)
        result.set_slice(nodes)
        return result

    monkeypatch.setattr(eel_core, "March", march)


def step_by_step(monkeypatch):
    """Slices of one step."""
    slices_of(monkeypatch, 1)


@pytest.mark.parametrize("accuracy", ["draft", "standard", 1e-6])
@pytest.mark.parametrize("scene", [Scene(), Scene(planar=True), Scene(ledger=False, internal_wrench=False)])
def test_slices_do_not_change_a_digit(monkeypatch, accuracy, scene):
    law = straight() if scene.planar else falling()
    runs = []
    for size in (1, 10**9):
        with monkeypatch.context() as patch:
            slices_of(patch, size)
            runs.append(simulate(law, 3.0, accuracy=accuracy, scene=scene, load=True, stations=7))
    cut, whole = runs
    assert (cut.steps, cut.evaluations) == (whole.steps, whole.evaluations)
    for name in ("position", "orientation", "twist", "head_acceleration", "backbone", "fluid_force"):
        np.testing.assert_array_equal(getattr(cut, name), getattr(whole, name))
    if scene.ledger:
        np.testing.assert_array_equal(cut.torque, whole.torque)
        np.testing.assert_array_equal(cut.energy.residual, whole.energy.residual)


def test_an_interrupted_march_goes_on_as_if_nothing_had_been(monkeypatch):
    """It stands at a good state in between, which can be observed."""
    step_by_step(monkeypatch)
    whole, cut = Simulation(law=falling()), Simulation(law=falling())
    assert whole.advance(2.0) is True
    times = [0.0]
    for _ in range(5):
        asked = itertools.count()
        assert cut.advance(2.0, lambda asked=asked: next(asked) == 2) is False
        assert times[-1] < cut.time < 2.0
        times.append(cut.time)
        here = Simulation(law=falling())
        here.advance(cut.time)
        np.testing.assert_allclose(cut.observe().backbone, here.observe().backbone, rtol=0.0, atol=1e-6)
    assert cut.advance(2.0, lambda: False) is True
    np.testing.assert_array_equal(cut.state, whole.state)
    assert cut.evaluations == whole.evaluations


def test_a_march_in_a_thread_of_a_batch_is_not_cut(monkeypatch):
    """Nobody looks there, no signal arrives, and each return would wait for Python's lock."""
    calls, record = [], eel_core.March.record
    monkeypatch.setattr(eel_core.March, "record", lambda *given: calls.append(given) or record(*given))
    counts = []
    for threads in (1, 2):
        calls.clear()
        simulate_batch([straight(), straight(period=1.2)], 10.0, stations=51, estimate=False, threads=threads)
        counts.append(len(calls))
    assert counts[0] > 4 and counts[1] == 2


def test_what_was_recorded_in_a_thread_can_be_interrupted_afterwards():
    swimmer = Simulation(law=falling(), stations=2)
    with ThreadPoolExecutor(1) as pool:
        pool.submit(swimmer.record, np.array([0.0, 0.1]), True, False).result()
    assert swimmer.advance(1000.0, lambda: True) is False and swimmer.time < 1000.0


def test_another_law_can_be_adopted_where_a_march_was_interrupted(monkeypatch):
    step_by_step(monkeypatch)
    swimmer = Simulation(law=falling())
    assert not swimmer.advance(1.0, lambda: True)
    began = swimmer.time
    swimmer.adopt(straight())
    swimmer.advance(2.0)
    same = Simulation(law=falling())
    same.advance(began)
    same.adopt(straight())
    same.advance(2.0)
    np.testing.assert_allclose(swimmer.observe().position, same.observe().position, rtol=0.0, atol=1e-5)


@pytest.mark.parametrize("period", [1e-5, 1e-9])
def test_a_period_that_costs_too_much_is_refused_with_the_number(period):
    with pytest.raises(ValueError, match=rf"law 'quick' has a period of {period:g} s, which takes 1e\+"):
        simulate(quick(period), 1.0)
    swimmer = Simulation(law=falling())
    swimmer.advance(0.5)
    with pytest.raises(ValueError, match=r"evaluations per simulated second or more: most_evaluations is 5e\+05"):
        swimmer.adopt(quick(period))
    swimmer.advance(1.0)
    assert swimmer.law.name == "falling"


def test_the_limit_can_be_raised_and_lowered():
    run = simulate(quick(1e-5), 1e-4, sample_period=1e-5, most_evaluations=1e8)
    assert run.time[-1] == pytest.approx(1e-4) and run.steps >= 100
    with pytest.raises(ValueError, match="most_evaluations is 5"):
        simulate(falling(), 1.0, most_evaluations=5.0)
    for bad in (0.0, -1.0, math.nan, "many"):
        with pytest.raises(ValueError, match="most_evaluations must be"):
            simulate(falling(), 1.0, most_evaluations=bad)
        with pytest.raises(ValueError, match="most_evaluations must be"):
            simulate_batch(falling(), 1.0, most_evaluations=bad)


def test_a_batch_takes_the_limit_as_a_single_run_does():
    laws, times = [quick(1e-5), straight()], {"duration": 1e-4, "sample_period": 1e-5}
    refused = simulate_batch(laws, **times)
    assert "most_evaluations is 5e+05" in str(refused.error[0]) and refused.error[1] is None
    batch, run = (
        simulate_batch(laws, **times, most_evaluations=1e8, stations=51),
        simulate(laws[0], **times, most_evaluations=1e8),
    )
    assert not batch.stopped.any()
    np.testing.assert_array_equal(batch.position[0], run.position)


def test_what_costs_more_on_the_way_stops_with_what_to_change(monkeypatch):
    """An initial velocity that takes a million steps per simulated second."""
    monkeypatch.setattr("eel_dynamics.accuracy.step_bounds.SPARE_STEPS", 500.0)
    monkeypatch.setattr("eel_dynamics.accuracy.step_bounds.LEAST_SPARE", 500.0)
    with pytest.raises(SimulationStopped, match=r"coarser accuracy, .* or raise most_evaluations") as caught:
        simulate(straight(), 1.0, twist=(0.0, 0.0, 1e5, 0.0, 0.0, 0.0), sample_period=1e-4)
    assert caught.value.run.time[-1] == caught.value.time < 0.1


@pytest.fixture
def hurried(monkeypatch):
    """A wall clock by which every look is a second after the one before."""
    for module in ("eel_dynamics.runs.progress_monitor", "eel_common.command.progress"):
        ticks = itertools.count()
        clock = type("Clock", (), {"monotonic": lambda ticks=ticks: float(next(ticks))})
        monkeypatch.setattr(f"{module}.time", clock)
    monkeypatch.setattr("eel_common.command.progress.QUIET", 2.0)


def test_progress_is_told_with_what_is_left(hurried):
    told = []
    simulate(falling(), 20.0, accuracy=1e-5, progress=lambda time, left: told.append((time, left)))
    times, left = np.array(told).T
    assert len(told) > 5 and (np.diff(times) > 0.0).all() and times[-1] < 20.0
    assert np.isnan(left[:5]).all() and np.isfinite(left).any()  # the first 6 s tell nothing
    known = np.isfinite(left)
    truth = (np.arange(len(told))[::-1] + 1.0)[known]  # s: a second for each look that was still to come
    assert (np.abs(np.log2(left[known] / truth)) <= 1.0).all()


def test_a_swim_that_takes_minutes_is_warned_of_once(hurried):
    sudden = Law(Term(amplitude=(2.0,), period=1.0, envelope=(Ramp(0.0, 1e-6, 1.0),)), name="sudden")
    with pytest.warns(UserWarning, match=r"swim of 200 s is going to take about [\d.e+]+ minutes") as caught:
        simulate(sudden, 200.0, accuracy=1e-5, sample_period=1.0)
    assert len(caught) == 1 and caught[0].filename == __file__


def test_a_swim_is_interrupted_from_the_keyboard(monkeypatch):
    """Between two slices Python has a look; the next swim of the same body is not touched by it."""

    def press(self, reached):
        raise KeyboardInterrupt

    wanted = simulate(falling(), 1.0, accuracy=1e-5)
    with monkeypatch.context() as patch:
        step_by_step(patch)
        patch.setattr("eel_dynamics.runs.progress_monitor.ProgressMonitor.update", press)
        with pytest.raises(KeyboardInterrupt):
            simulate(falling(period=0.9), 1.0, accuracy=1e-5)
    np.testing.assert_array_equal(simulate(falling(), 1.0, accuracy=1e-5).position, wanted.position)


def test_the_command_tells_how_far_a_swim_has_come_and_takes_the_limit(hurried, capsys):
    assert main(["falling", "--duration", "20", "--accuracy", "1e-5", "--stations", "5"]) == 0
    told = [line for line in capsys.readouterr().err.splitlines() if "of 20 simulated s" in line]
    assert re.fullmatch(r"eel simulate: [\d.]+ of 20 simulated s", told[0])  # too early to tell
    assert re.fullmatch(r"eel simulate: [\d.]+ of 20 simulated s, about [\d.]+ s left", told[-1])
    assert 3 <= len(told) <= 12  # seldom, of some twenty looks
    assert main(["falling", "--most-evaluations", "5"]) == 2
    assert "most_evaluations is 5" in capsys.readouterr().err
