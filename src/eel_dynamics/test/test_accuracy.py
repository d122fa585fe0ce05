# SPDX-License-Identifier: Apache-2.0
"""What an accuracy gives: settings by one rule from the target and the scene, bad input."""

import numpy as np
import pytest
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.runs.storage.plain import READERS
from eel_gaits.laws.law import Law
from eel_gaits.laws.term import Term

from eel_dynamics import (
    Accuracy,
    Scene,
    Simulation,
    SimulationStopped,
    simulate,
)
from eel_gaits import falling, straight

REFERENCE = Accuracy(name="reference", resolution=150.0, tolerance=1e-12)
ALONE = Scene(internal_wrench=False, ledger=False)


@pytest.mark.parametrize("target", [1e-2, 1e-4])
@pytest.mark.parametrize("friction", ["laminar", "printed"])
def test_fixed_steps_deliver_the_target_too(friction, target):
    swim = {"law": falling(), "duration": 5.0, "scene": Scene(friction=friction, ledger=False), "stations": 11}
    run = simulate(**swim, accuracy=f"{target:g}, fixed steps")
    assert run.accuracy.method == "classical"
    assert run.evaluations == pytest.approx(4 * run.steps, rel=0.02)
    assert relative_errors(run, simulate(**swim, accuracy=REFERENCE, estimate=False)).worst <= target


def test_a_finer_target_gets_more_points_and_a_smaller_tolerance():
    coarse, fine = (Accuracy.of(target).in_scene(Scene()) for target in (1e-3, 1e-5))
    assert fine.tolerance == pytest.approx(1e-2 * coarse.tolerance)
    assert fine.resolution == pytest.approx(coarse.resolution + 16.0)
    assert Accuracy.of(1e-3).in_scene(ALONE).method == "adams" and coarse.method == "dormand_prince"


def test_targets_beyond_double_precision_are_refused():
    with pytest.raises(ValueError, match="double precision"):
        Accuracy.of(1e-12)


def test_an_order_that_does_not_exist():
    with pytest.raises(ValueError, match="1 to 6, got 9"):
        Accuracy(name="x", resolution=20.0, method="adams", order=9)
    with pytest.raises(ValueError, match="must be 5, got 8"):
        Accuracy(name="x", resolution=20.0, order=8)
    with pytest.raises(ValueError, match="got 'euler'"):
        Accuracy(name="x", resolution=20.0, method="euler")


def test_a_budget_of_time_is_no_accuracy():
    """What it buys depends on the machine: `eel tradeoff --within` tells."""
    with pytest.raises(ValueError, match=r"accuracy must be one of draft, .* or a target relative error"):
        Accuracy.of("fastest within 5 ms per second")
    assert READERS["accuracy"]({"budget": "fastest within 5 ms per second"}).target is None  # of an older file


def test_a_run_that_diverges_tells_the_step_that_would_have_been_stable():
    light = Scene(density=10.0, reactive=False, ledger=False)
    long = Accuracy(name="long", resolution=12.0, step=0.02)
    with pytest.raises(SimulationStopped, match=r"a step of \S+ s is stable; it was 0.02 s") as stopped:
        simulate(falling(), 1.0, scene=light, accuracy=long)
    step = float(stopped.value.hint.split("step of ")[1].split(" s")[0])
    run = simulate(falling(), 1.0, scene=light, accuracy=Accuracy(name="short", resolution=12.0, step=step))
    assert np.all(np.isfinite(run.position))


def test_a_body_bent_into_turns_gets_more_points():
    """Settings given one by one stay as they are."""
    rolled = straight(wavelength=100.0, amplitude_0=12.0, amplitude_1=6.0, amplitude_2=24.0)
    usual, more = (len(Simulation(accuracy=1e-3, law=law).grid.x) for law in (straight(), rolled))
    assert more > usual
    own = Accuracy(name="own", resolution=20.0, tolerance=1e-4)
    assert Simulation(accuracy=own, law=rolled).accuracy == own
    swimmer = Simulation(accuracy=1e-3, law=straight())
    swimmer.adopt(rolled)
    assert len(swimmer.grid.x) == more
    with pytest.raises(ValueError, match="at most 200"):
        swimmer.adopt(Law(Term(amplitude=(1e29,), wavelength=1.0, period=1e-3)))
    assert len(swimmer.grid.x) == more
    run = simulate(rolled, 4.0, accuracy=1e-3)
    assert run.error_estimate.worst < 1e-3


@pytest.mark.parametrize("target", ["x", -1.0, 5.0, np.nan, True])
def test_a_target_is_checked(target):
    with pytest.raises(ValueError, match=r"accuracy target must be (a number|finite|[<>]= )"):
        Accuracy(name="mine", resolution=30.0, target=target)


def test_a_step_and_a_target_exclude_each_other():
    with pytest.raises(ValueError, match=r"accuracy step cannot be given beside a target, got 0.01 s"):
        Accuracy(name="mine", resolution=30.0, step=0.01, target=1e-3)
