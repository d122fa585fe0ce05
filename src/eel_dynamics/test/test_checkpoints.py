# SPDX-License-Identifier: Apache-2.0
"""A copy of a simulation, by `copy` or a pickle, goes on by itself, to the same bit as the original."""

import copy
import itertools
import multiprocessing
import pickle
import subprocess
import sys

import numpy as np
import pytest
from eel_dynamics.model.fins.fins import Fin, RollHold
from eel_dynamics.model.flow.functions import FlowField
from eel_dynamics.model.flow.sources import Gust, Shear
from random_robots import drawn

from eel_dynamics import Scene, Simulation
from eel_gaits import falling, rolling, straight


def pickled(thing):
    return pickle.loads(pickle.dumps(thing))


WAYS = {"copy": copy.copy, "deepcopy": copy.deepcopy, "pickle": pickled}
FINS = (*Fin.pair(0.3, 1e-3, 2.5, dihedral=0.3, angle="commanded", time_constant=0.1, name="fore"),)
HELD = (*Fin.pair(0.3, 1e-3, 2.5, angle=RollHold(2.0, 0.15), time_constant=0.05),)


def turning(place, time):
    """A flow that is a function of Python, which a pickle finds by its name."""
    return 0.05 * np.stack([np.sin(time + place[..., 1]), np.cos(place[..., 0]), 0.0 * place[..., 2]], axis=-1)


def with_samples(simulation, first=0.0, count=40, every=0.02):
    """Queue a controller's samples; they take over in a blend, and run out in another one."""
    x = np.linspace(0.0, 1.0, 9)
    for time in first + every * np.arange(1, count + 1):
        turn = 6.0 * time - 5.0 * x
        rows = np.sin(turn), 6.0 * np.cos(turn), -36.0 * np.sin(turn)
        none = np.zeros_like(x)
        simulation.add_samples(float(time), x, none, none, none, *rows)


def blends(simulation):
    simulation.advance(0.537)
    simulation.adopt(falling(), 0.2, 0.7)
    simulation.advance(0.81)


def samples(simulation):
    simulation.advance(0.3)
    with_samples(simulation, 0.35)
    simulation.advance(0.7123)


def currents(simulation):
    for k in range(8):
        simulation.advance(0.05 * (k + 1))
        simulation.add_current(0.05 * (k + 1), (0.1 * np.sin(k), 0.05, 0.0))


def moved(simulation):
    simulation.advance(0.4)
    simulation.set_state((1.0, 2.0, 0.0), (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.3, 0.2, 0.0, 0.0))
    simulation.advance(0.45)


def cut_short(simulation):
    looks = itertools.count()
    assert not simulation.advance(1000.0, lambda: next(looks) > 2)


def commanded_fins(simulation):
    simulation.advance(0.2)
    simulation.command_fins({fin.name: 0.2 for fin in simulation.fins[:1]})
    simulation.advance(0.33)


def other_robot(simulation):
    simulation.advance(0.2)
    simulation.change_robot(simulation.robot.with_numbers({"kp": 3.0}))
    simulation.advance(0.33)


def nothing(simulation):
    """At the start."""


CASES = {  # name: (arguments of `Simulation`, what happens before the copy)
    "start": ({}, nothing),
    "blend": ({}, blends),
    "blend, Adams": ({"scene": Scene(internal_wrench=False, ledger=False)}, blends),
    "blend, plane": ({"scene": Scene(planar=True, internal_wrench=False, ledger=False), "law": straight()}, moved),
    "classical": ({"accuracy": "1e-3, fixed steps"}, blends),
    "coarse": ({"accuracy": 1e-2}, cut_short),
    "error measured": ({"measure_error": True}, blends),
    "samples": ({}, samples),
    "samples, error measured": ({"measure_error": True, "scene": Scene(ledger=False)}, samples),
    "currents": ({"scene": Scene(current=(0.05, 0.0, 0.0))}, currents),
    "moved": ({}, moved),
    "gust": ({"flow": Gust(velocity=(0.0, 0.1, 0.0), start=0.3, rise=0.9)}, blends),
    "shear": ({"flow": Shear(velocity=(0.2, 0.0, 0.0), width=0.5)}, blends),
    "function": ({"flow": FlowField(turning)}, blends),
    "commanded fins": ({"fins": FINS}, commanded_fins),
    "fins that hold the roll": ({"fins": HELD, "law": rolling()}, blends),
    "robot": ({"robot": "eight_servos"}, other_robot),
    "robot with springs": ({"robot": "series_elastic"}, nothing),
    "robot in the plane": ({"robot": "eight_servos", "scene": Scene(planar=True)}, moved),
}


