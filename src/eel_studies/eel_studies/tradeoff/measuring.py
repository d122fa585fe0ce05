# SPDX-License-Identifier: Apache-2.0
"""Error and cost of each setting, against a converged run.

Errors are those of `accuracy`: of the head's position at the end relative to the length of its path (or of the body, if
longer), and of the torque field relative to its greatest magnitude. Times are those of the same steps on the same
nodes, without the samples. They are CPU times of one core: they equal wall times on an idle machine, and stay
meaningful on a busy one. They are medians over repeats. In each repeat all settings take turns, so that a disturbance
does not fall on a single setting.
"""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import TypeVar

import numpy as np
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.swim import Swim
from eel_dynamics.simulation.simulation import Simulation, SimulationStopped

from eel_studies.tradeoff.settings import CHECK, REFERENCE

SAMPLE_PERIOD = 0.05  # s
STATIONS = 51
Row = TypeVar("Row")


@dataclass(frozen=True)
class Measured:
    """Relative errors and cost of a setting. Times are without the ledger and without samples."""

    accuracy: Accuracy
    pose_error: float
    torque_error: float
    microseconds: float  # CPU time per evaluation, without set-up
    seconds: float  # CPU time of the whole run on one core, set-up included
    times_real_time: float
    memory: int  # bytes that the loops work on
    run: Run

    @property
    def error(self) -> float:
        """The greater of both errors: the one that `accuracy` refers to."""
        return max(self.pose_error, self.torque_error)


@dataclass(frozen=True)
class Trade:
    """All that was measured for a gait."""

    swim: Swim  # with the accuracy of the reference
    duration: float  # s
    reference: Run
    reference_error: tuple[float, float]  # of pose and torque, compared with a coarser run
    rows: list[Measured]
    unstable: list[Accuracy]  # settings that diverged
    repeats: int

    @property
    def name(self) -> str:
        """Of the gait."""
        return str(self.swim.law.name)


def errors_of(run: Run, reference: Run) -> tuple[float, float]:
    """Relative errors of pose and torque of `run`, which has the same samples and stations as `reference`."""
    way = max(reference.path_length, reference.body.length)
    pose = float(np.linalg.norm(run.position[-1] - reference.position[-1])) / way
    assert run.torque is not None and reference.torque is not None
    size = float(np.max(np.linalg.norm(reference.torque, axis=2)))
    return pose, float(np.max(np.linalg.norm(run.torque - reference.torque, axis=2))) / size if size else 0.0


def swim_with(swim: Swim, duration: float, accuracy: Accuracy, **scene: object) -> Run:
    """The `swim` of `duration` [s] with torque and without the ledger, for the measurement of errors.

    scene: fields of `Scene` that differ. `SimulationStopped` where the run cannot go on.
    """
    swim = swim._replace(scene=_measured_in(replace(swim.scene, **scene)), accuracy=accuracy)  # type: ignore[arg-type]
    return swim.run(duration=duration, sample_period=SAMPLE_PERIOD, stations=STATIONS, estimate=False)


def measure(
    swim: Swim,
    settings: list[Accuracy],
    duration: float = 10.0,
    repeats: int = 5,
    say: Callable[[str], object] = lambda text: None,
) -> Trade:
    """Errors and times of `duration` [s] of a `swim` with every one of the `settings`.

    repeats: rounds of timing. say(text): called with a line of progress. Settings that diverge are listed in
    `Trade.unstable`.
    """
    say("the reference run, and a check of it")
    reference = swim_with(swim, duration, REFERENCE)
    reference_error = errors_of(swim_with(swim, duration, CHECK), reference)
    runs, unstable = {}, []
    say(f"errors of {len(settings)} settings")
    for accuracy in settings:
        try:
            runs[accuracy] = swim_with(swim, duration, accuracy)
        except SimulationStopped:
            unstable.append(accuracy)
    times: dict[Accuracy, list[tuple[float, float]]] = {accuracy: [] for accuracy in runs}  # of the march, of all
    for repeat in range(repeats):
        say(f"times, round {repeat + 1} of {repeats}")
        for accuracy in runs:
            start = time.thread_time()
            swimmer = ready(swim, accuracy)
            begin = time.thread_time()
            swimmer.advance(duration)
            end = time.thread_time()
            times[accuracy].append((end - begin, end - start))
    rows = []
    for accuracy, run in runs.items():
        marching, seconds = map(statistics.median, zip(*times[accuracy], strict=True))
        microseconds = 1e6 * marching / max(1, run.evaluations)
        memory = ready(swim, accuracy).memory
        cost = microseconds, seconds, duration / seconds, memory
        rows.append(Measured(accuracy, *errors_of(run, reference), *cost, run))
    return Trade(swim, duration, reference, reference_error, rows, unstable, repeats)


def front(
    rows: list[Row], error: Callable[[Row], float], cost: Callable[[Row], float] = attrgetter("seconds")
) -> list[Row]:
    """The Pareto front: those `rows` that no other row beats in both error and cost, the cheapest first."""
    best, result = np.inf, []
    for row in sorted(rows, key=lambda row: (cost(row), error(row))):
        if error(row) < best:
            best = error(row)
            result.append(row)
    return result


def ready(swim: Swim, accuracy: Accuracy) -> Simulation:
    """The `swim` before its first step, without samples."""
    return Simulation(swim.body, _measured_in(swim.scene), accuracy, 2, law=swim.law)


def _measured_in(scene: Scene) -> Scene:
    """`scene` with the torque and without the ledger: errors and times are of the grid that the torque needs."""
    return replace(scene, ledger=False, internal_wrench=True)
