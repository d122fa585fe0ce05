# SPDX-License-Identifier: Apache-2.0
"""The memory of the nodes over an hour, as `make soak` left it in out/, for docs/appendix/robustness.md."""

import csv
import shutil
from pathlib import Path

from eel_base.files.markdown import table, with_part

ROOT = Path(__file__).resolve().parent.parent
LEFT = ROOT / "out" / "soak.csv"  # columns simulation_time_s and NODE_MB, one row a look
PICTURE = ROOT / "docs" / "images" / "soak.png"
EVERY = 10  # min


def soak_table(path: Path = LEFT) -> str:
    """Markdown: the look nearest to each ten minutes, [MB]."""
    with path.open(newline="") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    nodes = [name for name in rows[0] if name.endswith("_MB")]
    minutes = range(0, round(rows[-1]["simulation_time_s"] / 60.0) + 1, EVERY)
    looks = [min(rows, key=lambda row: abs(row["simulation_time_s"] - 60.0 * minute)) for minute in minutes]
    head = ["simulation time [min]", *(str(minute) for minute in minutes)]
    return table(head, [[f"`{name[:-3]}` [MB]", *(f"{look[name]:.1f}" for look in looks)] for name in nodes])


def with_soak(page: str) -> str:
    """The page's text with the newest table between its marker lines; as it is where no soak was run here."""
    if not LEFT.exists():
        return page
    shutil.copy(LEFT.with_suffix(".png"), PICTURE)
    return with_part(page, "soak", soak_table())
