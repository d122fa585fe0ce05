# SPDX-License-Identifier: Apache-2.0
"""The trade-off as tables, lines and a picture, and the text of docs/appendix/tradeoff.md.

In the picture methods differ in colour (Okabe and Ito) and in mark, so that a print without colour distinguishes them.
"""

import math
import platform
import re
from collections.abc import Callable, Iterable
from datetime import date
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
from eel_dynamics.accuracy.accuracy import PRESETS

import eel_core
from eel_studies.outputs import Table
from eel_studies.pictures import BLACK, BLUE, GREEN, GREY, ORANGE, Axes, Figure, spread
from eel_studies.tradeoff.measuring import METHODS, REACHED, SECONDS, Measured, Trade

COLUMNS: dict[str, Callable[[Measured], str]] = {  # head: text of a row
    "setting": lambda row: row.accuracy.name,
    "nodes": lambda row: str(row.run.nodes),
    "mean step [s]": lambda row: f"{row.run.time[-1] / max(1, row.run.steps):.2g}",
    "error of position": lambda row: f"{row.position:.1e}",
    "error of torque": lambda row: f"{row.torque:.1e}",
    "evaluations": lambda row: str(row.run.evaluations),
    "times real time": lambda row: _speed(row),
}
WANTED = 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7  # relative errors of the rows of the short table
PARTS = "digits", "picture", "scenes"  # of the page
LOOKS = {"adams": (BLUE, "o"), "dormand_prince": (GREEN, "s"), "classical": (ORANGE, "^")}
SIZE = 11.0, 5.4  # inches
FLOOR = 3.0  # times the reference's own error: smaller differences are not significant
CLOSE, CLOSER = 0.044, 0.031  # of a panel's height: least distance of two names of settings, and of terms
TERMS_AT, LINES_FROM = 0.41, 0.46  # of a panel's width: end of the names of terms, and begin of their lines


def trade_table(trade: Trade, everything: bool = False) -> Table:
    """The settings on the front, marked, and presets and targets, cheapest first. everything: all settings."""
    front = {id(row) for row in trade.front()}
    shown = trade.rows if everything else [row for row in trade.rows if id(row) in front or row in trade.asked]
    cells = [["*" if id(row) in front else "", *_cells(row)] for row in sorted(shown, key=SECONDS)]
    return Table(("front", *COLUMNS), cells, (0, 1))


def cheapest(trade: Trade) -> list[Measured | None]:
    """For each of the errors `WANTED`, the cheapest setting with that error in both position and torque, or None."""
    rows = sorted(trade.rows, key=SECONDS)
    return [next((row for row in rows if row.error <= wanted), None) for wanted in WANTED]


def digits_table(trade: Trade) -> Table:
    """A row for each of the errors `WANTED`: its `cheapest` setting."""
    rows = [
        [f"{wanted:.0e}", *(["-"] * len(COLUMNS) if row is None else _cells(row))]
        for wanted, row in zip(WANTED, cheapest(trade), strict=True)
    ]
    return Table(("relative error", *COLUMNS), rows)


def scenes_table(found: list[Trade]) -> Table:
    """A row for each scene: error of its reference, errors of the presets, and times real time."""
    rows = []
    for trade in found:
        asked = {row.accuracy.name: row for row in trade.asked}
        cells = [asked.get(name) for name in PRESETS]
        texts = ("diverges" if row is None else f"{row.error:.0e} at {_speed(row)}" for row in cells)
        rows.append((f"{trade.name}, {trade.duration:g} s", f"{trade.reference_error:.0e}", *texts))
    return Table(("scene", "reference", *PRESETS), rows)


def reference_line(trade: Trade) -> str:
    """The accuracy of the reference, in words."""
    unstable = f" {len(trade.unstable)} settings diverged." if trade.unstable else ""
    poor = "" if trade.reference_error <= REACHED else f", where {REACHED:g} is wanted"
    return (
        f"Two methods on two grids agree to {trade.reference_error:.0e}{poor}; smaller errors are not told apart."
        f"{unstable}"
    )


