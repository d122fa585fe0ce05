# SPDX-License-Identifier: Apache-2.0
"""Writes docs/appendix/tradeoff.md (six rows, a picture) and tradeoff_tables.md beside it (all that was measured)."""

import math
import os
import platform
from datetime import date
from pathlib import Path

from eel_base.files import markdown

import eel_core
from eel_studies.tradeoff.models import Model
from eel_studies.tradeoff.settings import CHECK, REFERENCE
from eel_studies.tradeoff.table import WANTED, cheapest, digits_table, model_table, trade_table

PAGE = """# Accuracy against cost, and the effect of simpler models

Made by `eel tradeoff {gaits} --pictures {pictures} --page {page}`{machine}.

The {gait} gait, {duration:g} s, on the nodes that the torque needs; the time is without the ledger and without samples,
set-up included. Each row is the cheapest of the measured settings whose errors, of pose and of torque, are both below
the first column. Times carry over to another machine as ratios only.{digit}

{table}

![The trade of the {gait} gait]({picture})

Each point is a setting, on the left with its error of the position, on the right of the torque. The dashed lines are
the errors of simpler models, solved exactly. Where some part of the physics is uncertain, a setting with a tenth of
that part's error is accurate enough. Physics that makes no difference to a gait can be switched off in `Scene(...)`.

A preset or a target (`accuracy="standard"`, `accuracy=1e-4`) chooses settings by a conservative rule, and the
run measures its own error: [accuracy](../explanation/accuracy.md). All settings and
models, for {count} gaits: [{tables}]({tables}).
"""
TABLES = """# Accuracy against cost: all tables

Made by `eel tradeoff {gaits} --pictures {pictures} --page {page}`{machine}. The short of it: [{short}]({short}).

Times are processor times without ledger and samples, medians of {repeats} rounds in which all settings take turns.
Errors are of runs with the same steps on the same nodes, against a run of {points:g} points per body length and a
tolerance of {tolerance:g} per step: of the head's position at the end by its path, and of the torque field (51
stations, 201 instants) by its greatest magnitude.

`P`, `T`: on the Pareto front of pose or torque: no other setting costs less and is more accurate. `adams`: one
evaluation per step, variable steps. `dormand-prince`: the pair of orders 5(4), six evaluations per step, variable
steps. `classical`: the Runge-Kutta method of order 4 with fixed steps. `no kinks`: the
places along the body where cross flow and roll change sign, and the printed friction jumps, are not located.
The second table of each gait shows the simpler models.
"""


def write_page(path: Path, found: list[tuple], pictures: Path) -> Path:
    """Write the page to `path`, and all tables to a page beside it, whose path is returned.

    found: pairs of a trade and its models. pictures: folder of their pictures. `OSError` where a page cannot be
    written.
    """
    first, tables = found[0][0], path.with_name(f"{path.stem}_tables{path.suffix}")
    gaits = " ".join(trade.law.name for trade, _ in found)
    shown = {"gaits": gaits, "pictures": pictures, "page": path, "machine": machine()}
    short = PAGE.format(
        **shown,
        gait=first.law.name,
        duration=first.duration,
        digit=digit_line(first),
        table=digits_table(first, markdown=True),
        picture=os.path.relpath(pictures / f"tradeoff_{first.law.name}.png", path.parent),
        count=len(found),
        tables=tables.name,
    )
    long = TABLES.format(
        **shown,
        short=path.name,
        repeats=first.repeats,
        points=REFERENCE.resolution,
        tolerance=REFERENCE.tolerance,
    )
    for trade, models in found:
        long += f"\n## {trade.law.name}, {trade.duration:g} s\n\n{reference_line(trade)}\n\n"
        long += trade_table(trade, markdown=True) + "\n\n"
        long += model_table(models, trade, markdown=True) + "\n"
    markdown.write_page(path, short)
    markdown.write_page(tables, long)
    return tables


def digit_line(trade) -> str:
    """What one more digit costs in the mean of the short table, in words; empty where it has fewer than two rows."""
    rows = [row for row in cheapest(trade) if row is not None]
    if len(rows) < 2:
        return ""
    digits = math.log10(WANTED[0] / WANTED[len(rows) - 1])
    factor = (rows[0].times_real_time / rows[-1].times_real_time) ** (1.0 / digits)
    return f" One more digit takes {factor:.1f} times as long, in the mean."


def reference_line(trade) -> str:
    """The convergence of the reference run, in words."""
    pose, torque = trade.reference_error
    unstable = f" {len(trade.unstable)} settings diverged." if trade.unstable else ""
    check = f"{CHECK.resolution:g} points and {CHECK.tolerance:g}"
    return (
        f"The reference differs from a run of {check} by {pose:.0e} in pose and {torque:.0e} in torque; smaller errors "
        f"are not told apart.{unstable}"
    )


def machine() -> str:
    """Processor, date and instruction set of the measurement, in words."""
    processor = platform.processor() or platform.machine()
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        processor = next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    return f" on one core ({processor}), {date.today()}, the mechanics compiled for {eel_core.build_info()['level']}"


__all__ = ["Model", "reference_line", "write_page"]
