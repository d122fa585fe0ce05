# SPDX-License-Identifier: Apache-2.0
"""Error and cost of each setting for a swim, against a converged run, and the effect of each term of the model.

Errors are those of `accuracy`: of the head's position in the later half relative to the length of its path (or of the
body, if longer), and of the torque field relative to its greatest magnitude. Times are for the same steps on the same
nodes, without the samples. They are CPU times on one core, which equal wall times on an idle machine and stay
meaningful on a busy one.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any

from eel_dynamics.accuracy.accuracy import PRESETS, STANDARD, Accuracy
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.runs.companion import relative_errors

from eel_dynamics import Run, Swim
from eel_studies.reference import attempts, cpu_seconds, front, reference_of
from eel_studies.scene_terms.terms import terms_of

RESOLUTIONS = (6.0, 8.0, 11.0, 16.0, 24.0, 36.0, 60.0, 110.0)  # points per body length
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10)  # relative error per adaptive step
STEPS = (0.1, 0.05, 0.02, 0.01, 0.005)  # s, of the classical method
ADAMS_ORDERS = (3, 4, 5, 6)
COARSE_POINTS, COARSE_TOLERANCE = 24.0, 1e-5  # most points and least tolerance of settings without kinks
ASKED_FOR = {name: name for name in PRESETS} | {f"target {text}": text for text in ("1e-3", "1e-5", "1e-7")}
REFERENCE = Accuracy(name="reference run", resolution=240.0, tolerance=1e-12)
METHODS = {  # name in `Accuracy`: in words; the last two for robots
    "adams": "Adams-Bashforth, adaptive steps",
    "dormand_prince": "Dormand-Prince, adaptive steps",
    "classical": "Runge-Kutta, fixed steps",
    "dormand_prince of robots": "Rosenbrock, adaptive steps",
    "classical of robots": "Rosenbrock, fixed steps",
}
SAMPLE_PERIOD = 0.05  # s
REACHED = 1e-9  # wanted relative error of a reference
MOST_SECONDS = 20.0  # of CPU time, for a reference and for all settings: costly scenes get fewer settings
FINE = "fine"  # preset for the compared models, whose differences are far greater than its errors
DEARER = 3.0  # mean time of a setting, in times of a standard swim
ERROR, SECONDS = attrgetter("error"), attrgetter("seconds")  # of a row


@dataclass(frozen=True)
class Measured:
    """Relative errors of a setting, at least the reference's, and its cost without ledger and samples."""

    accuracy: Accuracy
    position: float
    torque: float
    seconds: float  # CPU time of the whole run on one core, set-up included
    run: Run

    @property
    def error(self) -> float:
        """The greater of both errors: the one that `accuracy` refers to."""
        return max(self.position, self.torque)

    @property
    def times_real_time(self) -> float:
        """Simulated seconds per second."""
        return float(self.run.time[-1]) / self.seconds


@dataclass(frozen=True)
class Trade:
    """All measurements for a swim.

    reference_error: distance of the reference from another method on another grid. unstable: settings that diverged.
    terms: by name, errors of the model without a term, both at the accuracy `FINE`; without those that stop.
    """

    name: str  # of the scene
    swim: Swim
    reference: Run
    reference_error: float
    rows: list[Measured]
    unstable: list[Accuracy]
    terms: dict[str, ErrorEstimate]

    @property
    def duration(self) -> float:
        """[s]."""
        return float(self.swim.duration)

    @property
    def asked(self) -> list[Measured]:
        """The presets and targets among the rows, the cheapest first."""
        return sorted((row for row in self.rows if row.accuracy.name in ASKED_FOR), key=SECONDS)

    def front(self, error: Callable[[Measured], float] = ERROR) -> list[Measured]:
        """The Pareto front of an `error` against the time."""
        return front(self.rows, error, SECONDS)

    def within(self, pace: float) -> tuple[Measured, Measured | None]:
        """The setting with the least error within `pace` [s] per simulated second, and the same among those `asked`
        for.

        The second is None if none of these is as fast. `ValueError` if no setting is.
        """
        most = pace * self.duration
        rows, asked = ([row for row in rows if row.seconds <= most] for rows in (self.rows, self.asked))
        if not rows:
            fastest = 1e3 / max(row.times_real_time for row in self.rows)
            raise ValueError(f"{1e3 * pace:g} ms per second cannot be met here: the fastest run takes {fastest:.3g} ms")
        return min(rows, key=ERROR), min(asked, key=ERROR, default=None)


