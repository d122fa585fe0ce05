# SPDX-License-Identifier: Apache-2.0
"""What an accuracy gives: settings by one rule from the target and the scene, budgets of time, bad input."""

from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.accuracy.accuracy import BUDGET_TARGETS
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.simulation.simulation_setup import SimulationSetup
from eel_dynamics.simulation.time_budget import swim_time
from eel_gaits.laws.law import Law
from eel_gaits.laws.term import Term

from eel_dynamics import (
    Accuracy,
    Body,
    Fin,
    FlowField,
    GriddedFlow,
    Robot,
    RollHold,
    Scene,
    Shear,
    Simulation,
    SimulationStopped,
    simulate,
    simulate_batch,
)
from eel_gaits import falling, gait, straight

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


def test_a_budget_buys_the_finest_target_that_keeps_within_it(monkeypatch):
    """The timings are given here, so that no machine decides: 1 ms at 1e-2, ten times that for each hundredth."""
    monkeypatch.setattr(
        "eel_dynamics.simulation.time_budget.swim_time",
        lambda setup: 1e-3 * (1e-2 / float(setup.accuracy.name)) ** 0.5,
    )
    bought = Simulation(accuracy="fastest within 5 ms per second").accuracy
    affordable = [target for target in BUDGET_TARGETS if 1e-3 * (1e-2 / target) ** 0.5 <= 5e-3]
    assert bought == replace(Accuracy.of(min(affordable)).in_scene(Scene()), name=bought.name, target=None)
    with pytest.raises(ValueError, match="cannot be met"):
        Simulation(accuracy="fastest within 1 us per second")


def test_a_budget_is_measured_for_the_body_scene_and_stations_at_hand(monkeypatch):
    """A body of many panels takes longer, so the same time affords less. The timings are given here."""
    asked = []

    def swim_time(setup):
        asked.append((setup.body, setup.scene, setup.x.tobytes()))
        return 1e-3 * (len(setup.body.panel_ends) / 3.0) ** 4 * (1e-2 / float(setup.accuracy.name)) ** 0.5

    monkeypatch.setattr("eel_dynamics.simulation.time_budget.swim_time", swim_time)
    body, scene, x = Body.kern2006(0.3), Scene(density=700.0), np.array([0.0, 0.1])
    few = Simulation(body, scene, "fastest within 5 ms per second", x).accuracy
    assert set(asked) == {(body, scene, x.tobytes())}
    many = Simulation(accuracy="fastest within 5 ms per second").accuracy
    assert few.tolerance < many.tolerance and few.target is many.target is None


def test_the_time_of_a_swim_is_of_that_body():
    coarse = Accuracy(name="coarse", resolution=8.0, tolerance=1e-4)
    setup = SimulationSetup.of(body=Body.kern2006(0.3), scene=Scene(planar=True), stations=[0.0], accuracy=coarse)
    assert swim_time(setup) > 0.0


def test_a_budget_is_measured_in_the_water_and_with_the_fins_and_the_robot_at_hand(monkeypatch):
    asked, places = [], []

    def water(x, t):
        places.append(len(x))
        return 0.0 * x

    fast, coarse = "fastest within 900 s per second", Accuracy(name="coarse", resolution=8.0, tolerance=1e-4)
    swim_time(SimulationSetup.of(scene=Scene(planar=True), flow=FlowField(water), stations=[0.0], accuracy=coarse))
    assert len(places) > 4 * 40  # four swims of two seconds
    monkeypatch.setattr("eel_dynamics.simulation.time_budget.swim_time", lambda setup: asked.append(setup) or 1e-3)
    fins, robot = Fin.pair(0.2, 1e-3, 2.5, angle=RollHold(2.0, 0.15), time_constant=0.05), Robot.named("eight_servos")
    Simulation(accuracy=fast, fins=[fins], flow=Shear(), position=(1.0, 0.0, 0.0))
    Simulation(accuracy=fast, robot=robot)
    assert {(each.flow, each.robot, each.fins, *each.initial_state.position.tolist()) for each in asked} == {
        (Shear(), None, fins, 1.0, 0.0, 0.0),
        (None, robot, (), 0.0, 0.0, 0.0),
    }


def test_a_budget_is_refused_where_the_swim_that_is_timed_stops():
    still = GriddedFlow(np.zeros((4, 4, 3)), x=np.linspace(-1.2, 0.3, 4), y=np.linspace(-0.6, 0.6, 4))
    with pytest.raises(ValueError, match=r"accuracy cannot be a budget of time here: 2 s of the gait falling.*grid"):
        Simulation(accuracy="fastest within 5 ms per second", flow=still, twist=(0, 0, 0, 1.0, 0, 0))


def test_a_budget_is_measured_on_this_machine():
    run = simulate(gait("straight"), 0.2, accuracy="fastest within 900 s per second", scene=Scene(planar=True))
    finest = Accuracy.of(BUDGET_TARGETS[-1]).in_scene(run.scene)
    assert run.accuracy.tolerance == finest.tolerance  # so much time affords the finest
    assert run.accuracy.target is None and 0.0 < run.error_estimate.worst < 100.0 * BUDGET_TARGETS[-1]
    assert not any("target" in each for each in run.warnings)
    batch = simulate_batch(
        [gait("straight")] * 2, 0.2, accuracy="fastest within 900 s per second", scenes=Scene(planar=True)
    )
    assert list(batch.accuracies) == [run.accuracy] * 2 and not batch.above_target.any()
    np.testing.assert_array_equal(batch.position, [run.position] * 2)


@pytest.mark.parametrize("text", ["fastest", "fastest within five ms", "fastest within -3 ms per second"])
def test_a_budget_that_cannot_be_read(text):
    with pytest.raises(ValueError, match="fastest within 5 ms per second"):
        Accuracy.of(text)


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
        swimmer.adopt(Law(Term(amplitude=(1e200,), wavelength=1.0, period=1e-3)))
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
