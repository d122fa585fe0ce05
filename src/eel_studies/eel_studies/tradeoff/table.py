# SPDX-License-Identifier: Apache-2.0
"""The trade-off as tables."""

from collections.abc import Callable
from operator import attrgetter

from eel_studies.table import Table
from eel_studies.tradeoff.measuring import SECONDS, Measured, Trade, Worth, front_of
from eel_studies.tradeoff.settings import ASKED_FOR

COLUMNS: dict[str, Callable[[Measured], str]] = {  # head: text of a row
    "setting": lambda row: row.accuracy.name,
    "method": lambda row: row.accuracy.method.replace("_", "-"),
    "order": lambda row: str(row.accuracy.order),
    "nodes": lambda row: str(row.run.nodes),
    "mean step [s]": lambda row: f"{row.run.time[-1] / max(1, row.run.steps):.2g}",
    "error of pose": lambda row: f"{row.pose_error:.1e}",
    "error of torque": lambda row: f"{row.torque_error:.1e}",
    "evaluations": lambda row: str(row.run.evaluations),
    "us per evaluation": lambda row: f"{row.microseconds:.2f}",
    "times real time": lambda row: f"{row.times_real_time:.0f}",
    "memory [kB]": lambda row: f"{row.memory / 1000.0:.0f}",
}
LEFT = 0, 1, 2  # columns that are texts
LONG_ONLY = "method", "order", "us per evaluation", "memory [kB]"  # columns that the short table leaves out
WANTED = 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7  # relative errors of the rows of the short table
EXACT_ENOUGH = 0.1  # of a model's error, allowed for the discretisation


def marks_of(trade: Trade) -> dict[int, str]:
    """Marks by the `id` of each row. P: on the front of pose error against time; T: on that of torque error."""
    marks = {id(row): "" for row in trade.rows}
    for letter, error in (("P", attrgetter("pose_error")), ("T", attrgetter("torque_error"))):
        for row in front_of(trade.rows, error):
            marks[id(row)] += letter
    return marks


def listed(trade: Trade, everything: bool = False) -> list[Measured]:
    """The settings of the fronts and the presets, the cheapest first; `everything`: all settings."""
    marks = marks_of(trade)
    rows = [row for row in trade.rows if everything or marks[id(row)] or row.accuracy.name in ASKED_FOR]
    return sorted(rows, key=SECONDS)


def cheapest(trade: Trade) -> list[Measured | None]:
    """For each of the errors `WANTED` the cheapest listed setting whose pose and torque are both as exact, or None."""
    return [next((row for row in listed(trade) if row.error <= wanted), None) for wanted in WANTED]


def digits_table(trade: Trade) -> Table:
    """A row for each of the errors `WANTED`: its `cheapest` setting."""
    columns = {name: text for name, text in COLUMNS.items() if name not in LONG_ONLY}
    rows = [
        [f"{wanted:.0e}", *("-" if row is None else text(row) for text in columns.values())]
        for wanted, row in zip(WANTED, cheapest(trade), strict=True)
    ]
    return Table(("relative error", *columns), rows)


def trade_table(trade: Trade, everything: bool = False) -> Table:
    """A table of the `listed` settings."""
    marks = marks_of(trade)
    rows = [[marks[id(row)] or "-", *(text(row) for text in COLUMNS.values())] for row in listed(trade, everything)]
    return Table(("front", *COLUMNS), rows, LEFT)


def asked_table(trade: Trade) -> Table:
    """A row for each preset and target: what it delivers and costs here."""
    columns = {name: text for name, text in COLUMNS.items() if name not in LONG_ONLY}
    rows = [row for row in trade.rows if row.accuracy.name in ASKED_FOR]
    cells = [[text(row) for text in columns.values()] for row in sorted(rows, key=SECONDS)]
    return Table(("accuracy", *list(columns)[1:]), cells, (0,))


def worth_table(trade: Trade) -> Table:
    """A row for each term of the model: the errors without it, and the cheapest setting that is exact enough for it."""
    head = "left out", "error of pose", "error of torque", "exact enough for it", "times real time"
    rows = []
    for worth in sorted(trade.worths, key=lambda worth: -max(worth.pose_error, worth.torque_error)):
        if worth.stopped:
            rows.append((worth.name, "-", "-", worth.stopped, "-"))
            continue
        setting = exact_enough(worth, trade)
        named = "no difference that a setting resolves" if setting is None else setting.accuracy.name
        speed = "-" if setting is None else f"{setting.times_real_time:.0f}"
        rows.append((worth.name, f"{worth.pose_error:.1e}", f"{worth.torque_error:.1e}", named, speed))
    return Table(head, rows, LEFT)


def exact_enough(worth: Worth, trade: Trade) -> Measured | None:
    """The cheapest setting whose errors are at most a tenth of those without the term, or None."""
    for row in sorted(trade.rows, key=SECONDS):
        if row.pose_error <= EXACT_ENOUGH * worth.pose_error and row.torque_error <= EXACT_ENOUGH * worth.torque_error:
            return row
    return None
