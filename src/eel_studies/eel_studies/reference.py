# SPDX-License-Identifier: Apache-2.0
"""Swims that are compared: tried without a word, timed in turns, and against two methods on two grids.

Two grids may have nearly the same error, so the pair must agree better than what it is to judge.
"""

import statistics
import time
import warnings
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from eel_dynamics.batches.simulate_batch import in_threads
from eel_dynamics.runs.companion import relative_errors

from eel_dynamics import Accuracy, Run, SimulationStopped, Swim

DEARER = 10.0  # times, that the next pair takes
LONG = 0.5  # s, of a swim whose CPU time is known well enough from one round
REFERENCES = tuple(  # finer ones, where the first do not agree
    (
        Accuracy(name="pair", resolution=points, tolerance=tolerance),
        Accuracy(name="adams", resolution=points + 20.0, tolerance=0.3 * tolerance, method="adams", order=6),
    )
    for points, tolerance in ((40.0, 1e-9), (70.0, 1e-11), (160.0, 1e-12), (320.0, 1e-13))
)


def attempt(swim: Swim, **how: Any) -> Run | Exception:
    """The run of `swim`, or why there is none. how: as in `Swim.run`. It shows no progress."""
    try:
        return swim.run(**{"progress": lambda reached, left: None} | how)
    except (SimulationStopped, ValueError) as error:
        return error


def attempts(swims: Iterable[Swim], **how: Any) -> list[Run | Exception]:
    """`attempt` of each of the `swims`, over threads, without warnings, which the runs keep."""
    with warnings.catch_warnings(action="ignore"):
        return in_threads(lambda swim: attempt(swim, **how), swims)


def cpu_seconds(
    swims: list[Swim], duration: float, rounds: int, say: Callable[[str], object] = lambda text: None
) -> list[float]:
    """CPU time [s] on one core of `duration` [s] of each of the `swims`, set-up included, without samples.

    Medians over `rounds`, in which the swims take turns, but for those that take `LONG`; infinite where one stops.
    say(text): called with each round.
    """

    def timed(swim: Swim) -> float:
        begin = time.thread_time()
        try:
            swim.simulation(stations=2).advance(duration)
        except (SimulationStopped, ValueError):
            return np.inf
        return time.thread_time() - begin

    times: list[list[float]] = [[] for _ in swims]
    for each in range(rounds):
        say(f"times, round {each + 1} of {rounds}")
        for swim, row in zip(swims, times, strict=True):
            if not row or row[0] < LONG:
                row.append(timed(swim))
    return [statistics.median(row) for row in times]


def reference_of(
    swim: Swim, wanted: float, *, least: int = 1, seconds: float = np.inf, **how: Any
) -> tuple[Run, float]:
    """A run of `swim` to compare others with, and its relative distance from another method on another grid.

    The first of the `REFERENCES` that agree to `wanted`; else those that agree best. least: the first pair that is
    tried. seconds: of CPU time, which no further pair may take. how: as in `Swim.run`. `SimulationStopped` where none
    comes to its end.
    """
    best: tuple[Run, float] | None = None
    stop: Exception | None = None
    for pair in REFERENCES[least:] or REFERENCES:
        begin = time.thread_time()
        try:
            first, second = (swim._replace(accuracy=each).run(estimate=False, **how) for each in pair)
        except SimulationStopped as error:
            stop = error
            continue
        distance = relative_errors(first, second).worst
        if best is None or distance < best[1]:
            best = first, distance
        if best[1] <= wanted or DEARER * (time.thread_time() - begin) > seconds:
            break
    if best is None:
        raise stop or ValueError("no reference")
    return best


def front(rows: list[Any], error: Any, cost: Any) -> list[Any]:
    """The Pareto front: those `rows` that no other row beats in both error and cost, the cheapest first."""
    best, result = np.inf, []
    for row in sorted(rows, key=lambda row: (cost(row), error(row))):
        if error(row) < best:
            best = error(row)
            result.append(row)
    return result
