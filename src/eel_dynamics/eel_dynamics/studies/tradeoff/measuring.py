"""Error and cost of each setting, against a run that has converged.

Errors as in `accuracy`: of the head's position at the end by the length of its path (or of the body, if longer), and of
the torque field by its greatest magnitude. Times are of the processor, for one core: on an idle machine they are the
wall's, on a busy one they still mean something. They are medians over repeats in which all settings take turns, so that
a disturbance is no setting's fault.
"""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from eel_gaits.law import Law

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.run import Run, simulate
from eel_dynamics.simulation.simulation import Simulation, SimulationStopped
from eel_dynamics.studies.tradeoff.settings import CHECK, REFERENCE

SAMPLE_PERIOD = 0.05  # s
STATIONS = 51


@dataclass(frozen=True)
class Measured:
    """A setting's error and cost. Times are for the motion alone (no ledger, no wrench, one sample at the end)."""

    accuracy: Accuracy
    nodes: int
    step: float  # s, mean
    pose_error: float
    torque_error: float
    evaluations: int
    microseconds: float  # per evaluation, of the march
    seconds: float  # of one core for the whole run, set-up included
    times_real_time: float
    memory: int  # bytes that the loops work on
    run: Run

    @property
    def error(self) -> float:
        """The worse of the two: what `accuracy` speaks of."""
        return max(self.pose_error, self.torque_error)


@dataclass(frozen=True)
class Trade:
    """All that was measured for a gait."""

    law: Law
    duration: float  # s
    reference: Run
    reference_error: tuple[float, float]  # of pose and torque, against a coarser one
    rows: list[Measured]
    unstable: list[Accuracy]  # settings that diverged
    repeats: int


def errors_of(run: Run, reference: Run) -> tuple[float, float]:
    """Error of pose and of torque of `run`, sampled as `reference` is."""
    way = max(reference.path_length, reference.body.length)
    pose = float(np.linalg.norm(run.position[-1] - reference.position[-1])) / way
    size = float(np.max(np.linalg.norm(reference.torque, axis=2)))
    return pose, float(np.max(np.linalg.norm(run.torque - reference.torque, axis=2))) / size if size else 0.0


def swim(law: Law, duration: float, body: Body, scene: Scene, accuracy: Accuracy) -> Run:
    """A run whose errors can be told."""
    return simulate(
        law,
        duration,
        body=body,
        scene=replace(scene, ledger=False, internal_wrench=True),
        accuracy=accuracy,
        sample_period=SAMPLE_PERIOD,
        stations=STATIONS,
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
    """Swim `law` with every setting. `say` is told what goes on."""
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
    lean = replace(scene, ledger=False, internal_wrench=False)
    marching = {accuracy: [] for accuracy in runs}
    whole = {accuracy: [] for accuracy in runs}
    for repeat in range(repeats):
        say(f"times, round {repeat + 1} of {repeats}")
        for accuracy in runs:
            start = time.thread_time()
            swimmer = _ready(law, body, lean, accuracy)
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
                nodes=nodes_of(swimmer := _ready(law, body, lean, accuracy)),
                step=duration / max(1, run.steps),
                pose_error=pose,
                torque_error=torque,
                evaluations=run.evaluations,
                microseconds=1e6 * statistics.median(marching[accuracy]) / max(1, run.evaluations),
                seconds=seconds,
                times_real_time=duration / seconds,
                memory=swimmer.memory,
                run=run,
            )
        )
    return Trade(law, duration, reference, reference_error, rows, unstable, repeats)


def front(rows: list, error: Callable, cost: Callable) -> list:
    """Those of `rows` that no other beats in error and cost at once, from the cheapest on (Pareto's front)."""
    best, result = np.inf, []
    for row in sorted(rows, key=lambda row: (cost(row), error(row))):
        if error(row) < best:
            best = error(row)
            result.append(row)
    return result


def nodes_of(swimmer: Simulation) -> int:
    return len(swimmer.grid.x)


def _ready(law: Law, body: Body, scene: Scene, accuracy: Accuracy) -> Simulation:
    swimmer = Simulation(body=body, scene=scene, accuracy=accuracy, stations=2)
    swimmer.adopt(law)
    return swimmer
