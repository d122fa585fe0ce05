# SPDX-License-Identifier: Apache-2.0
"""The trade-off as tables and lines, and what docs/appendix/tradeoff.md tells."""

import math
import platform
import re
from collections.abc import Callable
from datetime import date
from pathlib import Path

from eel_dynamics.accuracy.accuracy import PRESETS
from eel_dynamics.accuracy.budget import Budget

import eel_core
from eel_studies.outputs import Table
from eel_studies.tradeoff.measuring import REACHED, SECONDS, Measured, Trade

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


def trade_table(trade: Trade, everything: bool = False) -> Table:
    """The settings on the front, marked, and presets and targets, the cheapest first; `everything`: all settings."""
    front = {id(row) for row in trade.front()}
    shown = trade.rows if everything else [row for row in trade.rows if id(row) in front or row in trade.asked]
    cells = [["*" if id(row) in front else "", *_cells(row)] for row in sorted(shown, key=SECONDS)]
    return Table(("front", *COLUMNS), cells, (0, 1))


def cheapest(trade: Trade) -> list[Measured | None]:
    """For each of the errors `WANTED` the cheapest setting whose position and torque are both as exact, or None."""
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
    """A row for each scene: how well its reference is known, what presets deliver, and times real time."""
    rows = []
    for trade in found:
        asked = {row.accuracy.name: row for row in trade.asked}
        cells = [asked.get(name) for name in PRESETS]
        texts = ("diverges" if row is None else f"{row.error:.0e} at {_speed(row)}" for row in cells)
        rows.append((f"{trade.name}, {trade.duration:g} s", f"{trade.reference_error:.0e}", *texts))
    return Table(("scene", "reference", *PRESETS), rows)


def reference_line(trade: Trade) -> str:
    """How well the reference is known, in words."""
    unstable = f" {len(trade.unstable)} settings diverged." if trade.unstable else ""
    poor = "" if trade.reference_error <= REACHED else f", where {REACHED:g} is wanted"
    return (
        f"Two methods on two grids agree to {trade.reference_error:.0e}{poor}; smaller errors are not told apart."
        f"{unstable}"
    )


def budget_line(trade: Trade, budget: Budget) -> str:
    """What is fastest within the `budget`, in words. `ValueError` where nothing is as fast."""
    best, asked = trade.within(budget)
    also = "no preset or target is as fast" if asked is None else f"{asked.accuracy.name} delivers {asked.error:.1e}"
    return f"{budget.name}: {best.accuracy.name} delivers {best.error:.1e}; {also}."


def parts_of_page(found: list[Trade], pictures: list[str]) -> tuple[dict[str, str], dict[str, str]]:
    """Parts and values of the page of the trades `found` and their `pictures`, as the page links them."""
    first, scenes = found[0], "\n\n".join((scenes_table(found).markdown(), *pictures[1:]))
    values = {"machine": machine(), "gait": first.name, "duration": f"{first.duration:g}", "digit": digit_line(first)}
    return dict(zip(PARTS, (digits_table(first).markdown(), pictures[0], scenes), strict=True)), values


def digit_line(trade: Trade) -> str:
    """What one more digit costs in the mean of the short table, in words; empty where it has fewer than two rows."""
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
