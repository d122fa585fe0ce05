# SPDX-License-Identifier: Apache-2.0
"""Every run measures its own error: on the safe side, or it says that its target is missed."""

import warnings
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.accuracy import accuracy as settings
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.runs import companion
from eel_dynamics.runs.companion import relative_errors
from studied import random_swims

from eel_dynamics import Accuracy, Body, Robot, Scene, Simulation, simulate, simulate_batch
from eel_gaits import falling, still, straight

FINE = Accuracy(name="fine settings", resolution=70.0, tolerance=1e-11)
SENSITIVE = {
    "law": falling(period=0.4),
    "duration": 9.0,
    "scene": Scene(density=3000.0, friction="laminar"),
    "sample_period": 0.05,
}


def run_at(position, time, torque=None, turn=0.0, twist=0.0):
    """As a run, of a body of 1 m and 2 kg, with a law of period 1 s; heads turned by `turn` [rad] about z, (T,)."""
    law = SimpleNamespace(waves=[SimpleNamespace(period=1.0)])
    path = float(np.linalg.norm(np.diff(position, axis=0), axis=1).sum())
    half = 0.5 * np.broadcast_to(turn, time.shape)
    return SimpleNamespace(
        law=law,
        body=SimpleNamespace(length=1.0),
        body_mass=2.0,
        time=time,
        position=position,
        path_length=path,
        torque=torque,
        orientation=np.column_stack((0.0 * time, 0.0 * time, np.sin(half), np.cos(half))),
        twist=np.broadcast_to(twist, (len(time), 6)),
        robot=None,
    )


@pytest.mark.parametrize("rate", [0.0, 0.7, 3.0])
def test_the_growth_of_a_linear_problem_is_found(rate):
    """The distance obeys d' = rate d."""
    time = np.linspace(0.0, 4.0, 81)
    straight_on = np.column_stack((time, 0.0 * time, 0.0 * time))
    beside = straight_on + np.outer(1e-9 * np.exp(rate * time), (0.0, 1.0, 0.0))
    found = relative_errors(run_at(beside, time), run_at(straight_on, time))
    assert found.position == pytest.approx(1e-9 * np.exp(4.0 * rate) / 4.0)
    assert found.growth_rate == pytest.approx(rate, abs=1e-6)
    assert found.round_off(4.0) == pytest.approx(2e-16 * np.exp(4.0 * rate), rel=1e-4)


def test_a_distance_that_has_saturated_still_tells_its_growth():
    time = np.linspace(0.0, 10.0, 201)
    still = np.zeros((201, 3))
    beside = still + np.outer(np.minimum(1e-9 * np.exp(5.0 * time), 0.5), (1.0, 0.0, 0.0))
    found = relative_errors(run_at(beside, time), run_at(still, time))
    assert found.growth_rate == pytest.approx(5.0, rel=1e-3) and found.position == 0.5
    assert found.hopeless(1e-3, 10.0)
    assert "grow by a factor of e in 0.2 s, so that round-off alone may spoil it" in found.over_target(1e-3, 10.0)


def test_torques_that_are_round_off_have_no_relative_error():
    """The floor is a thousandth of m (l/T)^2 = 2 N m."""
    time, still = np.linspace(0.0, 1.0, 21), np.zeros((21, 3))
    tiny = np.full((21, 5, 3), 1e-15)
    found = relative_errors(run_at(still, time, tiny), run_at(still, time, -tiny))
    assert found.torque == pytest.approx(2e-15 * np.sqrt(3.0) / 2e-3)


def test_errors_of_the_head_s_turn_and_twist_are_by_their_scales():
    """Turns in rad, of q and -q alike; velocities by the greatest speed; slow turns by a thousandth of 1/T."""
    time, still = np.linspace(0.0, 1.0, 21), np.zeros((21, 3))
    true = run_at(still, time, turn=2.0 * time, twist=(0.0, 0.0, 0.0, 2.0, 0.0, 0.0))
    run = run_at(still, time, turn=2.0 * time + 2.0 * np.pi + 3e-4, twist=(0.0, 0.0, 1e-6, 2.0, 4e-4, 0.0))
    found = relative_errors(run, true)
    assert found.orientation == pytest.approx(3e-4) and found.twist == pytest.approx(1e-6 / 1e-3)
    for swim in (run, true):
        swim.twist = swim.twist + np.array((0.0, 0.0, 5.0, 0.0, 0.0, 0.0))
    assert relative_errors(run, true).twist == pytest.approx(4e-4 / 2.0, rel=1e-3)
    assert found.worst == found.position == 0.0 and (found.joint_angle, found.joint_rate) == (None, None)


