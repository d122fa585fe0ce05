# SPDX-License-Identifier: Apache-2.0
"""Many swimmers side by side: `python benchmarks/run.py batch`, against the size of the batch and the cores."""

import os
import statistics
import time
from functools import partial

import numpy as np
from measuring import median_ratio, times_in_turn

from eel_dynamics import Scene, simulate, simulate_batch
from eel_gaits import falling

REPEATS = 5
DURATION = 10.0  # s
LEAN = Scene(friction="laminar", ledger=False, internal_wrench=False)
MOTION = {"accuracy": 1e-3, "sample_period": DURATION}
SIZES = 1, 10, 100, 1000
WHOLE = 200  # swimmers, in the comparison of cores
ALONE = 20  # swimmers, one by one


def batch():
    """Falling gaits of periods from 0.8 to 1.4 s, 10 s each, target 1e-3, motion alone with one sample, set-up
    included: times real time per second of CPU, by calls of simulate and in batches of one thread; then what more
    threads gain in wall time (which only an idle machine tells) and what they cost in CPU time."""
    cases = {"simulate, one by one": (ALONE, partial(_one_by_one, _laws(ALONE)))}
    cases |= {f"batch of {size}": (size, partial(_together, _laws(size), 1)) for size in SIZES}
    times = times_in_turn({name: swim for name, (_, swim) in cases.items()}, REPEATS)
    alone = [seconds / ALONE for seconds in times["simulate, one by one"]]
    for name, (size, _) in cases.items():
        each = [seconds / size for seconds in times[name]]
        gain = median_ratio(alone, each)
        yield name, DURATION / statistics.median(each), f"times real time per CPU second, {gain:.2f} of one by one"
    laws, threads = _laws(WHOLE), _powers(len(os.sched_getaffinity(0)))
    wall, cpu = {count: [] for count in threads}, {count: [] for count in threads}
    for _ in range(REPEATS):
        for count in threads:
            start, spent = time.perf_counter(), time.process_time()
            _together(laws, count)
            wall[count].append(time.perf_counter() - start)
            cpu[count].append(time.process_time() - spent)
    for count in threads[1:]:
        yield f"{count} threads", median_ratio(wall[1], wall[count]), "times as fast as 1 thread, wall time"
        yield f"{count} threads", median_ratio(cpu[count], cpu[1]), "times the CPU time of 1 thread"


def _one_by_one(laws):
    for law in laws:
        simulate(law, DURATION, scene=LEAN, stations=2, **MOTION, estimate=False)


def _together(laws, threads: int):
    if simulate_batch(laws, DURATION, scenes=LEAN, threads=threads, **MOTION, estimate=False).stopped.any():
        raise RuntimeError("a swimmer of the batch stopped")


def _laws(count: int):
    return [falling(period=period) for period in np.linspace(0.8, 1.4, count)]


def _powers(cores: int):
    return [threads for threads in (1, 2, 4, 8, 16, 32, 64) if threads < cores] + [cores]
