# SPDX-License-Identifier: Apache-2.0
"""What one period of a node's real time costs: steps whose length the error chooses, against fixed ones.

`python benchmarks/run.py ticks`. The evaluations in a period are the same on every machine; they bound its time.
"""

import statistics
import time

import numpy as np

from eel_dynamics import Simulation
from eel_gaits import falling

RATE, DURATION = 100.0, 10.0  # Hz, s: 1,000 periods
TURNS = 5
TARGETS = ("draft", "standard", "fine")


def ticks():
    """10 s of the falling gait in periods of 10 ms, ledger and internal wrench at 51 stations on: the evaluations that
    the periods need, and the CPU time of advancing and observing, of which a period's is the median over turns."""
    for target in TARGETS:
        for words, accuracy in (("steps by the error", target), ("fixed steps", f"{target}, fixed steps")):
            counts, seconds = _swim(accuracy)
            median, late, worst = np.quantile(seconds, (0.5, 0.99, 1.0))
            yield f"{target}, {words}", float(np.mean(counts)), "evaluations in a period, mean"
            yield "  most of them", float(np.max(counts)), "in one period"
            said = f"us, median; 99th percentile {1e6 * late:.0f} us, worst {1e6 * worst:.0f} us"
            yield "  CPU time", 1e6 * median, said


def _swim(accuracy: str) -> tuple[np.ndarray, np.ndarray]:
    """Evaluations (periods,) and CPU times (periods,) [s]."""
    swimmer = Simulation(accuracy=accuracy, law=falling())
    times = np.arange(1, round(RATE * DURATION) + 1) / RATE
    seconds = []
    for _ in range(TURNS + 1):
        swimmer.reset()
        swimmer.observe(load=False)
        counts, row = [], []
        for instant in times:
            before, start = swimmer.evaluations[2], time.thread_time()
            swimmer.advance(instant)
            swimmer.observe(load=False)
            row.append(time.thread_time() - start)
            counts.append(swimmer.evaluations[2] - before)
        seconds.append(row)
    return np.array(counts), np.array([statistics.median(each) for each in zip(*seconds[1:], strict=True)])
