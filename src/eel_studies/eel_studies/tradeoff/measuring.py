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

import numpy as np
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.run import Run, simulate
from eel_dynamics.simulation.simulation import Simulation, SimulationStopped
from eel_gaits.laws.law import Law

from eel_studies.tradeoff.settings import CHECK, REFERENCE

SAMPLE_PERIOD = 0.05  # s
STATIONS = 51


@dataclass(frozen=True)
class Measured:
    """Relative errors and cost of a setting. Times are without the ledger and without samples."""

    accuracy: Accuracy
    nodes: int
    step: float  # s, mean
    pose_error: float
    torque_error: float
    evaluations: int
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

    law: Law
    duration: float  # s
    reference: Run
    reference_error: tuple[float, float]  # of pose and torque, compared with a coarser run
    rows: list[Measured]
    unstable: list[Accuracy]  # settings that diverged
    repeats: int


def errors_of(run: Run, reference: Run) -> tuple[float, float]:
    """Relative errors of pose and torque of `run`, which has the same samples and stations as `reference`."""
    way = max(reference.path_length, reference.body.length)
    pose = float(np.linalg.norm(run.position[-1] - reference.position[-1])) / way
    assert run.torque is not None and reference.torque is not None
    size = float(np.max(np.linalg.norm(reference.torque, axis=2)))
    return pose, float(np.max(np.linalg.norm(run.torque - reference.torque, axis=2))) / size if size else 0.0


def swim(law: Law, duration: float, body: Body, scene: Scene, accuracy: Accuracy) -> Run:
    """Simulate `duration` [s] with torque and without the ledger, for the measurement of errors.

    `SimulationStopped` where the run cannot go on.
    """
    return simulate(
        law,
        duration,
        body=body,
        scene=_measured_in(scene),
        accuracy=accuracy,
        sample_period=SAMPLE_PERIOD,
        stations=STATIONS,
        estimate=False,
    )


def measure(
    law: Law,
    settings: list[Accuracy],
    *,
    duration: float = 10.0,
    body: Body,
    scene: Scene,
    repeats: int = 5,
    say: Callable[[str], None] = lambda text: None,
) -> Trade:
    """Simulate `duration` [s] of `law` with every setting and measure errors and times.

    repeats: rounds of timing. say(text): called with a line of progress. Settings that diverge are listed in
    `Trade.unstable`.
    """
    say("the reference run, and a check of it")
    reference = swim(law, duration, body, scene, REFERENCE)
    reference_error = errors_of(swim(law, duration, body, scene, CHECK), reference)
    runs, unstable = {}, []
    say(f"errors of {len(settings)} settings")
    for accuracy in settings:
        try:
            runs[accuracy] = swim(law, duration, body, scene, accuracy)
        except SimulationStopped:
            unstable.append(accuracy)
    marching: dict[Accuracy, list[float]] = {accuracy: [] for accuracy in runs}
    whole: dict[Accuracy, list[float]] = {accuracy: [] for accuracy in runs}
    for repeat in range(repeats):
        say(f"times, round {repeat + 1} of {repeats}")
        for accuracy in runs:
            start = time.thread_time()
            swimmer = _ready(law, body, scene, accuracy)
            begin = time.thread_time()
            swimmer.advance(duration)
            end = time.thread_time()
            marching[accuracy].append(end - begin)
            whole[accuracy].append(end - start)
    rows = []
    for accuracy, run in runs.items():
        pose, torque = errors_of(run, reference)
        seconds = statistics.median(whole[accuracy])
        rows.append(
            Measured(
                accuracy=accuracy,
                nodes=run.nodes,
                step=duration / max(1, run.steps),
                pose_error=pose,
                torque_error=torque,
                evaluations=run.evaluations,
                microseconds=1e6 * statistics.median(marching[accuracy]) / max(1, run.evaluations),
                seconds=seconds,
                times_real_time=duration / seconds,
                memory=_ready(law, body, scene, accuracy).memory,
                run=run,
            )
        )
    return Trade(law, duration, reference, reference_error, rows, unstable, repeats)


def front(rows: list, error: Callable, cost: Callable) -> list:
    """The Pareto front: those `rows` that no other row beats in both error and cost, the cheapest first."""
    best, result = np.inf, []
    for row in sorted(rows, key=lambda row: (cost(row), error(row))):
        if error(row) < best:
            best = error(row)
            result.append(row)
    return result


def _measured_in(scene: Scene) -> Scene:
    """`scene` with the torque and without the ledger: errors and times are of the grid that the torque needs."""
    return replace(scene, ledger=False, internal_wrench=True)


def _ready(law: Law, body: Body, scene: Scene, accuracy: Accuracy) -> Simulation:
    swimmer = Simulation(body=body, scene=_measured_in(scene), accuracy=accuracy, stations=2)
    swimmer.adopt(law)
    return swimmer
