# SPDX-License-Identifier: Apache-2.0
"""Simulates many swimmers in parallel: `simulate_batch`. Each has the result of `simulate`.

    batch = simulate_batch([straight(period=p) for p in periods], 10.0, accuracy=1e-3, stations=None)
    batch.position[:, -1]                 # (B, 3), head at the end
    batch.stopped, batch.error            # which swimmers stopped, and why; the others are not affected
    batch[7]                              # a Run, with the samples that it has

The mechanics run in threads without the GIL, one per core. Bodies, scenes and stations that occur several times are
tabulated once.
"""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import numpy as np
from eel_common.wording import shown
from numpy.typing import ArrayLike

from eel_dynamics.accuracy.accuracy import STANDARD
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.batches.batch import Batch, batch_of, coordinates_of
from eel_dynamics.batches.broadcast import swims_of
from eel_dynamics.model.equality import same
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.observed_swim import ObservedSwim, SwimResult, check_times
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.sampling import check_memory, checked_times, default_sample_period
from eel_dynamics.runs.settled_duration import until_settled
from eel_dynamics.runs.storage.run_contents import OF_EACH, arrays_of_run
from eel_dynamics.runs.storage.variables import COUNTS, names_with, shape_of
from eel_dynamics.runs.swim import Swim
from eel_dynamics.simulation.stopping import SimulationStopped

MOST_THREADS = 1000
SHARED = "duration", "sample_period", "load", "estimate"  # fields that the swims of a batch have in common
Item = TypeVar("Item")
Result = TypeVar("Result")


def simulate_batch(
    laws: Any,
    duration: float | str = 10.0,
    *,
    bodies: Any = None,
    scenes: Any = None,
    accuracy: Any = STANDARD,
    sample_period: float | None = None,
    stations: int | ArrayLike | None = None,
    positions: ArrayLike = (0.0, 0.0, 0.0),
    orientations: ArrayLike = (0.0, 0.0, 0.0, 1.0),
    twists: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    load: bool = False,
    estimate: bool = True,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    most_evaluations: float = MOST_EVALUATIONS,
    flows: Any = None,
    robots: Any = None,
    fins: Any = None,
    wrenches: Any = None,
) -> Batch:
    """Simulate B swimmers for `duration` [s] each, with samples every `sample_period` [s] from t = 0 on.

    Each swimmer's result equals that of `simulate` with the same stations to the last bit. A swimmer that stops, or
    cannot start, keeps its samples until then, with a `SimulationStopped` in `error`; the others are not affected.
    `ValueError` names a bad argument and the number of the swimmer.

    Args:
        laws, bodies, scenes, accuracy: one for all, or a sequence of B. One of length 1 counts as one for all.
        duration: [s], or "settled" for the time until the slowest of them has settled.
        sample_period: [s]; None for the default of `simulate` for the fastest law.
        stations: number per body, or their X [m], for the profiles along the body; None: only motion and energies.
        positions, orientations, twists: (3,) [m], (4,), (6,) as in `simulate`, for all; or (B, .), a row for each.
        load: whether to compute the water's load along the body too.
        estimate: whether to estimate each swimmer's error, as in `simulate`. `Batch.above_target` shows the swimmers
            that remain above their target.
        threads: None for one per available core.
        progress: progress(done, B) is called after each swimmer.
        most_evaluations: for each swimmer, as in `simulate`.
        flows, robots: one for all, or a sequence of B flows, robots, or None. With a `FlowField` swimmers run one at a
            time.
        fins, wrenches: as in `simulate` for all; or a list of B entries, each a list or None. With wrenches that are
            functions swimmers run one at a time.
    """
    shared = {
        "stations": stations,
        "duration": duration,
        "sample_period": sample_period,
        "load": load,
        "estimate": estimate,
        "most_evaluations": most_evaluations,
    }
    swims = swims_of(
        shared,
        accuracy,
        {"fins": fins, "wrenches": wrenches},
        laws=laws,
        bodies=bodies,
        scenes=Scene() if scenes is None else scenes,
        flows=flows,
        robots=robots,
        positions=positions,
        orientations=orientations,
        twists=twists,
    )
    return swum(swims, threads, progress)


