# SPDX-License-Identifier: Apache-2.0
"""Whole swims by the library: alone, in batches, in a node's periods, and in the environments for learning."""

import os
import statistics
import subprocess
import sys
import time
from functools import partial
from typing import Any

import gymnasium
import numpy as np
from eel_studies.tradeoff.measuring import REFERENCE
from measuring import MOTION, Lines, median_ratio, times_in_turn, two_processes_by_one

import eel_gym  # noqa: F401, it registers the environments
from eel_dynamics import Scene, Simulation, simulate, simulate_batch
from eel_gaits import Law, falling, straight

DURATION = 10.0  # s
LEAN = Scene(friction="laminar", **MOTION)


def falling_gait() -> Lines:
    """10 s of the falling gait, laminar friction: times real time, and the error of the head's position by its path
    (against a finer run)."""
    finest = simulate(falling(), accuracy=REFERENCE, scene=LEAN, estimate=False)
    everything = Scene(friction="laminar")
    for name, scene, period in (("motion alone", LEAN, DURATION), ("ledger, wrench, 201 samples", everything, 0.05)):
        for target in (1e-2, 1e-3, 1e-4, 1e-6):
            estimated = partial(simulate, falling(), accuracy=target, scene=scene, sample_period=period)
            bare = partial(estimated, estimate=False)
            run = bare()
            times = times_in_turn({"bare": bare, "estimated": estimated}, clock=time.perf_counter)
            error = np.linalg.norm(run.position[-1] - finest.position[-1]) / finest.path_length
            said = f"times real time, error {error:.1e}, {run.evaluations} evaluations"
            case = f"{name}, target {target:g}"
            yield case, DURATION / statistics.median(times["bare"]), said
            longer = median_ratio(times["estimated"], times["bare"])
            yield f"with the error estimate, {case}", longer, "times as long as the bare run"


def start() -> Lines:
    """A fresh process: import of the library, and the first step and sample."""
    code = (
        "import time; a = time.perf_counter(); from eel_dynamics import simulate; from eel_gaits import falling; "
        "b = time.perf_counter(); simulate(falling(), 0.05, estimate=False); print(b - a, time.perf_counter() - b)"
    )
    runs = [subprocess.check_output([sys.executable, "-c", code], text=True).split() for _ in range(5)]
    for label, seconds in zip(("import", "first step and sample"), zip(*runs, strict=True), strict=True):
        yield label, statistics.median(map(float, seconds)), "s"


def ticks() -> Lines:
    """10 s of the falling gait in periods of 10 ms, ledger and internal wrench at 51 stations on: the evaluations that
    the periods need, which are the same on every machine, and the CPU time of advancing and observing, of which a
    period's is the median over turns."""
    instants, turns = np.arange(1, 1001) / 100.0, 5
    for target in ("draft", "standard", "fine"):
        for words, accuracy in (("steps by the error", target), ("fixed steps", f"{target}, fixed steps")):
            swimmer, times = Simulation(accuracy=accuracy, law=falling()), []
            for _ in range(turns + 1):
                swimmer.reset()
                swimmer.observe(load=False)
                marks = [(swimmer.evaluations[2], time.thread_time())]
                for instant in instants:
                    swimmer.advance(instant)
                    swimmer.observe(load=False)
                    marks.append((swimmer.evaluations[2], time.thread_time()))
                counts, seconds = np.diff(marks, axis=0).T
                times.append(seconds)
            median, late, worst = np.quantile(np.median(times[1:], axis=0), (0.5, 0.99, 1.0))
            yield f"{target}, {words}", float(np.mean(counts)), "evaluations in a period, mean"
            yield "  most of them", float(np.max(counts)), "in one period"
            said = f"us, median; 99th percentile {1e6 * late:.0f} us, worst {1e6 * worst:.0f} us"
            yield "  CPU time", 1e6 * median, said


