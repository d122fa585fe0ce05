# SPDX-License-Identifier: Apache-2.0
"""Measures what the targets deliver, and how well runs judge their own error, over random swims.

Swims are drawn from bends in space and in the plane, periods of 0.2 to 3 s, densities of 200 to 8,000 kg/m^3, the
`FRICTIONS`, three bodies, heads at rest and moving, and durations of 1 to 16 s. The true error is the distance from a
`reference`: two methods on two grids that agree to a tenth of the target, and of the estimate where any do. It is known
as well as they agree.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.batches.simulate_batch import in_threads
from eel_dynamics.model.initial_state import AT_REST
from eel_dynamics.runs.companion import relative_errors
from eel_studies.outputs import Table
from eel_studies.reference import reference_of

from eel_dynamics import Accuracy, Body, Scene, SimulationStopped, Swim
from eel_gaits import Law, Ramp, Term

TARGETS = 1e-2, 1e-3, 1e-4, 1e-5, 1e-6
AGREED = 0.1  # of the target and of the estimate, to which the references are to agree
LEAST = 1e-11  # least error that a reference resolves
COUNT, SEED = 500, 1
PERIODS, DURATIONS, DENSITIES = (0.2, 3.0), (1.0, 16.0), (200.0, 8000.0)  # s, s, kg/m^3
FRICTIONS = "printed", "laminar", "blended", "none"  # a further law would make other swims of a seed
SPEED = 0.3  # m/s and rad/s, of heads that move at the start


@dataclass(frozen=True)
class Trial:
    """One swim at a target.

    error: its true error; None where the references do not agree. uncertainty: their distance. reported: whether the
    run says that it misses its target. cost: nodes times evaluations of all its runs, relative to those of the
    delivered run alone.
    """

    swim: Swim  # with the target as its accuracy
    error: Any  # ErrorEstimate | None
    uncertainty: float
    estimate: ErrorEstimate
    reported: bool
    cost: float

    @property
    def target(self) -> float:
        """The relative error that was asked for."""
        return float(self.swim.accuracy.target or 0.0)

    @property
    def missed(self) -> bool:
        """Whether the error is above the target, or not known, and the run does not say so."""
        return not self.reported and self.error is not None and self.error.worst > self.target

    @property
    def underestimated(self) -> float:
        """The true error, less what the reference leaves uncertain, divided by its estimate."""
        return float(max(self.error.worst - self.uncertainty, LEAST) / max(self.estimate.worst, LEAST))


def drawn(rng: np.random.Generator) -> Swim:
    """One swim, with its target as accuracy."""

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    body = (Body.boyer2010(), Body.kern2006(), Body.kern2006(0.3))[rng.integers(3)]
    length, period = body.length, between(*PERIODS)
    envelope = (Ramp(0.0, period * rng.uniform(0.5, 2.0), 1.0),)
    amplitude = rng.uniform(0.2, 1.5, 3) / length ** np.arange(1, 4)
    wavelength = float(length * rng.uniform(0.7, 2.0))
    wave: dict[str, Any] = {"wavelength": wavelength, "period": period, "envelope": envelope}
    terms = [Term(axis="yaw", amplitude=tuple(amplitude.tolist()), **wave)]
    kind, bend = rng.integers(3), (float(rng.uniform(-1.0, 1.0)) / length,)
    if kind == 1:
        terms.append(Term(axis="pitch", amplitude=bend, phase=0.5 * np.pi, envelope=envelope))
    elif kind == 2:
        terms.append(Term(axis="pitch", amplitude=bend, **wave))
    wrench = bool(rng.integers(2))
    water: dict[str, Any] = {"density": between(*DENSITIES), "friction": str(rng.choice(FRICTIONS))}
    duration, target = between(*DURATIONS), float(rng.choice(TARGETS))
    scene = Scene(**water, internal_wrench=wrench, ledger=False)
    start = AT_REST._replace(twist=rng.normal(size=6) * SPEED * (rng.random() < 0.3))
    return Swim(Law(*terms, name="drawn"), body, scene, Accuracy.of(target), start, duration=duration, stations=11)


def trial_of(swim: Swim) -> Trial | None:
    """The trial of one swim; None for a swim that stops before its end, with its reason."""
    target = swim.accuracy.target or 0.0
    try:
        run = swim.run()
        estimate = run.error_estimate
        assert estimate is not None
        reference, uncertainty = reference_of(swim, AGREED * min(target, max(estimate.worst, 10.0 * LEAST)))
    except SimulationStopped:
        return None
    known = uncertainty < AGREED * target
    return Trial(
        swim=swim,
        error=relative_errors(run, reference) if known else None,
        uncertainty=uncertainty,
        estimate=estimate,
        reported=bool(estimate.over_target(target, float(run.time[-1]))),
        cost=1.0 + estimate.cost / (run.nodes * run.evaluations),
    )


def deliver(count: int = COUNT, seed: int = SEED, say: Callable[[str], object] = lambda text: None) -> list[Trial]:
    """The trials of `count` swims that `seed` draws. say(text): called with progress."""
    say(f"what the targets deliver: {count} swims of seed {seed}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a trial keeps whether its run reported that it misses its target
        swims = [drawn(np.random.default_rng([seed, index])) for index in range(count)]
        return [each for each in in_threads(trial_of, swims) if each is not None]


def _groups(trials: list[Trial]) -> dict[str, list[Trial]]:
    """Those of the motion alone, and those with torque."""
    return {
        "position, motion alone": [each for each in trials if each.estimate.torque is None],
        "position and torque": [each for each in trials if each.estimate.torque is not None],
    }


def delivered_table(trials: list[Trial]) -> Table:
    """The counts of the trials as a table: a row for each of the groups, and for all."""
    columns = {name: _cells(part) for name, part in (_groups(trials) | {"all": trials}).items()}
    return Table(("error of", *columns["all"]), [(name, *each.values()) for name, each in columns.items()])


def _cells(trials: list[Trial]) -> dict[str, str]:
    known = [each for each in trials if each.error is not None]
    above = [each for each in known if each.error.worst > each.target]
    ratios = np.array([each.underestimated for each in known] or [np.nan])
    below = np.array([each.target / max(each.error.worst, LEAST) for each in known] or [np.nan])
    return {
        "swims": str(len(trials)),
        "with a reference": str(len(known)),
        "above the target": str(len(above)),
        "of these not reported": str(sum(each.missed for each in known)),
        "reported without a reference": str(sum(each.reported for each in trials if each.error is None)),
        "estimate below the error": str(np.sum(ratios > 1.0)),
        "by more than 2": str(np.sum(ratios > 2.0)),
        "error by estimate, median": f"{np.median(ratios):.3f}",
        "greatest": f"{np.max(ratios):.2f}",
        "target by error, median": f"{np.median(below):.0f}",
        "cost, median": f"{np.median([each.cost for each in trials] or [np.nan]):.2f}",
    }


def draw_delivered(figure: Any, trials: list[Trial]) -> None:
    """Draw true errors against estimates, both relative to the target, into an empty matplotlib figure."""
    axes = figure.subplots()
    for marker, (label, part) in zip("os", _groups(trials).items(), strict=True):
        known = [each for each in part if each.error is not None]
        estimate = [max(each.estimate.worst, LEAST) / each.target for each in known]
        error = [max(each.error.worst, LEAST) / each.target for each in known]
        axes.loglog(estimate, error, marker, markersize=3, alpha=0.6, label=label)
    ends = [1e-4, 10.0]
    axes.plot(ends, ends, "k-", linewidth=0.8)
    axes.axhline(1.0, color="0.5", linewidth=0.8, linestyle="--")
    axes.set(xlabel="estimated error / target", ylabel="true error / target", xlim=ends, ylim=[1e-6, 10.0])
    axes.legend()
