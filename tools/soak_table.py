# SPDX-License-Identifier: Apache-2.0
"""The memory of the nodes over an hour, as `make soak` left it in out/, for docs/appendix/robustness.md."""

import csv
import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LEFT = ROOT / "out" / "soak.csv"  # columns simulation_time_s and NODE_MB, one row a look
PICTURE = ROOT / "docs" / "images" / "soak.png"
BEGIN, END = "<!-- soak: written by `make robustness` from what `make soak` left -->", "<!-- end of soak -->"
EVERY = 10  # min


def soak_table(path: Path = LEFT) -> str:
    """Markdown: the look nearest to each ten minutes, [MB]."""
    with path.open(newline="") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    nodes = [name for name in rows[0] if name.endswith("_MB")]
    minutes = range(0, round(rows[-1]["simulation_time_s"] / 60.0) + 1, EVERY)
    looks = [min(rows, key=lambda row: abs(row["simulation_time_s"] - 60.0 * minute)) for minute in minutes]
    lines = ["| simulation time [min] | " + " | ".join(str(minute) for minute in minutes) + " |"]
    lines.append("|---" * (len(looks) + 1) + "|")
    lines += [f"| `{name[:-3]}` [MB] | " + " | ".join(f"{look[name]:.1f}" for look in looks) + " |" for name in nodes]
    return "\n".join(lines) + "\n"


def with_soak(page: str) -> str:
    """The page's text with the newest table between its marker lines; as it is where no soak was run here."""
    if not LEFT.exists():
        return page
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"docs/appendix/robustness.md must have the lines {BEGIN!r} and {END!r}")
    shutil.copy(LEFT.with_suffix(".png"), PICTURE)
    return f"{before}{BEGIN}\n{soak_table()}{END}{after}"
