# SPDX-License-Identifier: Apache-2.0
"""The effect of each term on a swim, and the smallest scene that stays within a tolerance of the whole one.

Each effect is a relative difference from the swim with all terms: of the head's path (in the sense of `accuracy`), the
mean speed, the greatest torque and the cost of transport. All swims are a hundred times as exact as the tolerance, if
the motion allows it. Each estimates its own error; smaller effects are not resolved. Times are CPU times on one core.
The swims take turns, and medians count.
"""

import warnings
from dataclasses import dataclass, replace

import numpy as np
from eel_common.quantity import checked_instance, number
from eel_common.wording import one_line
from eel_dynamics.accuracy.accuracy import COARSEST, Accuracy
from eel_dynamics.analysis.measures import measures_of
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.runs.scene_file import words_of

from eel_dynamics import Run, Swim
from eel_studies.outputs import Table
from eel_studies.reference import attempts, cpu_seconds
from eel_studies.scene_terms.terms import TERMS, WITHIN, terms_of, without

MEASURES = {"mean_speed": "speed", "greatest_torque": "torque", "cost_of_transport": "cost of transport"}
EFFECTS = ("path", *MEASURES.values())
FINER = 1e-2  # of the tolerance: the error of the swims that are compared
EXACT_ENOUGH = 0.1  # of the tolerance: most error from the recommended scene's discretisation
COARSEST_COMPARED = 1e-4  # coarsest target of these swims
LEAST_TOLERANCE = 1e-7
ROUNDS = 5  # of timing
# Limit of a swim without a term: so many times the whole scene's evaluations per second, and at least so many.
DEARER, LEAST_EVALUATIONS = 100.0, 1e4


@dataclass(frozen=True)
class Effect:
    """The effect of leaving out a term. Relative; NaN for an undefined measure, infinite if the swim `stopped`."""

    path: float
    speed: float
    torque: float
    cost_of_transport: float
    seconds: float  # CPU time
    error: float  # estimated error of the swim itself
    stopped: str = ""

    @property
    def values(self) -> tuple[float, ...]:
        """The values of `EFFECTS`."""
        return self.path, self.speed, self.torque, self.cost_of_transport

    @property
    def worst(self) -> float:
        """The greatest defined value."""
        return max(abs(value) for value in self.values if not np.isnan(value))


@dataclass(frozen=True)
class Terms:
    """The effects of all terms on a `swim`, and the recommended scene.

    effects: by name of the term. dropped: the terms that `recommended` lacks; together they have the effect
    `together`, its coarser accuracy included. within: whether that is within the `tolerance`.
    """

    swim: Swim
    duration: float  # s
    tolerance: float
    whole: Effect
    effects: dict[str, Effect]
    dropped: list[str]
    recommended: Swim
    together: Effect
    restored: list[str]  # terms with little effect alone, but needed with others
    growth_rate: float  # 1/s, of errors; 0 for a motion that is not sensitive

    @property
    def left_out(self) -> list[str]:
        """The terms that the recommended scene lacks. Parts of a term that is left out are not named."""
        parts = {part for name in self.dropped for part in WITHIN.get(name, ())}
        return [name for name in self.dropped if name not in parts]

    @property
    def within(self) -> bool:
        """Whether the recommended scene is within the tolerance."""
        return self.together.worst <= self.tolerance

    def table(self) -> Table:
        """A row for each term, and one each for the whole and the recommended scene."""
        rows = [("nothing", *("",) * len(EFFECTS), f"{1e3 * self.whole.seconds:.3g}", "")]
        for name, effect in sorted(self.effects.items(), key=lambda item: -item[1].worst):
            rows.append((name, *self._cells(effect), self._verdict(name)))
        rows.append(("recommended scene", *self._cells(self.together), "within" if self.within else "NOT within"))
        return Table(("left out", *EFFECTS, "CPU ms", f"tolerance {self.tolerance:g}"), rows, (0, 6))

    def _cells(self, effect: Effect) -> tuple[str, ...]:
        if effect.stopped:
            return ("stops", *("",) * (len(EFFECTS) - 1), "")
        floor = max(effect.error, self.whole.error)
        path = f"< {floor:.1e}" if effect.path <= floor else f"{effect.path:.1e}"
        return (path, *map(_percent, effect.values[1:]), f"{1e3 * effect.seconds:.3g}")

    def _verdict(self, name: str) -> str:
        if name in self.dropped:
            return "can go"
        if name in self.restored:
            return "needed with others"
        return "matters" if self.effects[name].worst > self.tolerance else "little, but no file can be without it"

    def about(self) -> str:
        """The recommendation in words."""
        names = f"without {', '.join(self.left_out)}" if self.left_out else "all terms"
        speed = self.whole.seconds / self.together.seconds if self.together.seconds else np.nan
        lines = [
            f"Recommended: {names}; accuracy {self.recommended.accuracy.name}. It differs by at most "
            f"{self.together.worst:.1e} and takes 1/{speed:.3g} of the CPU time."
        ]
        if self.growth_rate:
            lines.append(
                f"The path is sensitive: errors grow by a factor of e in {1.0 / self.growth_rate:.2g} s, so that any "
                "term changes a long path. Judge such a scene by a shorter duration."
            )
        return "\n".join(lines)