def bare(swim: Swim) -> Swim:
    """The `swim` for so many seconds with torque and samples, without the ledger."""
    scene = replace(swim.scene, ledger=False, internal_wrench=True)
    swim = swim.changed(scene=scene, sample_period=swim.sample_period or SAMPLE_PERIOD)
    if isinstance(swim.duration, str):
        swim = swim.changed(duration=float(swim.run(estimate=False).time[-1]))
    return swim


def settings(swim: Swim, quick: bool = False) -> list[Accuracy]:
    """Every combination of points and steps, and the settings `ASKED_FOR`, as they apply to `swim`.

    quick: every third value of points and of steps only.
    """
    every, scene = 3 if quick else 1, swim.scene
    orders = ADAMS_ORDERS if swim.robot is None else ()  # a robot has one method
    rows = []
    for resolution in RESOLUTIONS[::every]:
        nodes = f"{resolution:g} points"
        for tolerance in TOLERANCES[::every]:
            common: dict[str, Any] = {"resolution": resolution, "tolerance": tolerance}
            rows.append(Accuracy(name=f"{nodes}, tolerance {tolerance:g}", **common))
            for order in orders[::every]:
                name = f"{nodes}, tolerance {tolerance:g}, Adams {order}"
                rows.append(Accuracy(name=name, method="adams", order=order, **common))
                if resolution <= COARSE_POINTS and tolerance >= COARSE_TOLERANCE and scene.resistive:
                    rows.append(replace(rows[-1], name=f"{name}, no kinks", kinks="none"))
        for step in STEPS[::every]:
            rows.append(Accuracy(name=f"{nodes}, step {step:g} s", resolution=resolution, step=step))
    # Without a target, every run takes these settings as they are.
    asked = [replace(Accuracy.of(text).in_scene(scene), name=name) for name, text in ASKED_FOR.items()]
    return rows + [each.as_it_is() for each in asked]


def affordable(swim: Swim, quick: bool, repeats: int) -> tuple[list[Accuracy], int]:
    """The settings for a `bare` swim, and rounds of timing: fewer for a costly one, at least `ASKED_FOR` once.

    quick: as in `settings`.
    """
    standard = swim.changed(accuracy=Accuracy.of(STANDARD).in_scene(swim.scene))
    cost = DEARER * cpu_seconds([standard], float(swim.duration), 1)[0]
    for fewer, rounds in ((quick, repeats), (True, repeats), (True, 1)):
        rows = settings(swim, fewer)
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
    """Errors and times of a `bare` swim with each of the `rows` of settings, and errors without each term.

    repeats: rounds of timing. say(text): called with a line of progress. `SimulationStopped` if no reference reaches
    its end.
    """
    say("the reference: two methods on two grids")
    reference, apart = reference_of(swim, REACHED, least=0, seconds=MOST_SECONDS)
    say(f"errors of {len(rows)} settings")
    swims = [swim.changed(accuracy=each) for each in rows]
    runs = dict(zip(rows, attempts(swims, estimate=False), strict=True))
    steady = [each for each in swims if isinstance(runs[each.accuracy], Run)]
    times = cpu_seconds(steady, float(swim.duration), repeats, say)
    measured = []
    for each, seconds in zip(steady, times, strict=True):
        run = runs[each.accuracy]
        errors = relative_errors(run, reference)
        position, torque = (max(error or 0.0, apart) for error in (errors.position, errors.torque))
        measured.append(Measured(each.accuracy, position, torque, seconds, run))  # type: ignore[arg-type]
    say("the model without each of its terms")
    parts = {"": swim} | terms_of(swim)
    fine = [each.unchecked(accuracy=Accuracy.of(FINE).in_scene(each.scene).as_it_is()) for each in parts.values()]
    whole, *poorer = attempts(fine, estimate=False)
    found = zip(list(parts)[1:], poorer, strict=True)
    pairs = {name: run for name, run in found if isinstance(run, Run)} if isinstance(whole, Run) else {}
    terms = {name: relative_errors(run, whole) for name, run in pairs.items()}
    unstable = [accuracy for accuracy in rows if not isinstance(runs[accuracy], Run)]
    return Trade(name, swim, reference, apart, measured, unstable, terms)
