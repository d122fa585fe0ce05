# SPDX-License-Identifier: Apache-2.0
"""The trade-off as a picture: error against times real time, both Pareto fronts, and the errors of simpler models.

Methods differ in colour (Okabe and Ito) and in mark, so that they can be told apart in print without colour.
"""

from typing import Any

import numpy as np
from eel_dynamics.accuracy.accuracy import PRESETS

from eel_studies.pictures.style import BLACK, BLUE, GREEN, GREY, ORANGE
from eel_studies.tradeoff.delivered import LEAST
from eel_studies.tradeoff.measuring import Trade, front
from eel_studies.tradeoff.models import Model
from eel_studies.tradeoff.settings import METHODS

LOOKS = {"adams": (BLUE, "o"), "dormand_prince": (GREEN, "s"), "classical": (ORANGE, "^")}
DELIVERED_SIZE = (4.5, 3.6)  # inches
SIZE = 11.0, 5.4  # inches
LEADER = 1.0, 1.06  # axes: where the line from a model's error to its name begins and ends
FLOOR = 3.0  # times the reference's own error: differences below it are not significant


def draw_trade(figure, trade: Trade, models: list[Model]):
    """Draw the trade-off into an empty matplotlib figure: error of pose on the left, of torque on the right."""
    figure.suptitle(
        f"Gait {trade.law.name!r}, {trade.duration:g} s: what exactness costs, and what a poorer model is off by"
    )
    panels = figure.subplots(1, 2, sharex=True)
    for axes, quantity, place in (
        (panels[0], "pose_error", 0),
        (panels[1], "torque_error", 1),
    ):
        _draw_panel(axes, trade, models, quantity, FLOOR * trade.reference_error[place])
    panels[0].set_ylabel("error of the head's position at the end, by its path")
    panels[1].set_ylabel("error of the torque along the body, by its greatest")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)


def _draw_panel(axes, trade: Trade, models: list[Model], quantity: str, floor: float):
    from matplotlib.patheffects import withStroke

    error = lambda row: max(getattr(row, quantity), floor)  # noqa: E731
    for method, (colour, mark) in LOOKS.items():
        rows = [row for row in trade.rows if row.accuracy.method == method]
        axes.plot(
            [row.times_real_time for row in rows],
            [error(row) for row in rows],
            mark,
            color=colour,
            markersize=4,
            alpha=0.45,
            markeredgewidth=0,
            label=METHODS[method],
        )
    best = front(trade.rows, error, lambda row: row.seconds)
    axes.plot(
        [row.times_real_time for row in best],
        [error(row) for row in best],
        color=BLACK,
        linewidth=1.4,
        label="Pareto front",
    )
    for row in best:
        axes.plot(row.times_real_time, error(row), LOOKS[row.accuracy.method][1], color=BLACK, markersize=5)
    presets = [row for row in trade.rows if row.accuracy.name in PRESETS]
    axes.plot(
        [row.times_real_time for row in presets],
        [error(row) for row in presets],
        "D",
        markerfacecolor="white",
        markeredgecolor=BLACK,
        markersize=7,
        linestyle="",
        label="presets",
    )
    for row in presets:
        axes.annotate(
            row.accuracy.name,
            (row.times_real_time, error(row)),
            xytext=(-7, 3),
            textcoords="offset points",
            ha="right",
            path_effects=[withStroke(linewidth=3, foreground="white")],
        )
    axes.set_xscale("log")
    axes.set_yscale("log")
    worst = max((getattr(model, quantity) for model in models if model.run is not None), default=1.0)
    axes.set_ylim(0.1 * floor, max(3.0, 2.0 * worst))
    axes.set_xlim(0.2 * min(row.times_real_time for row in trade.rows), None)
    axes.axhspan(0.1 * floor, floor, color=GREY, alpha=0.25, linewidth=0)
    said = {"transform": axes.get_yaxis_transform(), "va": "center", "ha": "right"}
    axes.text(0.98, 0.33 * floor, "as exact as the converged run itself", **said)
    axes.set_xlabel("times real time")
    axes.grid(alpha=0.3)
    _draw_models(axes, models, quantity, floor)


def _draw_models(axes, models: list[Model], quantity: str, floor: float):
    """A line for each simpler model, with its name at the right edge. Names that would overlap are moved apart."""
    shown = [model for model in models if model.run is not None and getattr(model, quantity) > floor]
    shown.sort(key=lambda model: getattr(model, quantity))
    low, high = np.log10(axes.get_ylim())
    values = [getattr(model, quantity) for model in shown]
    heights = _apart(list(np.log10(values)), 0.042 * (high - low), high)
    across = axes.get_yaxis_transform()
    for model, value, height in zip(shown, values, heights, strict=True):
        dashes = {"color": GREY, "linewidth": 0.8, "linestyle": (0, (5, 3))}
        axes.axhline(value, zorder=0, **dashes)
        leader = {"color": GREY, "linewidth": 0.6, "clip_on": False, "transform": across}
        axes.plot(LEADER, [value, 10.0**height], **leader)  # in the order of the values: they do not cross
        axes.text(LEADER[1] + 0.01, 10.0**height, model.name.split(" (")[0], transform=across, fontsize="small",
                  va="center")  # fmt: skip


def _apart(heights: list[float], gap: float, highest: float = np.inf) -> list[float]:
    """Ascending `heights`, moved as little as needed to lie `gap` apart and not above `highest`.

    Labels that touch form one centred group.
    """
    groups: list[list[Any]] = []  # [sum of heights, count]
    for height in heights:
        groups.append([height, 1])
        while len(groups) > 1 and _edge(groups[-1], -gap) < _edge(groups[-2], gap):
            total, count = groups.pop()
            groups[-1][0] += total
            groups[-1][1] += count
    apart = [total / count + gap * (place - 0.5 * (count - 1)) for total, count in groups for place in range(count)]
    return [min(height, highest - gap * above) for height, above in zip(apart, range(len(apart))[::-1], strict=True)]


def _edge(group: list, gap: float) -> float:
    """Upper edge of a group of labels, or its lower one for a negative gap."""
    return group[0] / group[1] + 0.5 * gap * group[1]


def draw_delivered(figure, trials):
    """True errors against estimates, both relative to the target."""
    axes = figure.subplots()
    kinds = ("motion alone", False, "o"), ("with torque", True, "s")
    for label, torque, marker in kinds:
        known = [each for each in trials if each.error is not None and (each.estimate.torque is not None) is torque]
        estimate = [max(each.estimate.worst, LEAST) / each.target for each in known]
        error = [max(each.error.worst, LEAST) / each.target for each in known]
        axes.loglog(estimate, error, marker, markersize=3, alpha=0.6, label=label)
    ends = [1e-4, 10.0]
    axes.plot(ends, ends, "k-", linewidth=0.8)
    axes.axhline(1.0, color="0.5", linewidth=0.8, linestyle="--")
    axes.set(xlabel="estimated error / target", ylabel="true error / target", xlim=ends, ylim=[1e-6, 10.0])
    axes.legend()
