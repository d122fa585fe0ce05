# SPDX-License-Identifier: Apache-2.0
"""The trade-off as a picture: error against times real time, both Pareto fronts, and the errors without a term.

Methods differ in colour (Okabe and Ito) and in mark, so that they can be told apart in print without colour.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from eel_studies.pictures import BLACK, BLUE, GREEN, GREY, ORANGE, Axes, Figure
from eel_studies.tradeoff.measuring import Measured, Trade, front_of
from eel_studies.tradeoff.settings import ASKED_FOR, METHODS

LOOKS = {"adams": (BLUE, "o"), "dormand_prince": (GREEN, "s"), "classical": (ORANGE, "^")}
SIZE = 11.0, 5.4  # inches
LEADER = 1.0, 1.06  # axes: where the line from a model's error to its name begins and ends
FLOOR = 3.0  # times the reference's own error: differences below it are not significant


def draw_trade(figure: Figure, trade: Trade) -> None:
    """Draw the trade-off into an empty matplotlib figure: error of pose on the left, of torque on the right."""
    figure.suptitle(f"{trade.name}, {trade.duration:g} s: what exactness costs, and what a poorer model is off by")
    panels = figure.subplots(1, 2, sharex=True)
    for axes, quantity in zip(panels, ("pose_error", "torque_error"), strict=True):
        _draw_panel(axes, trade, quantity, FLOOR * trade.reference_error)
    panels[0].set_ylabel("error of the head's position, by its path")
    panels[1].set_ylabel("error of the torque along the body, by its greatest")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)


def _draw_panel(axes: Axes, trade: Trade, quantity: str, floor: float) -> None:
    from matplotlib.patheffects import withStroke

    def error(row: Measured) -> float:
        return float(max(getattr(row, quantity), floor))

    def plot(rows: Iterable[Measured], *mark: str, **looks: Any) -> None:
        axes.plot(*zip(*((row.times_real_time, error(row)) for row in rows), strict=True), *mark, **looks)

    for method, (colour, mark) in LOOKS.items():
        rows = [row for row in trade.rows if row.accuracy.method == method]
        if rows:
            plot(rows, mark, color=colour, markersize=4, alpha=0.45, markeredgewidth=0, label=METHODS[method])
    best = front_of(trade.rows, error)
    plot(best, color=BLACK, linewidth=1.4, label="Pareto front")
    for row in best:
        plot([row], LOOKS[row.accuracy.method][1], color=BLACK, markersize=5)
    presets = [row for row in trade.rows if row.accuracy.name in ASKED_FOR]
    looks = {"markerfacecolor": "white", "markeredgecolor": BLACK, "markersize": 7, "linestyle": ""}
    if presets:
        plot(presets, "D", **looks, label="presets and targets")
    white = [withStroke(linewidth=3, foreground="white")]
    for row in presets:
        beside = {"xytext": (-7, 3), "textcoords": "offset points", "ha": "right", "path_effects": white}
        axes.annotate(row.accuracy.name, (row.times_real_time, error(row)), **beside)
    worst = max((getattr(model, quantity) for model in trade.worths if not model.stopped), default=1.0)
    axes.set(xscale="log", yscale="log", xlabel="times real time", ylim=(0.1 * floor, max(3.0, 2.0 * worst)))
    axes.set_xlim(0.2 * min(row.times_real_time for row in trade.rows), None)
    axes.axhspan(0.1 * floor, floor, color=GREY, alpha=0.25, linewidth=0)
    said = {"transform": axes.get_yaxis_transform(), "va": "center", "ha": "right"}
    axes.text(0.98, 0.33 * floor, "as exact as the converged run itself", **said)
    axes.grid(alpha=0.3)
    _draw_worths(axes, trade, quantity, floor)


def _draw_worths(axes: Axes, trade: Trade, quantity: str, floor: float) -> None:
    """A line for the model without each term, with its name at the right. Names that would overlap are moved apart."""
    shown = [model for model in trade.worths if not model.stopped and getattr(model, quantity) > floor]
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
        axes.text(LEADER[1] + 0.01, 10.0**height, f"no {model.name}", transform=across, fontsize="small",
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


def _edge(group: list[Any], gap: float) -> float:
    """Upper edge of a group of labels, or its lower one for a negative gap."""
    return float(group[0] / group[1] + 0.5 * gap * group[1])
