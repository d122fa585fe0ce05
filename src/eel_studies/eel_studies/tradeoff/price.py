# SPDX-License-Identifier: Apache-2.0
"""The price of a target: what every setting costs and delivers over random swims, and what the targets do."""

from collections.abc import Callable
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.swim import Swim
from eel_dynamics.simulation.stopping import SimulationStopped

from eel_studies.pictures import BLACK, BLUE, GREY, ORANGE
from eel_studies.reference import REFERENCES
from eel_studies.tradeoff.delivered import LEAST, TARGETS, swims_of

SWIMS = 24  # of the settings: each takes some milliseconds
RESOLUTIONS = 4.0, 10.0, 16.0, 24.0, 32.0, 48.0
TOLERANCES = tuple(10.0 ** (-0.5 * k) for k in range(4, 19))
METHODS = ("dormand_prince", 5), ("adams", 5), ("adams", 3)


class Price(NamedTuple):
    """Medians over the swims. cost: nodes times evaluations, by simulated period; whole: with the error's estimate."""

    error: float
    cost: float
    whole: float


def prices(count: int, seed: int, say: Callable[[str], object] = lambda text: None) -> tuple[list[Price], list[Price]]:
    """The prices of all settings and of the `TARGETS`, over at most `SWIMS` of the `count` swims of a `seed`."""
    swims = swims_of(min(count, SWIMS), seed)
    known = [(swim, reference) for swim in swims if (reference := _reference(swim)) is not None]
    say(f"the price of a target: {len(known)} swims")
    settings = [
        Accuracy(name="setting", resolution=points, tolerance=tolerance, method=method, order=order)
        for points, tolerance, (method, order) in product(RESOLUTIONS, TOLERANCES, METHODS)
    ]
    grey = [_price(known, each, estimate=False) for each in settings]
    return grey, [_price(known, target, estimate=True) for target in TARGETS]


def _reference(swim: Swim) -> Run | None:
    try:
        return swim.run(accuracy=REFERENCES[1][0], estimate=False)
    except SimulationStopped:
        return None


def _price(known: list[tuple[Swim, Run]], accuracy: Accuracy | float, *, estimate: bool) -> Price:
    rows = []
    for swim, reference in known:
        periods = float(swim.duration) / swim.law.terms[0].period
        try:
            run = swim.run(accuracy=accuracy, estimate=estimate)
        except SimulationStopped:
            rows.append((np.inf, np.inf, np.inf))
            continue
        measured = run.error_estimate if estimate else None
        cost, beside = run.nodes * run.evaluations, measured.cost if measured is not None else 0
        rows.append((relative_errors(run, reference).worst, cost / periods, (cost + beside) / periods))
    return Price(*np.median(rows, axis=0).tolist())


def draw_prices(figure: Any, grey: list[Price], targets: list[Price]) -> None:
    """Cost over delivered error: every setting a grey point, and the targets, without and with their estimate."""
    axes = figure.subplots()
    others, error = ([max(each.error, LEAST) for each in prices] for prices in (grey, targets))
    axes.loglog(others, [each.cost for each in grey], ".", color=GREY, label="settings")
    axes.loglog(error, [each.cost for each in targets], "o-", color=BLUE, label="targets: the run")
    axes.loglog(error, [each.whole for each in targets], "s:", color=ORANGE, label="with its estimate")
    for target, at, price in zip(TARGETS, error, targets, strict=True):
        axes.annotate(f"{target:g}", (at, price.cost), xytext=(0, -11), textcoords="offset points", color=BLACK)
    axes.set(xlabel="delivered error, median", ylabel="nodes times evaluations, by period")
    axes.set_xlim(10.0, 1e-9)
    axes.legend()