def swum(swims: list[Swim], threads: int | None = None, progress: Callable[[int, int], None] | None = None) -> Batch:
    """The batch of these `swims`, with the samples of the first, until the slowest has settled if that is wanted.

    threads, progress: as in `simulate_batch`.
    """
    first = swims[0]
    seconds = max(swim.seconds for swim in swims) if until_settled(first.duration) else first.seconds
    sample_period = first.sample_period
    if sample_period is None:
        sample_period = default_sample_period({swim.law for swim in swims}, seconds)
    times = checked_times(seconds, sample_period)
    for swim in swims:
        check_times(swim, seconds, times)
        if any(not same(getattr(swim, name), getattr(first, name)) for name in SHARED):
            raise ValueError(f"swims of a batch must be alike in {', '.join(SHARED)}")
    profiles = first.stations is not None
    load = first.load and profiles
    count, points = len(swims), len(first.x)
    check_memory(count, len(times), points, any(swim.has_internal_wrench for swim in swims), load)
    robots = [coordinates_of(swim.robot) for swim in swims]
    sizes = {"time": len(times), "station": points, "fin": max(len(swim.fins) for swim in swims)}
    sizes |= {name: max(each[name] for each in robots) for name in robots[0]}
    names = names_with(
        wrench=any(swim.has_internal_wrench for swim in swims),
        load=load,
        ledger=any(swim.scene.ledger for swim in swims),
        fins=sizes["fin"],
        robot=any(swim.robot for swim in swims),
    )
    arrays = {name: np.zeros((count, *shape_of(name, sizes))) for name in names}
    start, counts = np.zeros(count), {name: np.zeros(count, dtype=int) for name in ("samples", *COUNTS)}
    own: dict[str, list[Any]] = {
        several: [getattr(swim, one) for swim in swims] for one, several in OF_EACH.items() if hasattr(first, one)
    }
    own |= {"error": count * [None], "error_estimates": count * [None]}

    def record(index: int) -> None:
        observed = ObservedSwim(Run, swims[index], times, load)
        try:
            found = result_of(observed.to_refine() if first.estimate else observed)
        except SimulationStopped as error:
            own["error"][index] = error
            return
        run = found.run
        for name, values in arrays_of_run(run).items():
            if name in arrays:
                arrays[name][index][tuple(map(slice, values.shape))] = values
        start[index], own["error"][index] = found.energy_at_start, found.stopped
        own["accuracies"][index], own["error_estimates"][index] = run.accuracy, run.error_estimate
        counts["samples"][index] = len(run.time)
        for name in COUNTS:
            counts[name][index] = getattr(run, name)

    in_threads(record, range(count), threads, progress)
    return batch_of(own, counts, times, np.array([swim.x for swim in swims]), arrays, start, profiles)


def result_of(observed: ObservedSwim[Run]) -> SwimResult[Run]:
    """The result of an `observed` swim, which may have stopped early. `SimulationStopped` if it cannot start."""
    try:
        return observed.outcome()
    except ValueError as error:
        raise SimulationStopped(0.0, str(error), np.nan, "take a gentler law, or start slower") from None


def available_cores() -> int:
    """The number of cores available to this process."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_threads(
    task: Callable[[Item], Result],
    items: Iterable[Item],
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[Result]:
    """`task(item)` for each of the `items`, in their order. threads: None for one per core. An error ends it."""
    threads = available_cores() if threads is None else threads
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)) or not 1 <= threads <= MOST_THREADS:
        raise ValueError(f"threads must be a whole number from 1 to {MOST_THREADS}, got {shown(threads)}")
    items, found = list(items), list[Result]()
    with ThreadPoolExecutor(threads, thread_name_prefix="swimmer") as pool:
        try:
            for result in map(task, items) if threads == 1 else pool.map(task, items):
                found.append(result)
                if progress is not None:
                    progress(len(found), len(items))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return found
