# SPDX-License-Identifier: Apache-2.0
"""The trade-off as text: aligned for a terminal, or as Markdown tables."""

import csv
from operator import attrgetter
from pathlib import Path

from eel_base.files.markdown import table
from eel_base.files.output_file import replacing
from eel_dynamics.accuracy.accuracy import PRESETS

from eel_studies.tradeoff.measuring import Measured, Trade, front
from eel_studies.tradeoff.models import Model

HEAD = (
    "front",
    "setting",
    "method",
    "order",
    "nodes",
    "mean step [s]",
    "error of pose",
    "error of torque",
    "evaluations",
    "us per evaluation",
    "times real time",
    "memory [kB]",
)
SHORT = (1, 4, 5, 6, 7, 8, 10)  # columns of `HEAD` that the short table has
WANTED = 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7  # relative errors of its rows
SECONDS = attrgetter("seconds")  # of a row: its cost
EXACT_ENOUGH = 0.1  # of a model's error, allowed for the discretisation


def marks_of(trade: Trade) -> dict[int, str]:
    """Marks by the `id` of each row. P: on the front of pose error against time; T: on that of torque error."""
    marks = {id(row): "" for row in trade.rows}
    for letter, error in (("P", attrgetter("pose_error")), ("T", attrgetter("torque_error"))):
        for row in front(trade.rows, error, SECONDS):
            marks[id(row)] += letter
    return marks


def cells_of(row: Measured, mark: str) -> list[str]:
    """The cells of a row, in the order of `HEAD`."""
    return [
        mark or "-",
        row.accuracy.name,
        row.accuracy.method.replace("_", "-"),
        str(row.accuracy.order),
        str(row.nodes),
        f"{row.step:.2g}",
        f"{row.pose_error:.1e}",
        f"{row.torque_error:.1e}",
        str(row.evaluations),
        f"{row.microseconds:.2f}",
        f"{row.times_real_time:.0f}",
        f"{row.memory / 1000.0:.0f}",
    ]


def listed(trade: Trade, everything: bool = False) -> list[Measured]:
    """The settings of the fronts and the presets, the cheapest first; `everything`: all settings."""
    marks = marks_of(trade)
    rows = [row for row in trade.rows if everything or marks[id(row)] or row.accuracy.name in PRESETS]
    return sorted(rows, key=SECONDS)


def cheapest(trade: Trade) -> list[Measured | None]:
    """For each of the errors `WANTED` the cheapest listed setting whose pose and torque are both as exact, or None."""
    rows = listed(trade)
    return [next((row for row in rows if max(row.pose_error, row.torque_error) <= wanted), None) for wanted in WANTED]


def digits_table(trade: Trade, *, markdown: bool = False) -> str:
    """A row for each of the errors `WANTED`: its `cheapest` setting."""
    head = "relative error", *(HEAD[place] for place in SHORT)
    rows = []
    for wanted, row in zip(WANTED, cheapest(trade), strict=True):
        cells = ["-"] * len(HEAD) if row is None else cells_of(row, "")
        rows.append([f"{wanted:.0e}", *(cells[place] for place in SHORT)])
    return laid_out(head, rows, markdown)


def trade_table(trade: Trade, *, everything: bool = False, markdown: bool = False) -> str:
    """A table of the `listed` settings."""
    marks, rows = marks_of(trade), listed(trade, everything)
    return laid_out(HEAD, [cells_of(row, marks[id(row)]) for row in rows], markdown)


def model_table(models: list[Model], trade: Trade, *, markdown: bool = False) -> str:
    """A table of each simpler model's errors, and the cheapest setting whose own errors are a tenth of them or less."""
    head = "left out, or otherwise", "error of pose", "error of torque", "exact enough for it", "times real time"
    rows = []
    for model in sorted(models, key=lambda model: -max(model.pose_error, model.torque_error)):
        if model.run is None:
            rows.append([model.name, "-", "-", model.stopped, "-"])
            continue
        setting, speed = exact_enough(model, trade)
        rows.append([model.name, f"{model.pose_error:.1e}", f"{model.torque_error:.1e}", setting, speed])
    return laid_out(head, rows, markdown)


def exact_enough(model: Model, trade: Trade) -> tuple[str, str]:
    """Name and speed of the cheapest setting with at most a tenth of the model's errors, in times real time."""
    for row in sorted(trade.rows, key=SECONDS):
        if row.pose_error <= EXACT_ENOUGH * model.pose_error and row.torque_error <= EXACT_ENOUGH * model.torque_error:
            return row.accuracy.name, f"{row.times_real_time:.0f}"
    return "no difference that a setting resolves", "-"


def write_csv(trade: Trade, path: Path):
    """Write all measurements to `path`, one line per setting. `OSError` where the file cannot be written."""
    marks = marks_of(trade)
    with replacing(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(HEAD)
        writer.writerows(cells_of(row, marks[id(row)]) for row in sorted(trade.rows, key=SECONDS))


def laid_out(head, rows, markdown: bool) -> str:
    """A table as aligned text, or in Markdown."""
    if markdown:
        return table(head, rows)
    widths = [max(len(cell) for cell in column) for column in zip(head, *rows, strict=True)]
    return "\n".join(
        "  ".join(
            cell.ljust(width) if place < 3 else cell.rjust(width)
            for place, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in (head, *rows)
    )
