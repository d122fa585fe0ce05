# SPDX-License-Identifier: Apache-2.0
"""Error and cost of each setting for a swim, against a converged run; and what each term of the model is worth.

Errors are those of `accuracy`: of the head's position in the later half relative to the length of its path (or of the
body, if longer), and of the torque field relative to its greatest magnitude. Times are those of the same steps on the
same nodes, without the samples: CPU times of one core, which equal wall times on an idle machine and stay meaningful on
a busy one. They are medians over repeats, in which all settings take turns, so that a disturbance does not fall on a
single one.
"""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.budget import Budget
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.swim import Swim
from eel_dynamics.simulation.stopping import SimulationStopped

from eel_studies.reference import bare, front, reference_of, settled
from eel_studies.scene_terms.terms import terms_of
from eel_studies.tradeoff.settings import ASKED_FOR, REFERENCE, settings
from eel_studies.workers import in_threads

SAMPLE_PERIOD = 0.05  # s
REACHED = 1e-9  # relative error of a reference that is wanted
MOST_SECONDS = 20.0  # of CPU time, of a reference and of all settings: dear scenes get fewer of them
DEARER = 3.0  # times a standard swim, that a setting takes in the mean
SECONDS = attrgetter("seconds")  # of a row: its cost


@dataclass(frozen=True)
class Measured:
    """Relative errors of a setting, no less than that of the reference, and its cost without ledger and samples."""

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
class Worth:
    """Relative errors of a model without a term, compared with the whole one; infinite where it stopped."""

    name: str
    pose_error: float
    torque_error: float
    stopped: str = ""


@dataclass(frozen=True)
class Trade:
    """All that was measured for a swim."""

    name: str  # of the scene
    swim: Swim
    reference: Run
    reference_error: float  # distance of the reference from another method on another grid
    rows: list[Measured]
    unstable: list[Accuracy]  # settings that diverged
    worths: list[Worth]

    @property
    def duration(self) -> float:
        """[s]."""
        return float(self.swim.duration)

    def within(self, budget: Budget) -> tuple[Measured, Measured | None]:
        """The setting with the least error within the `budget`, and the like among those `ASKED_FOR`, or None.

        `ValueError` where nothing is as fast.
        """
        rows = [row for row in self.rows if row.seconds <= budget.seconds_per_second * self.duration]
        if not rows:
            fastest = 1e3 / max(row.times_real_time for row in self.rows)
            raise ValueError(f"{budget.name!r} cannot be met here: the fastest run takes {fastest:.3g} ms per second")
        asked = [row for row in rows if row.accuracy.name in ASKED_FOR]
        return min(rows, key=attrgetter("error")), min(asked, key=attrgetter("error"), default=None)


def affordable(swim: Swim, quick: bool, repeats: int) -> tuple[list[Accuracy], int]:
    """The settings for a `swim`, and rounds of timing: fewer where it is dear, down to what is `ASKED_FOR`, once.

    quick: as in `settings`. `SimulationStopped` where the swim cannot go on.
    """
    swim = settled(bare(swim), SAMPLE_PERIOD)
    cost = DEARER * _timed(swim, Accuracy.of("standard").in_scene(swim.scene))[1]
    for fewer, rounds in ((quick, repeats), (True, repeats), (True, 1)):
        rows = settings(swim.scene, fewer)
        if cost * len(rows) * (rounds + 1) <= MOST_SECONDS:
            return rows, rounds
    return rows[-len(ASKED_FOR) :], 1


def measure(
    swim: Swim,
    rows: list[Accuracy],
    repeats: int = 5,
    say: Callable[[str], object] = lambda text: None,
    name: str = "scene",
) -> Trade:
    """Errors and times of a `swim` with every one of the `rows` of settings, and the errors of models without a term.

    repeats: rounds of timing. say(text): called with a line of progress. `SimulationStopped` where no reference comes
    to its end. Settings that diverge are listed in `Trade.unstable`.
    """
    say("the reference: two methods on two grids")
    swim = settled(bare(swim), SAMPLE_PERIOD)
    reference, apart = reference_of(swim, REACHED, least=0, seconds=MOST_SECONDS)
    say(f"errors of {len(rows)} settings")
    found = zip(rows, in_threads(lambda each: _swum(swim._replace(accuracy=each)), rows), strict=True)
    runs = {accuracy: run for accuracy, run in found if isinstance(run, Run)}
    unstable = [accuracy for accuracy in rows if accuracy not in runs]
    times: dict[Accuracy, list[tuple[float, float, int]]] = {accuracy: [] for accuracy in runs}
    for repeat in range(repeats):
        say(f"times, round {repeat + 1} of {repeats}")
        for accuracy in runs:
            times[accuracy].append(_timed(swim, accuracy))
    measured = []
    for accuracy, run in runs.items():
        marching, seconds, memory = map(statistics.median, zip(*times[accuracy], strict=True))
        errors, microseconds = relative_errors(run, reference), 1e6 * marching / max(1, run.evaluations)
        times_real_time = float(swim.duration) / seconds
        cost = microseconds, seconds, times_real_time, int(memory)
        pose, torque = (max(error or 0.0, apart) for error in (errors.position, errors.torque))
        measured.append(Measured(accuracy, pose, torque, *cost, run))
    say("the model without each of its terms")
    parts = terms_of(swim)
    fine = REFERENCE if apart <= REACHED else Accuracy.of("fine").in_scene(swim.scene).as_it_is()
    poorer = in_threads(lambda each: _swum(each._replace(accuracy=fine)), parts.values())
    worths = [_worth(name, run, reference) for name, run in zip(parts, poorer, strict=True)]
    return Trade(name, swim, reference, apart, measured, unstable, worths)


def front_of(rows: list[Measured], error: Callable[[Measured], float] = attrgetter("error")) -> list[Measured]:
    """The Pareto front of an `error` against the time."""
    return front(rows, error, SECONDS)


def _swum(swim: Swim) -> Run | SimulationStopped:
    try:
        return swim.run(estimate=False, progress=lambda reached, left: None)
    except SimulationStopped as stopped:
        return stopped


def _timed(swim: Swim, accuracy: Accuracy) -> tuple[float, float, int]:
    """CPU time [s] of the march and of all, and the bytes that it works on."""
    start = time.thread_time()
    swimmer = swim.simulation(accuracy=accuracy, stations=2)
    begin = time.thread_time()
    swimmer.advance(float(swim.duration))
    end = time.thread_time()
    return end - begin, end - start, swimmer.memory


def _worth(name: str, run: Run | SimulationStopped, reference: Run) -> Worth:
    if isinstance(run, SimulationStopped):
        return Worth(name, float("inf"), float("inf"), str(run))
    errors = relative_errors(run, reference)
    return Worth(name, errors.position, errors.torque or 0.0)