def begun(arguments, before):
    from eel_dynamics.model.robot.robot import Robot

    arguments = {"law": straight()} | arguments
    if "robot" in arguments:
        arguments["robot"] = Robot.named(arguments["robot"])
    simulation = Simulation(**arguments)
    before(simulation)
    return simulation


def went_on(simulation, until=0.5):
    """All that shows where a simulation is after some more time, a further law and a command."""
    seen = []
    for k in range(4):
        if k == 2 and not simulation.sampled:
            simulation.adopt(straight(period=1.3), 0.1, 0.4)
        if k == 3 and simulation.robot is not None:
            simulation.command(simulation.robot.joints[0].name, position=0.1)
        simulation.advance(simulation.time + until / 4.0)
        seen += [simulation.state.tobytes(), simulation.works.tobytes(), simulation.evaluations]
        shown = simulation.observe()
        seen += [np.array(shown.whole).tobytes(), simulation.error_estimate, len(simulation.grid.x)]
        seen.append(None if simulation.head_errors is None else tuple(simulation.head_errors))
        if simulation.robot is not None:
            seen += [shown.joints[name].tobytes() for name in ("joint_angle", "joint_torque")]
    return seen


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_copies_go_on_by_themselves_to_the_same_bit(case):
    simulation = begun(*case)
    others = {name: way(simulation) for name, way in WAYS.items()}
    wanted = went_on(simulation)  # the original first: what it does must not touch the copies
    for name, other in others.items():
        again = pickled(other)
        assert went_on(other) == wanted, name
        assert went_on(again) == wanted, f"{name} of {name}"


def test_a_copy_that_is_reset_swims_as_the_original():
    simulation = begun({}, blends)
    other = pickled(simulation)
    for each in (simulation, other):
        each.reset()
        each.advance(0.3)
    np.testing.assert_array_equal(simulation.state, other.state)


@pytest.mark.parametrize("seed", range(6))
def test_random_robots_go_on_from_copies_at_any_time(seed):
    draw = drawn(seed)
    simulation = Simulation(robot=draw.robot, scene=draw.scene, law=draw.law, accuracy=1e-2)
    times = np.sort(np.random.default_rng(seed).uniform(0.0, 0.3, 4))
    others = []
    for time in times:
        simulation.advance(float(time))
        others.append(pickled(simulation))
    simulation.advance(0.4)
    for other, since in zip(others, range(4), strict=True):
        for time in (*times[since + 1 :], 0.4):
            other.advance(float(time))
        assert other.state.tobytes() == simulation.state.tobytes()
        assert other.observe().joints["joint_angle"].tobytes() == simulation.observe().joints["joint_angle"].tobytes()


FRESH = """
import pickle, sys
simulation = pickle.load(sys.stdin.buffer)
simulation.advance(1.5)
sys.stdout.buffer.write(simulation.state.tobytes())
"""


def test_a_checkpoint_goes_on_in_a_fresh_process():
    simulation = begun({"measure_error": True}, blends)
    there = subprocess.run(
        [sys.executable, "-c", FRESH], input=pickle.dumps(simulation), capture_output=True, timeout=200.0, check=True
    )
    simulation.advance(1.5)
    assert there.stdout == simulation.state.tobytes()


def in_a_fork(pipe, simulation, state):
    pipe.send((went_on(simulation), went_on(pickle.loads(state))))


def test_simulations_and_checkpoints_go_on_in_a_fork():
    simulation = begun({"measure_error": True}, blends)
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe()
    child = context.Process(target=in_a_fork, args=(there, simulation, pickle.dumps(simulation)))
    child.start()
    there.close()  # so that a child that fails is seen at once
    inherited, read = here.recv()
    child.join(60.0)
    assert inherited == read == went_on(simulation) and child.exitcode == 0


def test_bytes_that_are_no_state_of_this_march_are_refused_and_nothing_changes():
    simulation = begun({}, blends)
    core, other = simulation._march.core, begun({"scene": Scene(ledger=False, internal_wrench=False)}, blends)
    state = core.state_as_bytes()
    damaged = bytes([*state[:50], state[50] ^ 1, *state[51:]])
    for wrong in (b"", state[:-1], damaged, state + b"\0", other._march.core.state_as_bytes()):
        with pytest.raises(ValueError, match="state must be that of a march of the same body by the same method"):
            core.set_state_from_bytes(wrong)
        assert core.state_as_bytes() == state