def batch() -> Lines:
    """Falling gaits of periods from 0.8 to 1.4 s, 10 s each, target 1e-3, motion alone with one sample, set-up
    included: times real time per second of CPU, by calls of simulate and in batches of one thread; then what more
    threads gain in wall time (which only an idle machine tells) and what they cost in CPU time."""
    single, sizes, whole = 20, (1, 10, 100, 1000), 200
    cases: dict = {"simulate, one by one": (single, partial(_one_by_one, _laws(single)))}
    cases |= {f"batch of {size}": (size, partial(_together, _laws(size), 1)) for size in sizes}
    times = times_in_turn({name: swim for name, (_, swim) in cases.items()}, 5)
    each = {name: [seconds / size for seconds in times[name]] for name, (size, _) in cases.items()}
    for name, seconds in each.items():
        gain = median_ratio(each["simulate, one by one"], seconds)
        said = f"times real time per CPU second, {gain:.2f} of one by one"
        yield name, DURATION / statistics.median(seconds), said
    cores = len(os.sched_getaffinity(0))
    threads = [*(count for count in (1, 2, 4, 8, 16, 32, 64) if count < cores), cores]
    together = {count: partial(_together, _laws(whole), count) for count in threads}
    wall, cpu = times_in_turn(together, 5, time.perf_counter), times_in_turn(together, 5)
    for count in threads[1:]:
        yield f"{count} threads", median_ratio(wall[1], wall[count]), "times as fast as 1 thread, wall time"
        yield f"{count} threads", median_ratio(cpu[count], cpu[1]), "times the CPU time of 1 thread"


def _one_by_one(laws: list[Law]) -> None:
    for law in laws:
        simulate(law, DURATION, scene=LEAN, stations=2, accuracy=1e-3, sample_period=DURATION, estimate=False)


def _together(laws: list[Law], threads: int) -> None:
    settings: dict[str, Any] = {"scenes": LEAN, "accuracy": 1e-3, "sample_period": DURATION, "estimate": False}
    if simulate_batch(laws, DURATION, threads=threads, **settings).stopped.any():
        raise RuntimeError("a swimmer of the batch stopped")


def _laws(count: int) -> list[Law]:
    return [falling(period=period) for period in np.linspace(0.8, 1.4, count)]


SWIMMERS = 64
STEP, STEPS, FIRST = 0.02, 250, 60  # s; control steps of a turn; steps before it, beyond the blend from rest


def gym() -> Lines:
    """Control steps of 20 ms at accuracy standard, per second of CPU: bare advance and observe under a law that stays
    the same, then steps of the environments with a new action each; and what threads gain in wall time."""
    cases, names = {}, ("Heading", "Depth")
    settings: dict[str, Any] = {"disable_env_checker": True, "control_period": STEP, "duration": 1e4}
    for name in names:
        env: Any = gymnasium.make(f"Eel/{name}-v0", **settings).unwrapped
        actions = np.random.default_rng(1).uniform(-0.2, 0.2, (STEPS, *env.action_space.shape))
        cases[f"bare, scene of {name}"] = partial(_bare, env.scene)
        cases[f"Eel/{name}-v0"] = partial(_steps, env, actions)
    times = times_in_turn(cases)
    for name, values in times.items():
        rate = (STEPS + FIRST) / statistics.median(values)
        yield name, rate, "control steps per CPU second, starts included"
    for name in names:
        ratio = median_ratio(times[f"Eel/{name}-v0"], times[f"bare, scene of {name}"])
        yield f"Eel/{name}-v0 by bare", ratio, "times as long"
    _steps(env, actions, first=0)
    steps, rejected, evaluations = (count / STEPS for count in env.swimmers.evaluations(0))
    yield "a control step of Eel/Depth-v0", evaluations, f"evaluations, {steps:.1f} steps and {rejected:.1f} rejected"
    for count, greatest in ((SWIMMERS, 0.0), (SWIMMERS, 0.2), (2 * SWIMMERS, 0.2)):
        actions = np.random.default_rng(1).uniform(-greatest, greatest, (STEPS, count, 1))
        steps = {
            threads: partial(
                _steps, gymnasium.make_vec("Eel/Heading-v0", count, threads=threads, control_period=STEP), actions
            )
            for threads in (1, 2)
        }
        (seconds,) = times_in_turn({1: steps[1]}, 5).values()
        rate, named = count * (STEPS + FIRST) / statistics.median(seconds), f"actions up to {greatest:g}"
        yield f"{count} at once, {named}", rate, "control steps per CPU second, starts included"
        wall = times_in_turn(steps, 5, time.perf_counter)
        gain = median_ratio(wall[1], wall[2])
        yield f"2 threads, {count} at once, {named}", gain, "times as fast as 1 thread, wall time"
    most = two_processes_by_one(steps[1])
    yield "2 processes", most, "times as much as 1, wall time: the most that 2 threads can gain here"


def _bare(scene: Scene) -> None:
    swimmer = Simulation(scene=scene, law=straight(), stations=2)
    for k in range(1, STEPS + FIRST + 1):
        swimmer.advance(k * STEP)
        swimmer.observe(wrench=False, load=False)


def _steps(env: Any, actions: np.ndarray, first: int = FIRST) -> None:
    env.reset(seed=1)
    for action in (*(actions[:1].repeat(first, axis=0)), *actions):
        env.step(action)
