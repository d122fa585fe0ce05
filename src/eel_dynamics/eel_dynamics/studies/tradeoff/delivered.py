"""What the targets deliver: errors of runs relative to their targets, and error estimates relative to the errors.

The runs cover the gaits of the library and random laws that the calibration does not use, on both bodies, in the scenes
of the calibration. Errors are those of `relative_errors`, against a run with far more points and far smaller steps.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from eel_dynamics.accuracy.accuracy import Accuracy, key_of, table
from eel_dynamics.runs.error_estimate import ErrorEstimate, relative_errors
from eel_dynamics.studies.calibration.calibration import REFERENCE, Case, cases, swim
from eel_dynamics.studies.tradeoff.table import laid_out

TARGETS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)  # each a tenth of the one before
UNSEEN = range(100, 108)  # seeds of laws that the calibration does not use
FAR = 30.0  # factor below the target, beyond which the run was needlessly expensive
CLOSE = 10.0  # factor between an estimate and the true error
LEAST = 1e-11  # least error that a reference resolves
HEAD = (
    *(
        "scene",
        "motion",
        "error of",
        "trials",
        "above the target",
        "within 30 below it",
        "coarsest setting meets it",
        "farther",
    ),
    *("target by error, median", "greatest", "estimates within 10 of the truth", "worst"),
)


@dataclass(frozen=True)
class Trial:
    """One run at a target. Errors are relative. coarse: error with the coarsest settings of the table for such runs."""

    case: Case
    target: float
    error: ErrorEstimate
    estimate: ErrorEstimate
    coarse: float

    @property
    def below(self) -> float:
        """The target divided by the error."""
        return self.target / max(self.error.worst, LEAST)

    @property
    def waived(self) -> bool:
        """Whether the coarsest settings already meet the target, so that no cheaper ones exist."""
        return self.coarse <= self.target

    @property
    def far(self) -> bool:
        """Whether the error is more than a factor `FAR` below the target, although coarser settings exist."""
        return self.below > FAR and not self.waived

    @property
    def misjudged(self) -> float:
        """Factor (>= 1) between estimate and error, the greater of position and torque."""
        pairs = (self.estimate.position, self.error.position), (self.estimate.torque, self.error.torque)
        ratios = [max(estimate, LEAST) / max(error, LEAST) for estimate, error in pairs if error is not None]
        return max(max(ratio, 1.0 / ratio) for ratio in ratios)


def trials_of(case: Case, targets=TARGETS, reference=None) -> list[Trial]:
    """The runs of a case at those `targets` that the table has, compared with a `reference` run (None: simulate it)."""
    rows = table()[key_of(case.scene, case.plane)]
    reference = reference or swim(case, REFERENCE)
    coarsest = Accuracy.of(rows[0]["target"]).in_scene(case.scene, case.plane).as_it_is()
    coarse = relative_errors(swim(case, coarsest), reference).worst
    found = []
    for target in (each for each in targets if each >= rows[-1]["target"]):
        run = swim(case, target)
        found.append(Trial(case, target, relative_errors(run, reference), run.error_estimate, coarse))
    return found


def deliver(seeds=UNSEEN, targets=TARGETS, say: Callable = lambda text: None) -> list[Trial]:
    """The trials of all cases, with and without drag. seeds: of the random laws; say(text): called with progress."""
    found = []
    for drag in (True, False):
        for case in cases(drag, seeds):
            say(f"what the targets deliver: {case.name}")
            reference = swim(case, REFERENCE)
            lean = replace(case, scene=replace(case.scene, internal_wrench=False))
            found += trials_of(case, targets, reference) + trials_of(lean, targets, reference)
    return found


def delivered_table(trials: list[Trial], *, markdown: bool = False) -> str:
    """The distribution of the trials as a table: a row for each kind of scene and motion, and one for all."""
    groups = {}
    for trial in trials:
        scene = "with drag" if trial.case.scene.resistive else "without drag"
        motion = "in a plane" if trial.case.plane else "in space"
        quantity = "position and torque" if trial.case.scene.internal_wrench else "position, motion alone"
        groups.setdefault((scene, motion, quantity), []).append(trial)
    groups = {key: groups[key] for key in sorted(groups)} | {("all", "all", "all"): trials}
    return laid_out(HEAD, [_row(*key, part) for key, part in groups.items()], markdown)


def _row(scene: str, motion: str, quantity: str, trials: list[Trial]) -> list[str]:
    below = np.array([trial.below for trial in trials])
    counted = np.array([trial.below for trial in trials if not trial.waived])
    misjudged = np.array([trial.misjudged for trial in trials])
    within = sum(1.0 <= trial.below <= FAR for trial in trials)
    waived = sum(trial.waived and trial.below > FAR for trial in trials)
    return [
        *(scene, motion, quantity, str(len(trials)), str(int(np.sum(below < 1.0))), str(within), str(waived)),
        *(str(sum(trial.far for trial in trials)), f"{np.median(below):.0f}", f"{np.max(counted, initial=0.0):.0f}"),
        *(f"{np.sum(misjudged <= CLOSE)}", f"{np.max(misjudged):.1f}"),
    ]


@dataclass(frozen=True)
class Scatter:
    """Scatter about their mean of the errors of different runs at one target, with the same settings of the table.

    decades: standard deviation of the decadic logarithms of the errors. likeness: correlation of the deviations from
    the mean at a target and at a tenth of it in the same run. It is 1 if a run with small errors at one target has
    small errors at all, and 0 if the deviations are independent.
    """

    decades: float
    likeness: float

    @property
    def sides(self) -> float:
        """Half the width of a factor `FAR`, in standard deviations."""
        return 0.5 * np.log10(FAR) / self.decades


def scatter_of(trials: list[Trial]) -> Scatter:
    """Scatter over the trials whose settings could have been coarser.

    Means are taken over trials of the same target, drag, motion and quantity.
    """
    groups, tenth = {}, dict(pairwise(TARGETS))
    for trial in trials:
        if not trial.waived:
            scene = trial.case.scene
            kind = trial.target, scene.resistive, scene.friction, scene.internal_wrench, trial.case.plane
            groups.setdefault(kind, {})[trial.case.name] = np.log10(trial.below)
    left = {
        (name, *kind): value - np.mean(list(group.values()))
        for kind, group in groups.items()
        for name, value in group.items()
    }
    pairs = [
        (value, left[beside])
        for (name, target, *kind), value in left.items()
        if (beside := (name, tenth.get(target), *kind)) in left
    ]
    freedom = len(left) - len(groups)
    decades = np.sqrt(sum(value**2 for value in left.values()) / freedom)
    return Scatter(float(decades), float(np.corrcoef(np.transpose(pairs))[0, 1]))


def scatter_line(trials: list[Trial]) -> str:
    """The scatter of the `trials`, in words."""
    found = scatter_of(trials)
    return (
        f"From swim to swim, errors at a target scatter by a factor of {10.0**found.decades:.1f} (standard deviation "
        f"of the logarithm: {found.decades:.2f} decades; correlation of a swim's luck at a target and at a tenth of "
        f"it: {found.likeness:.2f}), so a factor of {FAR:g} is {found.sides:.1f} standard deviations to either side."
    )


def farthest(trials: list[Trial]) -> list[str]:
    """The trials that are needlessly far below their target, the farthest first, in words."""
    far = sorted((trial for trial in trials if trial.far), key=lambda trial: -trial.below)
    return [f"{_said(trial)}: {trial.below:.0f}" for trial in far]


def exceeding(trials: list[Trial]) -> list[str]:
    """The trials that miss their target, in words."""
    missed = (trial for trial in trials if trial.below < 1.0)
    return [f"{_said(trial)}: {trial.error.worst:.1e}" for trial in missed]


def _said(trial: Trial) -> str:
    return f"{trial.case.name}{'' if trial.case.scene.internal_wrench else ', motion alone,'} at {trial.target:g}"
