# SPDX-License-Identifier: Apache-2.0
"""Simulates many swimmers in parallel: `simulate_batch`, each with the result of `simulate`.

    batch = simulate_batch([straight(period=p) for p in periods], 10.0, accuracy=1e-3, stations=None)
    batch.position[:, -1]                 # (B, 3), head at the end
    batch.stopped, batch.error            # which swimmers stopped, and why; the others are not affected
    batch[7]                              # a Run, with the samples that it has

The mechanics run in threads without the GIL, one per core. Bodies, scenes and stations that occur more than once are
tabulated once.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from eel_base.wording import shown
from eel_model.flow.flow import check_covers
from numpy.typing import ArrayLike

from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.batches.batch import Batch, Swimmer, batch_of
from eel_dynamics.batches.broadcast import swimmers_of
from eel_dynamics.runs.companion import with_error_estimate
from eel_dynamics.runs.motions import check_duration
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.sampling import check_memory, checked_times, default_sample_period
from eel_dynamics.runs.settled_duration import duration_of
from eel_dynamics.runs.storage.variables import arrays_of
from eel_dynamics.runs.swim_request import SwimRequest, SwimResult
from eel_dynamics.simulation.bending.joint_motion import JointMotion, Motion
from eel_dynamics.simulation.energy import WORKS
from eel_dynamics.simulation.observations import FINS, Observations
from eel_dynamics.simulation.stopping import SimulationStopped

MOST_THREADS = 1000


def simulate_batch(
    laws: Any,
    duration: float | str = 10.0,
    *,
    bodies: Any = None,
    scenes: Any = None,
    accuracy: Any = "standard",
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
) -> Batch:
    """Simulate B swimmers for `duration` [s] each, with samples every `sample_period` [s] from t = 0 on.

    Each swimmer's result equals that of `simulate` with the same stations to the last bit. A swimmer that stops, or
    cannot start, keeps its samples until then, with a `SimulationStopped` in `error`; the others are not affected.
    `ValueError` names an argument that does not fit, with the number of the swimmer.

    Args:
        laws, bodies, scenes, accuracy: one for all, or a sequence of B. One of length 1 counts as one for all.
        duration: [s], or "settled" for the time until the slowest of them has settled.
        sample_period: [s]; None for the default of `simulate` for the fastest of the laws.
        stations: number per body, or their X [m], for the profiles along the body; None: no profiles, only motion and
            energies.
        positions, orientations, twists: (3,) [m], (4,), (6,) as in `simulate`, for all; or (B, .), a row for each.
        load: whether to compute the water's load along the body too.
        estimate: whether to measure each swimmer's error, as in `simulate`; `Batch.above_target` tells those that stay
            above their target.
        threads: None for one per available core.
        progress: progress(done, B) is called after each swimmer.
        most_evaluations: of each, as in `simulate`.
        flows, robots: one for all, or a sequence of B, each a flow, or a robot, or None. A `FlowField` runs one swimmer
            at a time.
        fins: as in `simulate` for all; or a list of B lists, or None, one for each.
    """
    accuracy = accuracy.tolist() if isinstance(accuracy, np.ndarray) else accuracy
    along = [0.0] if stations is None else stations
    states = positions, orientations, twists
    swimmers = swimmers_of(laws, bodies, scenes, accuracy, along, *states, most_evaluations, flows, robots, fins)
    seconds = duration_of(duration, swimmers)
    if sample_period is None:
        sample_period = default_sample_period({law for law, _ in swimmers}, seconds)
    times = checked_times(seconds, sample_period)
    for law, setup in swimmers:
        check_duration(law, seconds)
        check_covers(setup.flow, float(times[-1]))
    wrench = [setup.scene.internal_wrench and stations is not None for _, setup in swimmers]
    count, load, points = len(swimmers), bool(load) and stations is not None, len(swimmers[0][1].x)
    check_memory(count, len(times), points, any(wrench), load)
    most_fins = max(len(setup.fins) for _, setup in swimmers)
    out = Observations.empty(len(times), points, any(wrench), load, (count,), most_fins)
    works, start = np.zeros((count, len(times), len(WORKS))), np.zeros(count)
    samples, *_ = counts = np.zeros((4, count), dtype=int)
    settings = [setup.accuracy for _, setup in swimmers]
    errors: list[SimulationStopped | None] = [None] * count
    estimates: list[ErrorEstimate | None] = [None] * count
    joints: list[JointMotion | None] = [None] * count

    def swim(index: int) -> None:
        request = SwimRequest(Run, *swimmers[index], times, wrench[index], load)
        request = request.to_refine() if estimate else request
        fits = wrench[index] == any(wrench) and len(request.setup.fins) == most_fins and request.every == 1
        space = out[index] if fits else None
        try:
            found = swim_of(request, estimate, space)
        except SimulationStopped as error:
            errors[index] = error
            return
        run = found.run
        if found.out is not space:  # other profiles or fins than others have, or a finer run
            for name, array in found.out.arrays().items():
                row = getattr(out, name)[index, : len(array[:: found.every])]
                (row[:, : array.shape[1]] if name in FINS else row)[...] = array[:: found.every]
        works[index] = found.works[:: found.every]
        start[index], errors[index] = found.energy_at_start, found.stopped
        settings[index], estimates[index] = run.accuracy, run.error_estimate
        joints[index] = found.joints and found.joints.every(found.every)
        counts[:, index] = len(run.time), run.steps, run.evaluations, run.nodes

    _for_each(swim, count, threads, progress)
    for index in np.flatnonzero(samples < len(times)).tolist():
        for array in (*out[index].arrays().values(), works[index]):
            array[samples[index] :] = 0.0
    swum = [Swimmer(law, *(getattr(setup, name) for name in Swimmer._fields[1:])) for law, setup in swimmers]
    robots = any(setup.robot for _, setup in swimmers)
    motion = Motion.of_many(joints, samples, len(times)) if robots else None
    arrays = arrays_of(out, works, start[:, None], motion)
    return batch_of(swum, (settings, errors, estimates, counts), times, arrays, start, stations is not None)


def swim_of(request: SwimRequest[Run], estimate: bool, out: Observations | None = None) -> SwimResult[Run]:
    """The swim of a `request`, with an `estimate` of its error if wanted, as of `simulate`; it may have stopped.

    out: space for its samples. `SimulationStopped` where it cannot start.
    """
    try:
        found = request.swim(request.simulation(), out=out)
        return with_error_estimate(found, request) if estimate else found
    except ValueError as error:
        raise SimulationStopped(0.0, str(error), np.nan, "take a gentler law, or start slower") from None


def available_cores() -> int:
    """The number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _for_each(
    swim: Callable[[int], None], count: int, threads: int | None, progress: Callable[[int, int], None] | None
) -> None:
    """Call `swim(index)` for all indices below `count`, in `threads` threads."""
    threads = available_cores() if threads is None else threads
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)) or not 1 <= threads <= MOST_THREADS:
        raise ValueError(f"threads must be a whole number from 1 to {MOST_THREADS}, got {shown(threads)}")
    with ThreadPoolExecutor(threads, thread_name_prefix="swimmer") as pool:
        try:
            swims = map(swim, range(count)) if threads == 1 else pool.map(swim, range(count))
            for done, _ in enumerate(swims, start=1):
                if progress is not None:
                    progress(done, count)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