def pace_line(trade: Trade, pace: float) -> str:
    """The most exact setting within `pace` [s] per simulated second, in words. `ValueError` if none is as fast."""
    best, asked = trade.within(pace)
    also = "no preset or target is as fast" if asked is None else f"{asked.accuracy.name} delivers {asked.error:.1e}"
    return f"within {1e3 * pace:g} ms per second: {best.accuracy.name} delivers {best.error:.1e}; {also}."


def parts_of_page(found: list[Trade], pictures: list[str]) -> tuple[dict[str, str], dict[str, str]]:
    """Parts and values of the page from the trades `found` and the links of their `pictures`."""
    first, scenes = found[0], "\n\n".join((scenes_table(found).markdown(), *pictures[1:]))
    values = {"machine": machine(), "gait": first.name, "duration": f"{first.duration:g}", "digit": digit_line(first)}
    return dict(zip(PARTS, (digits_table(first).markdown(), pictures[0], scenes), strict=True)), values


def digit_line(trade: Trade) -> str:
    """The mean cost of one more digit in the short table, in words; empty for fewer than two rows."""
    rows = [row for row in cheapest(trade) if row is not None]
    if len(rows) < 2:
        return ""
    digits = math.log10(WANTED[0] / WANTED[len(rows) - 1])
    factor = (rows[0].times_real_time / rows[-1].times_real_time) ** (1.0 / digits)
    return f"One more digit takes {factor:.1f} times as long, in the mean."


def machine() -> str:
    """Processor, date and instruction set of the measurement, in words."""
    processor = platform.processor() or platform.machine()
    if (about := Path("/proc/cpuinfo")).exists() and (named := re.search(r"model name\s*: (.*)", about.read_text())):
        processor = named[1].strip()
    return f"one core ({processor}), {date.today()}, the mechanics compiled for {eel_core.build_info()['level']}"


def _speed(row: Measured) -> str:
    """Times real time, to three digits or a whole number."""
    return f"{row.times_real_time:.{0 if row.times_real_time > 100.0 else 1}f}"


def _cells(row: Measured) -> list[str]:
    return [text(row) for text in COLUMNS.values()]


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
    terms = {name: error(errors) for name, errors in trade.terms.items() if error(errors) > floor}
    low, high = 0.1 * floor, max(3.0, 2.0 * max(terms.values(), default=1.0))
    axes.set(xscale="log", yscale="log", xlabel="times real time", ylim=(low, high))
    axes.set_xlim(0.2 * min(map(attrgetter("times_real_time"), trade.rows)), None)
    axes.axhspan(low, floor, color=GREY, alpha=0.25, linewidth=0)
    across = axes.get_yaxis_transform()
    axes.text(0.98, 0.33 * floor, "as exact as the converged run itself", ha="right", va="center", transform=across)
    gap, closer = CLOSE * np.log10(high / low), CLOSER * np.log10(high / low)
    beside = {"path_effects": [withStroke(linewidth=3, foreground="white")], "ha": "right", "va": "center"}
    leader = {"arrowstyle": "-", "color": GREY, "linewidth": 0.6, "shrinkA": 1.0, "shrinkB": 3.0, "relpos": (1.0, 0.5)}
    heights = 10.0 ** spread(np.log10([error(row) for row in trade.asked]), gap, np.log10(floor) + 0.5 * gap)
    for row, height in zip(trade.asked, heights, strict=True):
        point, place = (row.times_real_time, error(row)), (0.86 * row.times_real_time, height)
        axes.annotate(row.accuracy.name, point, place, arrowprops=leader, **beside)
    heights = 10.0 ** -spread(-np.log10([*terms.values()]), closer, 0.5 * closer - np.log10(high))
    for (name, value), height in zip(terms.items(), heights, strict=True):
        axes.plot([LINES_FROM, 1.0], [value] * 2, zorder=0, color=GREY, linewidth=0.8, dashes=(5, 3), transform=across)
        words = {"xycoords": across, "fontsize": "x-small", "color": GREY, "arrowprops": leader | {"shrinkB": 0.0}}
        axes.annotate(f"without {name}", (LINES_FROM, value), (TERMS_AT, height), **words, **beside)
