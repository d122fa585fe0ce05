# SPDX-License-Identifier: Apache-2.0
"""External wrenches: the energy ledger, and the steps at jumps."""

import itertools

import numpy as np
import pytest
from flows import FLOWS
from random_robots import drawn
from test_appendages import SOFT
from test_blunt_robots import NO_CROSS_FLOW
from test_reference_bending import WAVE
from wrench_cases import NO_WATER, RIPPLE, STRAIGHT, about_centre, works_of

from eel_dynamics import Accuracy, Body, ExternalWrench, Scene, Simulation, simulate
from eel_gaits import falling, straight

SWIMS = {
    "imposed": {"law": falling(), "twist": (0.1, 0.0, 0.2, 0.3, 0.1, 0.0)},
    "planar": {"law": straight(), "scene": Scene(planar=True, friction="laminar")},
    "current": {"law": falling(), "scene": Scene(current=(0.2, -0.1, 0.05), friction="laminar")},
    "shear": {"law": straight(), "flow": FLOWS["shear"][1], "scene": Scene(friction="laminar")},
}


@pytest.mark.parametrize("name", SWIMS)
def test_the_ledger_closes_with_wrenches_of_all_kinds(name):
    """A constant, a table that jumps and bends, a function; each of them feeds energy in or takes it."""
    planar = name == "planar"
    plane = np.array([1.0, 1.0, 0.0]) if planar else np.ones(3)
    table = {"time": (0.2, 0.5, 0.5, 0.9), "force": plane * [[0, 0, 0], [0.5, 0.2, 0.1], [-0.5, 0.1, 0.3], [0.4, 0, 0]]}
    ripple = {"force": lambda t: plane * RIPPLE["force"](t)} if planar else RIPPLE
    wrenches = [
        ExternalWrench(0.0, force=(0.3, 0.1, 0.0), torque=(0.0, 0.0, 0.01)),
        ExternalWrench(0.47, **table, frame="world"),
        ExternalWrench(1.0, **ripple),
    ]
    how = {"no_cross": Body.boyer2010().changed(**NO_CROSS_FLOW)}
    run = simulate(**SWIMS[name], duration=1.2, wrenches=wrenches, body=how["no_cross"], accuracy=1e-9, estimate=False)
    assert np.abs(run.energy.external_work).max() > 0.02 * works_of(run)
    assert np.abs(run.energy.residual).max() < 1e-9 * works_of(run), np.abs(run.energy.residual).max() / works_of(run)
    assert run.closure_force.max() < 1e-12 and run.closure_torque.max() < 1e-12


ROBOTS = {**{name: (robot, WAVE, Scene(), 1e-5) for name, robot in SOFT.items()}}
ROBOTS |= {f"random {seed}": (one.robot, one.law, one.scene, 1e-3) for seed in (5, 7, 8) for one in [drawn(seed)]}


@pytest.mark.parametrize("name", ROBOTS)
def test_the_ledger_of_robots_closes(name):
    """The march has momenta, the powers accelerations: an error in either form gives energy from nowhere."""
    robot, law, scene, accuracy = ROBOTS[name]
    rng = np.random.default_rng(len(name))
    plane = np.array([1.0, 1.0, 0.0, 0.0, 0.0, 1.0]) if scene.planar else np.ones(6)
    rows = plane * rng.uniform(0.3, 1.0, (3, 6)) * (1, 1, 1, 0.1, 0.1, 0.1)
    stations = 0.0, float(rng.uniform(0.3, 0.7)), 1.0
    wrenches = [
        ExternalWrench(x, (row[:3], row[:3], -row[:3]), row[3:], frame, time=(0.1, 0.3, 0.3))
        for x, row, frame in zip(stations, rows, ("section", "world", "section"), strict=True)
    ]
    run = simulate(
        law, 0.5, robot=robot, scene=scene, wrenches=wrenches, accuracy=accuracy, estimate=False, stations=11
    )
    assert np.abs(run.energy.external_work).max() > 0.02 * works_of(run)
    assert np.abs(run.energy.residual).max() < 10.0 * accuracy * works_of(run)
    assert run.closure_force.max() < 1e-10 and run.closure_torque.max() < 1e-10


def test_steps_keep_their_order_where_a_wrench_jumps():
    """A jump at an instant that no step would end at: the fourth order of the steps stays."""
    body = Body.boyer2010().changed(**NO_CROSS_FLOW)
    at = 0.2 + 0.1 / np.pi
    wrench = ExternalWrench(0.6, time=(0.05, at, at, 0.4), force=((0, 0, 0), (1, 1, 1), (-2, 1, 0), (0, 0, 2)))

    def end(step):
        how = Accuracy(name="steps", resolution=40.0, step=step)
        run = simulate(
            straight(), 0.5, body=body, scene=Scene(friction="none"), accuracy=how, twist=(0, 0, 0, 0.4, 0, 0),
            wrenches=[wrench], estimate=False,
        )  # fmt: skip
        return np.concatenate([run.position[-1], run.twist[-1]])

    ends = [end(step) for step in (2e-2, 1e-2, 5e-3, 1.25e-3)]
    errors = [np.abs(each - ends[-1]).max() for each in ends[:-1]]
    assert all(3.4 < np.log2(a / b) < 4.8 for a, b in itertools.pairwise(errors)), errors


def test_a_jump_is_seen_to_the_accuracy_of_the_run():
    """A blow of 2 ms gives the free body its impulse, as a table and as a function; observed before the jump."""
    mass = about_centre(Body.boyer2010(), "z")[1]
    blow = ExternalWrench(0.0, time=(0.3, 0.3, 0.302, 0.302), force=((0, 0, 0), (50, 0, 0), (50, 0, 0), (0, 0, 0)))
    as_function = ExternalWrench(0.0, force=lambda t: (50.0 * (0.3 < t < 0.302), 0.0, 0.0))
    run = simulate(STRAIGHT, 1.0, scene=NO_WATER, wrenches=[blow], accuracy=1e-9)
    assert run.twist[-1, 3] == pytest.approx(0.1 / mass, rel=1e-12)
    assert run.error_estimate.worst < 1e-8
    simulation = Simulation(law=STRAIGHT, scene=NO_WATER, wrenches=[blow])
    simulation.advance(0.3)
    assert simulation.observe().head_acceleration[3] == 0.0
    simulation.advance(0.302)
    assert simulation.observe().head_acceleration[3] == pytest.approx(50.0 / mass, rel=1e-12)
    loose = simulate(STRAIGHT, 1.0, scene=NO_WATER, wrenches=[as_function], accuracy=1e-3)
    assert loose.twist[-1, 3] == pytest.approx(0.1 / mass, rel=0.2)  # it is looked at in steps of some ms