def test_what_is_missed_is_said_in_one_line():
    assert ErrorEstimate(1e-5, 2e-4).over_target(1e-3, 10.0) == ErrorEstimate(1.0, None).over_target(None, 10.0) == ""
    assert (
        ErrorEstimate(2e-3, None).over_target(1e-3, 1.0) == "the error is estimated at 2.0e-03, above the target 0.001"
    )
    assert "not known" in ErrorEstimate(np.inf, None).over_target(1e-3, 1.0)


@pytest.mark.soak
def test_a_sensitive_swim_converges_or_is_told(monkeypatch):
    """Settings that suit other swims end this one far away: errors grow by a factor of e in half a second."""
    bare = simulate(**SENSITIVE, accuracy=1e-3, estimate=False)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = simulate(**SENSITIVE, accuracy=1e-3)
    true = simulate(**SENSITIVE, accuracy=replace(FINE, resolution=120.0, tolerance=1e-13), estimate=False)
    assert relative_errors(bare, true).position > 0.01
    assert relative_errors(run, true).worst < run.error_estimate.worst <= 1e-3
    assert run.error_estimate.growth_rate > 1.0 and run.accuracy.target == 1e-3
    monkeypatch.setattr(companion, "MOST_REFINEMENTS", 1)  # enough for what no settings help
    longer = {**SENSITIVE, "duration": 25.0}
    with pytest.warns(UserWarning, match="above the target 1e-06: the motion is sensitive"):
        lost = simulate(**longer, accuracy=1e-6)
    assert lost.warnings[0].startswith("the error is estimated at")
    batch = simulate_batch(
        [still(), longer["law"]], 25.0, scenes=longer["scene"], accuracy=1e-6, stations=51, sample_period=0.05
    )
    assert batch.above_target.tolist() == [False, True]
    assert batch.error_estimates[1] == lost.error_estimate


def test_settings_that_were_given_are_kept_and_their_error_is_measured():
    poor = Accuracy(name="poor", resolution=8.0, tolerance=1e-2, method="adams", order=3)
    run = simulate(falling(), 2.0, accuracy=poor, scene=Scene(ledger=False))
    assert run.accuracy == poor and run.error_estimate.worst > 1e-4
    assert simulate(falling(), 2.0, accuracy=poor, estimate=False).error_estimate is None
    assert simulate(falling(), 0.0).error_estimate is None


def test_a_refined_run_has_a_smaller_error():
    swim = {"duration": 3.0, "scene": Scene(ledger=False), "stations": 11, "twist": (0.0, 0.1, 0.0, 0.1, 0.0, 0.0)}
    run = simulate(straight(), **swim, accuracy=1e-3, estimate=False)
    true = simulate(straight(), **swim, accuracy=FINE, estimate=False)
    assert relative_errors(run.refined, true).worst < 0.5 * relative_errors(run, true).worst
    np.testing.assert_array_equal(run.refined.time, run.time)


def test_the_estimate_of_a_refined_run_falls_with_the_tolerance_at_most(monkeypatch):
    """Errors vary unevenly with the tolerance, so that two runs may have nearly the same one."""
    apart = iter([ErrorEstimate(5e-3, None), ErrorEstimate(1e-12, None)])
    monkeypatch.setattr(companion, "relative_errors", lambda run, other: next(apart))
    run = simulate(straight(), 1.0, scene=Scene(internal_wrench=False, ledger=False), accuracy=1e-3)
    assert run.error_estimate.position == pytest.approx(5e-3 * run.accuracy.tolerance / (1e-3 / settings.STEPS_ERRORS))


@pytest.mark.parametrize(
    ("body", "wrench"), [(Body.boyer2010(), True), (Body.boyer2010(), False), (Body.kern2006(), True)]
)
@pytest.mark.parametrize("target", [1e-1, 1e-2, 1e-4])
def test_the_companion_has_another_grid(body, wrench, target):
    """Nodes come in blocks of eight: on a coarse grid half of the points may be the same nodes."""
    run = simulate(
        straight(), 0.5, body=body, scene=Scene(internal_wrench=wrench, ledger=False), accuracy=target, stations=5
    )
    error = run.error_estimate
    assert error.cost % error.evaluations == 0  # one companion: nothing was refined
    assert error.cost // error.evaluations != run.nodes


