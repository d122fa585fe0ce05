# SPDX-License-Identifier: Apache-2.0
"""Runs one after another, of which some share tables of body, scene and law: nothing of one is in the next."""

import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term

from eel_dynamics import Accuracy, Body, Scene, Simulation, SimulationStopped, simulate
from eel_gaits import falling, helix, kern_fast, straight, turning

SHORT_WAVES = Law(Term(axis="yaw", amplitude=(6.0,), wavelength=0.2, period=0.5, envelope=(Ramp(0.0, 0.5, 1.0),)))
ENTRIES = "position", "orientation", "twist", "head_acceleration", "backbone", "curvature", "torque", "closure_torque"
SWIMS = (
    {"law": falling(), "duration": 2.0},
    {"law": straight(), "duration": 1.0, "stations": 7},
    {"law": straight(), "duration": 1.0, "stations": [0.0, 0.3]},
    {"law": helix(), "duration": 1.0, "position": (1.0, 2.0, 3.0), "twist": (0.0, 0.0, 1.0, -0.5, 0.0, 0.1)},
    {"law": straight(), "duration": 0.5, "twist": (40.0, -30.0, 20.0, 9.0, -8.0, 7.0)},  # fast: other settings
    {"law": SHORT_WAVES, "duration": 0.5},  # another grid
    {"law": turning(), "duration": 1.0, "load": True},
    {"law": turning(), "duration": 1.0, "scene": Scene(friction="laminar", current=(0.1, 0.0, 0.0))},
    {"law": kern_fast(), "duration": 1.0, "body": Body.kern2006()},
    {"law": falling(), "duration": 2.0, "accuracy": 1e-6},
)


def fresh(**arguments):
    """The run in a thread of its own."""
    found = []
    thread = threading.Thread(target=lambda: found.append(simulate(**arguments)))
    thread.start()
    thread.join()
    return found[0]


def assert_same(run, other):
    for name in ENTRIES:
        np.testing.assert_array_equal(getattr(run, name), getattr(other, name), err_msg=name)
    names = run.energy.keys()
    for name in names:
        np.testing.assert_array_equal(run.energy[name], other.energy[name], err_msg=name)
    assert (run.steps, run.evaluations) == (other.steps, other.evaluations)
    assert run.accuracy == other.accuracy


@pytest.mark.parametrize("order", (slice(None), slice(None, None, -1)))
def test_a_run_does_not_know_of_those_before(order):
    body = Body.kern2006()
    for arguments in (*SWIMS[order], *SWIMS[order]):
        arguments = arguments if "body" not in arguments else arguments | {"body": body}
        assert_same(simulate(**arguments), fresh(**arguments))


def test_runs_in_eight_threads_are_those_of_one():
    alone = [simulate(**arguments) for arguments in SWIMS]
    together = SWIMS * 3
    with ThreadPoolExecutor(8) as pool:
        runs = list(pool.map(lambda arguments: simulate(**arguments), together))
    assert len(runs) == len(together)
    for index, run in enumerate(runs):
        assert_same(run, alone[index % len(alone)])


def test_a_run_keeps_its_own_arrays():
    first = simulate(straight(), 1.0)
    before = first.position.copy(), first.torque.copy(), first.x.copy()
    second = simulate(straight(wavelength=0.8), 1.0)
    for run in (first, second):
        run.x[:] += 1.0  # the user's to write in
    third = simulate(straight(), 1.0)
    for array, kept in zip((third.position, third.torque, third.x), before, strict=True):
        np.testing.assert_array_equal(array, kept)
    np.testing.assert_array_equal(first.position, before[0])


def test_one_that_stops_leaves_nothing_behind():
    light, long = Scene(density=10.0, reactive=False), Accuracy(name="long", resolution=12.0, step=0.02)
    settings = {"scene": light, "accuracy": long}
    with pytest.raises(SimulationStopped):
        simulate(falling(), 1.0, **settings)
    gentle = {"law": straight(period=20.0), "duration": 1.0, **settings}
    assert_same(simulate(**gentle), fresh(**gentle))
    beyond = Law(Term(axis="yaw", amplitude=(1e29,), wavelength=1.0, period=1.0), name="beyond")
    for _ in range(2):
        with pytest.raises(ValueError, match="'beyond' bends the body into"):
            simulate(beyond, 1.0)
    assert_same(simulate(straight(), 1.0), fresh(law=straight(), duration=1.0))


def test_a_whole_number_of_seconds_will_do():
    swimmer = Simulation(law=straight())
    swimmer.advance(1)
    assert swimmer.time == 1.0
    np.testing.assert_array_equal(
        swimmer.observe().position, simulate(straight(), 1, sample_period=1, estimate=False).position[-1]
    )
