# SPDX-License-Identifier: Apache-2.0
"""The trade-off as a picture: error against times real time, the Pareto fronts, and the errors without a term.

Methods differ in colour (Okabe and Ito) and in mark, so that they can be told apart in print without colour.
"""

from collections.abc import Iterable
from operator import attrgetter
from typing import Any

import numpy as np

from eel_studies.pictures import BLACK, BLUE, GREEN, GREY, ORANGE, Axes, Figure
from eel_studies.tradeoff.measuring import METHODS, Measured, Trade

LOOKS = {"adams": (BLUE, "o"), "dormand_prince": (GREEN, "s"), "classical": (ORANGE, "^")}
SIZE = 11.0, 5.4  # inches
FLOOR = 3.0  # times the reference's own error: differences below it are not significant
CLOSE = 0.04  # of a panel's height: names of terms that are so close share a line


def draw_trade(figure: Figure, trade: Trade) -> None:
    """Draw the trade-off into an empty matplotlib figure: error of position on the left, of torque on the right."""
    figure.suptitle(f"{trade.name}, {trade.duration:g} s: what exactness costs, and what a poorer model is off by")
    panels = figure.subplots(1, 2, sharex=True)
    for axes, quantity in zip(panels, ("position", "torque"), strict=True):
        _draw_panel(axes, trade, quantity, FLOOR * trade.reference_error)
    panels[0].set_ylabel("error of the head's position, by its path")
    panels[1].set_ylabel("error of the torque along the body, by its greatest")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))


def _draw_panel(axes: Axes, trade: Trade, quantity: str, floor: float) -> None:
    from matplotlib.patheffects import withStroke

    def error(row: Any) -> float:
        return float(max(getattr(row, quantity) or 0.0, floor))

    def plot(rows: Iterable[Measured], *mark: str, **looks: Any) -> None:
        axes.plot(*zip(*((row.times_real_time, error(row)) for row in rows), strict=True), *mark, **looks)

    own = "" if trade.swim.robot is None else " of robots"
    for method, (colour, mark) in LOOKS.items():
        rows = [row for row in trade.rows if row.accuracy.method == method]
        if rows:
            plot(rows, mark, color=colour, markersize=4, alpha=0.45, markeredgewidth=0, label=METHODS[method + own])
    plot(best := trade.front(error), color=BLACK, linewidth=1.4, label="Pareto front")
    for row in best:
        plot([row], LOOKS[row.accuracy.method][1], color=BLACK, markersize=5)
    if trade.asked:
        looks = {"markerfacecolor": "white", "markeredgecolor": BLACK, "markersize": 7, "linestyle": ""}
        plot(trade.asked, "D", **looks, label="presets and targets")
    white = {"path_effects": [withStroke(linewidth=3, foreground="white")]}
    for row in trade.asked:
        beside = {"xytext": (-7, 3), "textcoords": "offset points", "ha": "right", **white}
        axes.annotate(row.accuracy.name, (row.times_real_time, error(row)), **beside)
    terms = {name: error(errors) for name, errors in trade.terms.items() if error(errors) > floor}
    low, high = 0.1 * floor, max(3.0, 2.0 * max(terms.values(), default=1.0))
    axes.set(xscale="log", yscale="log", xlabel="times real time", ylim=(low, high))
    axes.set_xlim(0.2 * min(map(attrgetter("times_real_time"), trade.rows)), None)
    axes.axhspan(low, floor, color=GREY, alpha=0.25, linewidth=0)
    across = {"transform": axes.get_yaxis_transform(), "va": "center"}
    axes.text(0.98, 0.33 * floor, "as exact as the converged run itself", ha="right", **across)
    for value in terms.values():
        axes.axhline(value, zorder=0, color=GREY, linewidth=0.8, linestyle=(0, (5, 3)))
    for value, names in _grouped(terms, CLOSE * np.log10(high / low)):
        axes.text(0.01, value, "without " + ", ".join(names), fontsize="x-small", color=GREY, **across, **white)


def _grouped(terms: dict[str, float], gap: float) -> list[tuple[float, list[str]]]:
    """Names of terms whose errors lie within `gap` decades of the first one's, at that error, the least first."""
    groups: list[tuple[float, list[str]]] = []
    for name, value in sorted(terms.items(), key=lambda item: item[1]):
        if groups and np.log10(value / groups[-1][0]) < gap:
            groups[-1][1].append(name)
        else:
            groups.append((value, [name]))
    return groups