def terms(swim: Swim, tolerance: float = 0.02) -> Terms:
    """The effect of each term of the model on `swim`, and the smallest scene that differs by at most `tolerance`.

    Terms with a small effect are left out together. If their joint effect is too large, the largest of them come back.
    The remaining scene is swum again, at an accuracy of a tenth of the tolerance, against the whole one. `ValueError`
    for a bad argument; `SimulationStopped` if the whole scene cannot be swum.
    """
    checked_instance("swim", swim, Swim)
    tolerance = number("tolerance", tolerance, minimum=LEAST_TOLERANCE, maximum=1.0)
    fine = Accuracy.of(min(FINER * tolerance, COARSEST_COMPARED))
    exact = Accuracy.of(float(f"{min(EXACT_ENOUGH * tolerance, COARSEST):.3g}"))
    scene = replace(swim.scene, internal_wrench=True, ledger=True)
    (whole,) = attempts([swim], scene=scene, accuracy=fine, estimate=True)
    if isinstance(whole, Exception):
        raise whole
    compared = swim.changed(scene=scene, duration=float(whole.time[-1]), sample_period=float(np.diff(whole.time)[0]))
    parts = terms_of(compared)
    most = max(LEAST_EVALUATIONS, DEARER * whole.evaluations / float(whole.time[-1]))
    swum = attempts(parts.values(), accuracy=fine, most_evaluations=most, estimate=True)
    effects = {name: _effect(run, whole) for name, run in zip(parts, swum, strict=True)}
    small = [name for name in parts if effects[name].worst <= tolerance and _may_go(parts[name], swim)]
    dropped, restored = sorted(small, key=lambda name: effects[name].worst), []
    while True:
        (run,) = attempts([without(compared, dropped)], accuracy=exact, estimate=True)
        together = _effect(run, whole)
        if together.worst <= tolerance or not dropped:
            break
        restored.append(dropped.pop())
    recommended = without(swim, dropped).changed(accuracy=exact)
    own = [TERMS[name](swim) for name in parts]
    first, *others, last = cpu_seconds([swim, *own, recommended], float(whole.time[-1]), ROUNDS)
    effects = {name: replace(effects[name], seconds=took) for name, took in zip(parts, others, strict=True)}
    nothing, together = replace(_effect(whole, whole), seconds=first), replace(together, seconds=last)
    duration, error = float(whole.time[-1]), whole.error_estimate
    rate = error.growth_rate if error is not None and error.sensitive(duration) else 0.0
    return Terms(swim, duration, tolerance, nothing, effects, dropped, recommended, together, restored, rate)


def _may_go(without: Swim, swim: Swim) -> bool:
    """Whether the scene `without` a term has the same law as `swim`, and can be written to a file if `swim` can."""
    if without.law is not swim.law:
        return False
    for each in (swim, without):
        try:
            words_of(each)
        except ValueError:
            return each is swim
    return True


def _effect(run: Run | Exception, whole: Run) -> Effect:
    if isinstance(run, Exception):
        return Effect(np.inf, np.inf, np.inf, np.inf, np.nan, np.inf, one_line(run))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found, base = _measures(run), _measures(whole)
    speed, torque, cost = ((found[name] - base[name]) / abs(base[name]) if base[name] else np.nan for name in MEASURES)
    error = np.inf if run.error_estimate is None else run.error_estimate.worst
    return Effect(relative_errors(run, whole).position, speed, torque, cost, np.nan, error)


def _measures(run: Run) -> dict[str, float]:
    """The `MEASURES` of a run. The greatest torque is taken at samples if it is unknown in between, as for a robot."""
    found = measures_of(run, tuple(MEASURES))
    if np.isnan(found["greatest_torque"]) and run.torque is not None:
        found["greatest_torque"] = float(np.linalg.norm(run.torque, axis=2).max())
    return found


def _percent(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:+.2%}"
