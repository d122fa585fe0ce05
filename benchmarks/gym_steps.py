# SPDX-License-Identifier: Apache-2.0
"""Control steps of the environments for learning: `python benchmarks/run.py gym`."""

import statistics
import time

import gymnasium
import numpy as np
from measuring import median_ratio, times_in_turn

import eel_gym  # noqa: F401, it registers the environments
from eel_dynamics import Simulation
from eel_gaits import straight

STEP, COUNT, FIRST = 0.02, 250, 60  # s; steps of a turn; steps before it, beyond the blend from rest
SWIMMERS = 16


def gym():
    """Control steps of 20 ms at accuracy standard, per second of CPU: bare advance and observe under a law that stays
    the same, then steps of the environments with a new action each; and what threads gain in wall time."""
    cases = {}
    for name in ("Heading", "Depth"):
        env = gymnasium.make(f"Eel/{name}-v0", disable_env_checker=True, duration=1e4).unwrapped
        actions = np.random.default_rng(1).uniform(-0.2, 0.2, (COUNT, *env.action_space.shape))
        cases[f"bare, scene of {name}"] = lambda env=env: _bare(env.scene)
        cases[f"Eel/{name}-v0"] = lambda env=env, actions=actions: _steps(env, actions)
    times = times_in_turn(cases)
    for name, values in times.items():
        yield name, (COUNT + FIRST) / statistics.median(values), "control steps per CPU second, starts included"
    for name in ("Heading", "Depth"):
        ratio = median_ratio(times[f"Eel/{name}-v0"], times[f"bare, scene of {name}"])
        yield f"Eel/{name}-v0 by bare", ratio, "times as long"
    env.reset(seed=1)
    for action in actions:
        env.step(action)
    steps, rejected, evaluations = (count / COUNT for count in env._simulation.evaluations)
    yield "a control step of Eel/Depth-v0", evaluations, f"evaluations, {steps:.1f} steps and {rejected:.1f} rejected"
    wall = {threads: [] for threads in (1, 2)}
    for _ in range(5):
        for threads in wall:
            wall[threads].append(_vector(threads))
    yield "2 threads", median_ratio(wall[1], wall[2]), "times as fast as 1 thread, wall time"


def _bare(scene):
    swimmer = Simulation(scene=scene, law=straight(), stations=2)
    for k in range(1, COUNT + FIRST + 1):
        swimmer.advance(k * STEP)
        swimmer.observe(wrench=False, load=False)


def _steps(env, actions):
    env.reset(seed=1)
    for _ in range(FIRST):
        env.step(actions[0])
    for action in actions:
        env.step(action)


def _vector(threads: int) -> float:
    """Wall time [s] of some steps of many environments."""
    envs = gymnasium.make_vec("Eel/Heading-v0", num_envs=SWIMMERS, threads=threads)
    envs.reset(seed=1)
    actions = np.zeros(envs.action_space.shape)
    began = time.perf_counter()
    for _ in range(COUNT // 5):
        envs.step(actions)
    seconds = time.perf_counter() - began
    envs.close()
    return seconds
