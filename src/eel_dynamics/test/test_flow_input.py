# SPDX-License-Identifier: Apache-2.0
"""Flows as arguments: what does not fit is named; batches, copies and files have them."""

import copy

import numpy as np
import pytest

from eel_dynamics import (
    Batch,
    FlowField,
    Gust,
    Run,
    Scene,
    Shear,
    Simulation,
    SimulationStopped,
    Uniform,
    Vortex,
    VortexStreet,
    Wave,
    simulate,
    simulate_batch,
)
from eel_gaits import straight

QUICK = {"accuracy": 1e-2, "estimate": False, "sample_period": 0.25}
ALL = Uniform([0.1, 0.0, 0.0]) + Gust() + Shear() + Vortex() + VortexStreet() + Wave()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Uniform((0.1, 0.0)), "flow velocity must be 3 numbers"),
        (lambda: Uniform((0.1, np.nan, 0.0)), "flow velocity must be finite, got nan at index 1"),
        (lambda: Uniform(((0, 0, 0), (1, 0, 0)), time=(1.0, 1.0)), "flow time must be two instants or more that rise"),
        (lambda: Uniform(((0, 0), (1, 0)), time=(0.0, 1.0)), r"flow velocity must be finite, of shape \(2, 3\)"),
        (lambda: Gust(rise=0.0), "rise must be > 0 s, got 0.0"),
        (lambda: Shear(width=-1.0), "width must be > 0 m, got -1.0"),
        (lambda: Shear(across=(0.0, 0.0, 0.0)), "flow across must have a direction"),
        (lambda: Shear(velocity=(1.0, 1.0, 0.0)), "flow across must be normal to the velocity"),
        (lambda: Shear(profile="step"), "profile"),
        (lambda: Vortex(core=0.0), "core must be > 0 m, got 0.0"),
        (lambda: VortexStreet(count=0), "count must be >= 1"),
        (lambda: Wave(direction=(0.0, 0.0)), "flow direction must have a direction"),
        (lambda: FlowField(3.0), "flow function must be a function of places and time, got 3.0"),
        (lambda: FlowField(np.zeros_like, step=0.0), "flow step must be > 0 m"),
        (lambda: Vortex().sample([0.0, np.inf, 0.0]), "places must be finite"),
        (lambda: Simulation(flow=0.3), "flow must be a Flow, got 0.3"),
        (lambda: Simulation(flow=Wave(surface=-0.1)), "flow surface must be above the head, at z = 0 m"),
        (lambda: Simulation(scene=Scene(planar=True), flow=Gust() + Wave()), "flow must stay in the plane .* Wave"),
        (lambda: Simulation(scene=Scene(planar=True), flow=Uniform((0, 0, 0.1))), "flow must stay in the plane"),
        (lambda: Simulation(scene=Scene(planar=True), flow=Shear(across=(0, 0, 1))), "flow must stay in the plane"),
        (lambda: simulate_batch(straight(), 1.0, flows=[Gust(), 3]), r"flows\[1\] must be a Flow"),
        (lambda: simulate_batch([straight()] * 3, 1.0, flows=[Gust()] * 2), "flows must be one, or as many as laws"),
        (lambda: simulate_batch(straight(), 1.0, flows=[None, Wave(surface=-1)]), "swimmer 1: flow surface must be"),
    ],
)
def test_what_does_not_fit_is_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (
            lambda x, t: x[:, :2],
            r"flow 'pool': function must give shape \(\d+, 3\), got \(\d+, 2\) at \(.*\) m and .* s",
        ),
        (lambda x, t: np.where(t > 0.3, np.nan, 0.0 * x), r"flow 'pool': function must be finite, .* m and 0\.3\d* s"),
        (lambda x, t: x @ np.zeros(2), r"flow 'pool': function failed at \(.*\) m and 0 s: matmul"),
        (
            lambda x, t: 0.0 * x + [0.0, 0.0, 0.1],
            r"flow 'pool' must have no part along z in a planar scene, got 0.1 m/s",
        ),
    ],
)
def test_a_function_that_does_not_fit_is_named_with_place_and_time(function, message):
    """Once it is put right, the march goes on from where it was."""
    with pytest.raises(ValueError, match=message):
        simulate(straight(), 1.0, scene=Scene(planar=True), flow=FlowField(function, name="pool"), **QUICK)


def test_a_march_stands_where_it_was_after_a_function_has_failed():
    fails = []

    def function(x, t):
        if fails:
            raise ValueError("no water")
        return 0.1 + 0.0 * x

    simulation = Simulation(law=straight(), flow=FlowField(function), accuracy=1e-4)
    simulation.advance(0.5)
    before = simulation.state
    fails.append(True)
    with pytest.raises(ValueError, match="no water"):
        simulation.advance(1.0)
    fails.clear()
    assert simulation.time == 0.5 and np.array_equal(simulation.state, before)
    simulation.advance(1.0)
    through = Simulation(law=straight(), flow=FlowField(function), accuracy=1e-4)
    through.advance(1.0)
    assert np.allclose(simulation.state, through.state, atol=1e-5)


def test_a_swimmer_that_a_wave_throws_out_of_the_water_is_told_so():
    wave = Wave(wavelength=1.5, surface=0.3)
    with pytest.raises(SimulationStopped, match="the head is above the surface of the flow, z"):
        simulate(straight(), 8.0, flow=wave, **QUICK)


def test_a_run_is_saved_with_its_flow(tmp_path):
    run = simulate(straight(), 0.5, flow=ALL, **QUICK)
    run.save(tmp_path / "run.nc")
    assert Run.load(tmp_path / "run.nc") == run
    assert run.refined.flow == ALL
    assert run.in_axes("paper").in_axes("rep103") == run


def test_a_batch_is_that_of_its_swimmers_and_is_saved(tmp_path):
    flows = [None, Vortex(), ALL]
    batch = simulate_batch(straight(), 0.5, flows=flows, stations=21, **QUICK)
    for index, flow in enumerate(flows):
        assert batch[index] == simulate(straight(), 0.5, flow=flow, stations=21, **QUICK)
    batch.save(tmp_path / "batch.nc")
    assert Batch.load(tmp_path / "batch.nc") == batch
    assert copy.deepcopy(batch) == batch


def test_a_file_holds_the_name_of_a_function(tmp_path):
    run = simulate(straight(), 0.5, flow=FlowField(lambda x, t: 0.1 * np.sin(x), name="sines"), **QUICK)
    run.save(tmp_path / "run.nc")
    loaded = Run.load(tmp_path / "run.nc")
    assert loaded.flow.name == "sines" and np.array_equal(loaded.position, run.position)
    with pytest.raises(ValueError, match="flow 'sines' is a function, which its file does not hold"):
        _ = loaded.refined


def test_without_a_flow_nothing_changes():
    """Nor does water that does not move: to round-off, as its terms are then added, and 0."""
    none, still = (simulate(straight(), 1.0, flow=flow, **QUICK) for flow in (None, Uniform((0.0, 0.0, 0.0))))
    assert not none.energy.flow_power.any() and not none.energy.flow_work.any()
    assert np.allclose(none.position, still.position, rtol=0.0, atol=1e-13)
    assert np.allclose(none.force, still.force, rtol=0.0, atol=1e-11)
