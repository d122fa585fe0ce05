"""What a target promises: the delivered error stays below it and not far below, and each run can tell its own error.

Errors against a run with more points and smaller steps than any target has. The wide sweep over gaits, bodies and
scenes is `eel_dynamics.calibration`; here are cases of each kind, and laws with seeds that it has not seen.
"""

import warnings

import numpy as np
import pytest
from eel_dynamics.accuracy import table
from eel_dynamics.budget import Budget
from eel_dynamics.calibration import Case, cases, random_law, swim
from eel_dynamics.errors import errors

from eel_dynamics import Accuracy, Body, Scene, SimulationStopped, simulate
from eel_gaits import falling, gait

REFERENCE = Accuracy(name="test reference", resolution=150.0, tolerance=1e-13)
FAR = 150.0  # below the target: four cases in five are within 30, laws that are easier than the hardest are not
DRAGGED = {case.name: case for case in cases(drag=True)}
FREE = {case.name: case for case in cases(drag=False)}
UNSEEN = [
    Case(name="unseen, drag", law=random_law(11, 1.0), body=Body.boyer2010(), scene=Scene(ledger=False), duration=3.0),
    Case(
        name="unseen, no drag",
        law=random_law(12, 1.0),
        body=Body.kern2006(),
        scene=Scene(resistive=False, ledger=False),
        duration=3.0,
    ),
]
CASES = [
    *(DRAGGED[name] for name in ("falling, printed", "kern_fast, laminar", "rolling, laminar", "straight, planar")),
    *(FREE[name] for name in ("falling, no drag", "helix, no drag")),
    *UNSEEN,
]


@pytest.fixture(scope="module")
def references():
    known = {}

    def reference(case):
        if case.name not in known:
            known[case.name] = swim(case, REFERENCE)
        return known[case.name]

    return reference


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_delivered_error_is_below_the_target_and_not_far_below(case, references):
    rows = table()[case.scene.resistive, True]
    targets = (1e-2, 1e-3, 1e-4, 1e-6) if case.scene.resistive else (1e-2, 1e-4, 1e-6, 1e-8)
    for target in (each for each in targets if each >= rows[-1]["target"]):
        run = swim(case, target)
        found = errors(run, references(case)).worst
        assert found <= target, target
        coarsest = run.accuracy.tolerance == rows[0]["tolerance"]
        assert coarsest or found >= target / FAR, target


@pytest.mark.parametrize("case", CASES[::3], ids=lambda case: case.name)
def test_the_estimate_of_the_error_is_within_a_factor_ten(case, references):
    for target in (1e-2, 1e-4, 1e-6):
        run = swim(case, target)
        truth, estimate = errors(run, references(case)), run.error_estimate
        assert truth.position / 10.0 <= estimate.position <= 10.0 * truth.position
        assert truth.torque / 10.0 <= estimate.torque <= 10.0 * truth.torque


def test_a_target_beyond_the_table_says_what_is_possible():
    finest = table()[True, True][-1]["target"]
    with pytest.raises(ValueError, match="double precision"):
        Accuracy.of(1e-12)
    if finest > 1e-10:
        with pytest.raises(ValueError, match=f"{finest:g}"):
            simulate(falling(), 0.1, accuracy=1e-10)


def test_an_order_that_does_not_exist():
    with pytest.raises(ValueError, match="1 to 6, got 9"):
        Accuracy(name="x", resolution=20.0, method="adams", order=9)
    with pytest.raises(ValueError, match="must be 5, got 8"):
        Accuracy(name="x", resolution=20.0, order=8)
    with pytest.raises(ValueError, match="got 'euler'"):
        Accuracy(name="x", resolution=20.0, method="euler")


def test_a_budget_buys_the_finest_target_that_keeps_within_it(monkeypatch):
    """The timings are given here, so that no machine decides: 1 ms at 1e-2, ten times that for each hundredth."""
    monkeypatch.setattr("eel_dynamics.budget.seconds_per_second", lambda scene, target: 1e-3 * (1e-2 / target) ** 0.5)
    bought = Budget.of("fastest within 5 ms per second").in_scene(Scene())
    affordable = [row["target"] for row in table()[True, True] if 1e-3 * (1e-2 / row["target"]) ** 0.5 <= 5e-3]
    assert bought.target == min(affordable)
    with pytest.raises(ValueError, match="cannot be met"):
        Budget.of("fastest within 1 us per second").in_scene(Scene())


def test_a_budget_is_measured_on_this_machine():
    run = simulate(gait("straight"), 0.2, accuracy="fastest within 900 s per second", scene=Scene(planar=True))
    assert run.accuracy.target == table()[True, True][-1]["target"]  # so much time affords the finest


@pytest.mark.parametrize("text", ["fastest", "fastest within five ms", "fastest within -3 ms per second"])
def test_a_budget_that_cannot_be_read(text):
    with pytest.raises(ValueError, match="fastest within 5 ms per second"):
        Accuracy.of(text)


def test_verify_refines_what_misses_its_target():
    """Settings that pretend to a target they cannot deliver."""
    poor = Accuracy(name="poor", resolution=8.0, tolerance=1e-2, method="adams", order=3)
    scene = Scene(ledger=False)
    plain = simulate(falling(), 2.0, accuracy=poor, scene=scene)
    assert plain.error_estimate.worst > 1e-4
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = simulate(falling(), 2.0, accuracy=1e-3, scene=scene, verify=True)
    assert run.error_estimate.worst <= 1e-3
    with pytest.raises(ValueError, match="verify"):
        simulate(falling(), 0.1, accuracy=poor, verify=True)


def test_a_run_that_diverges_tells_the_step_that_would_have_been_stable():
    light = Scene(density=10.0, reactive=False, ledger=False)
    long = Accuracy(name="long", resolution=12.0, step=0.02)
    with pytest.raises(SimulationStopped, match=r"a step of \S+ s is stable; it was 0.02 s") as stopped:
        simulate(falling(), 1.0, scene=light, accuracy=long)
    step = float(stopped.value.hint.split("step of ")[1].split(" s")[0])
    run = simulate(falling(), 1.0, scene=light, accuracy=Accuracy(name="short", resolution=12.0, step=step))
    assert np.all(np.isfinite(run.position))
