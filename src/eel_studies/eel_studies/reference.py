# SPDX-License-Identifier: Apache-2.0
"""Comparison of swims: attempted in silence, timed in turns, and judged by two methods on two grids.

Two grids may have nearly the same error. So the pair must agree better than the run that it judges.
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

DEARER = 10.0  # factor of the next pair's time
LONG = 0.5  # s, one round is enough to time a longer swim
REFERENCES = tuple(  # finer ones, for use if the first do not agree
    (
        Accuracy(name="pair", resolution=points, tolerance=tolerance),
        Accuracy(name="adams", resolution=points + 20.0, tolerance=0.3 * tolerance, method="adams", order=6),
    )
    for points, tolerance in ((40.0, 1e-9), (70.0, 1e-11), (160.0, 1e-12), (320.0, 1e-13))
)


def attempt(swim: Swim, **how: Any) -> Run | Exception:
    """The run of `swim`, or the error that prevented it. how: as in `Swim.run`. It shows no progress."""
    try:
        return swim.run(**{"progress": lambda reached, left: None} | how)
    except (SimulationStopped, ValueError) as error:
        return error


def attempts(swims: Iterable[Swim], **how: Any) -> list[Run | Exception]:
    """`attempt` of each of the `swims`, over threads. Warnings are not shown, as the runs keep them."""
    with warnings.catch_warnings(action="ignore"):
        return in_threads(lambda swim: attempt(swim, **how), swims)


def cpu_seconds(
    swims: list[Swim], duration: float, rounds: int, say: Callable[[str], object] = lambda text: None
) -> list[float]:
    """CPU time [s] on one core of `duration` [s] of each of the `swims`, with set-up, without samples.

    Medians over `rounds`, in which the swims take turns; swims longer than `LONG` are timed once. Infinite if one
    stops. say(text): called with each round.
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
    """A run of `swim` for comparison with others, and its relative distance from another method on another grid.

    The first of the `REFERENCES` that agree to `wanted`; otherwise those that agree best. least: the first pair to try.
    seconds: limit of CPU time for a further pair. how: as in `Swim.run`. `SimulationStopped` if none reaches its end.
    """
    best: tuple[Run, float] | None = None
    stop: Exception | None = None
    for pair in REFERENCES[least:] or REFERENCES:
        begin = time.thread_time()
        try:
            first, second = (swim.changed(accuracy=each).run(estimate=False, **how) for each in pair)
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
    """The Pareto front: the `rows` that no other row beats in both error and cost, the cheapest first."""
    best, result = np.inf, []
    for row in sorted(rows, key=lambda row: (cost(row), error(row))):
        if error(row) < best:
            best = error(row)
            result.append(row)
    return result