@pytest.mark.parametrize("robot", ["eight_servos", "passive_tail"])
def test_errors_that_no_target_promises_are_measured_too(robot):
    swim = {"duration": 1.0, "robot": Robot.named(robot), "stations": 11}
    run = simulate(straight(), **swim, accuracy=1e-3)
    exact = Accuracy(name="exact", resolution=60.0, tolerance=1e-7)
    true = relative_errors(run, simulate(straight(), **swim, accuracy=exact, estimate=False)).errors
    estimated = run.error_estimate.errors
    assert list(estimated) == list(true) == ["position", "torque", "orientation", "twist", "joint_angle", "joint_rate"]
    assert all(0.0 < true[name] < estimated[name] < 1e-2 for name in true), (true, estimated)
    assert "not promised        orientation" in run.summary() and "joint rates" in run.summary()


def estimate_with(monkeypatch, run, **changed):
    """The estimate of `run`, with companions whose settings are `changed`."""
    for name, value in changed.items():
        monkeypatch.setattr(settings, name, value)
    again = simulate(run.law, 3.0, scene=run.scene, accuracy=run.accuracy, stations=11)
    monkeypatch.undo()
    return again.error_estimate


def test_settings_to_refine_are_cheaper_and_others_keep_their_room():
    """A node's motion cannot be made finer, so only `simulate` and `simulate_batch` begin with the cheaper settings."""
    swim = {"law": straight(), "duration": 1.0, "accuracy": 1e-2}
    measured, bare = simulate(**swim), simulate(**swim, estimate=False)
    node = Simulation(law=straight(), accuracy=1e-2)
    assert bare.accuracy == node.accuracy and len(node.grid.x) == bare.nodes
    assert measured.accuracy.tolerance > 2.0 * bare.accuracy.tolerance
    assert measured.nodes * measured.evaluations < bare.nodes * bare.evaluations
    assert simulate_batch([straight()], 1.0, accuracy=1e-2).accuracies[0] == measured.accuracy
    assert simulate(**swim | {"accuracy": measured.accuracy}, estimate=False).accuracy == measured.accuracy


def test_a_companion_on_nearly_the_same_grid_would_miss_the_error_of_the_grid(monkeypatch):
    few = Accuracy(name="few points", resolution=6.0, tolerance=1e-11)
    run = simulate(straight(), 3.0, scene=Scene(ledger=False), accuracy=few, stations=11)
    true = relative_errors(run, simulate(straight(), 3.0, scene=run.scene, accuracy=FINE, stations=11, estimate=False))
    assert run.error_estimate.worst > 0.9 * true.worst  # no coarser grid is left: the companion has a finer one
    monkeypatch.setattr(Accuracy, "with_other_points", lambda self: self)
    assert estimate_with(monkeypatch, run, FEWER_POINTS=1.0).worst < 0.1 * true.worst


def test_a_companion_with_the_same_steps_would_miss_the_error_of_the_steps(monkeypatch):
    loose = Accuracy(name="long steps", resolution=70.0, tolerance=1e-3)
    run = simulate(straight(), 3.0, scene=Scene(ledger=False), accuracy=loose, stations=11)
    true = relative_errors(run, simulate(straight(), 3.0, scene=run.scene, accuracy=FINE, stations=11, estimate=False))
    assert run.error_estimate.worst > true.worst
    monkeypatch.setattr(Accuracy, "by_adams", lambda self: self)
    assert estimate_with(monkeypatch, run, LOOSER=1.0, LONGER_STEPS=1.0).worst < 0.1 * true.worst


@pytest.mark.timeout(3600)  # two thousand take a quarter of an hour on two cores
@pytest.mark.parametrize(
    ("count", "seed"), [(40, 2026), pytest.param(2000, 11, marks=pytest.mark.soak, id="two thousand")]
)
def test_random_swims_keep_their_target_or_say_so(count, seed, monkeypatch):
    """docs/explanation/accuracy.md quotes the counts of another seed and other durations."""
    monkeypatch.setattr(random_swims, "DURATIONS", (1.0, 6.0) if count < 1000 else (1.0, 60.0))
    trials = random_swims.deliver(count, seed)
    assert len(trials) > 0.97 * count
    assert not any(each.missed for each in trials)
    assert sum(each.error is None and not each.reported for each in trials) <= count // 200
    known = [each for each in trials if each.error is not None]
    assert len(known) > 0.9 * count
    ratios = np.array([each.underestimated for each in known])
    assert (ratios > 1.0).mean() <= 0.02 and (ratios > 2.0).sum() <= max(1, count // 500)
    assert np.median([each.cost for each in trials]) < 1.6
