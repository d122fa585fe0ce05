# SPDX-License-Identifier: Apache-2.0
"""The list of faults in out/robustness.md, written from the tests: `make robustness`.

A test that shows what happens at a fault says so by a decorator, once for each fault that it shows:

    @pytest.mark.fault("laws", "a law with NaN or infinity", "refused with one error that names the field")

What `make soak` has left goes into docs/appendix/robustness.md: the memory of the nodes over an hour.
"""

import ast
import csv
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

from eel_base.files import markdown

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "appendix" / "robustness.md"
LIST = ROOT / "out" / "robustness.md"
SOAK = ROOT / "out" / "soak.csv"  # columns simulation_time_s and NODE_MB, one row a look
SOAK_EVERY = 10  # min
GROUPS = {  # key in the decorator: heading, as the page begins its row, in its order
    "laws": "Laws",
    "samples": "Curvature samples",
    "nodes": "Nodes",
    "time": "Time and resets",
    "subscribers": "Subscribers and viewers",
    "load": "Overload",
    "ending": "Signals, kills and full disks",
    "neighbours": "Neighbours on the network",
    "names": "Names, paths and files",
    "parameters": "Parameters and services",
}


@dataclass(frozen=True)
class Fault:
    """One row: what goes wrong, what happens then, and the test that shows it."""

    group: str
    fault: str
    outcome: str
    test: str  # file::function, from the root


def faults_of(path: Path) -> list[Fault]:
    """The rows that one test file declares, in its order. ValueError for a decorator that is not three texts."""
    found, text = [], path.read_text()
    if "mark.fault(" not in text:
        return []
    for function in ast.walk(ast.parse(text)):
        if not isinstance(function, ast.FunctionDef):
            continue
        for decorator in function.decorator_list:
            if not (isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "pytest.mark.fault"):
                continue
            place = f"{path.relative_to(ROOT)}::{function.name}"
            texts = [ast.literal_eval(argument) for argument in decorator.args]
            if len(texts) != 3 or texts[0] not in GROUPS:
                raise ValueError(f"{place}: fault must have a group of {', '.join(GROUPS)}, a fault and an outcome")
            group, fault, outcome = texts
            found.append(Fault(group, fault, outcome, place))
    return found


def faults() -> list[Fault]:
    """All rows: by group, and in each by test file and place in it."""
    files = [*sorted(ROOT.glob("src/*/test/test_*.py")), *sorted(ROOT.glob("test/test_*.py"))]
    rows = [row for path in files for row in faults_of(path)]
    return sorted(rows, key=lambda row: list(GROUPS).index(row.group))


def table() -> str:
    """The rows as Markdown, a table for each group."""
    lines = []
    for group, heading in GROUPS.items():
        rows = [row for row in faults() if row.group == group]
        if rows:
            cells = [(row.fault, row.outcome, f"`{row.test}`") for row in rows]
            lines += [f"## {heading}", markdown.table(("fault", "what happens", "test"), cells), ""]
    return "\n".join(lines).rstrip()


def soak_table(path: Path = SOAK) -> str:
    """Markdown: the look nearest to each ten minutes, [MB]."""
    with path.open(newline="") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    nodes = [name for name in rows[0] if name.endswith("_MB")]
    minutes = range(0, round(rows[-1]["simulation_time_s"] / 60.0) + 1, SOAK_EVERY)
    looks = [min(rows, key=lambda row: abs(row["simulation_time_s"] - 60.0 * minute)) for minute in minutes]
    head = ["simulation time [min]", *(str(minute) for minute in minutes)]
    return markdown.table(head, [[f"`{name[:-3]}` [MB]", *(f"{look[name]:.1f}" for look in looks)] for name in nodes])


def with_soak(page: str) -> str:
    """The page's text with the newest table between its marker lines; as it is where no soak was run here."""
    if not SOAK.exists():
        return page
    shutil.copy(SOAK.with_suffix(".png"), ROOT / "docs" / "images" / "soak.png")
    return markdown.with_part(page, "soak", soak_table())


def main() -> int:
    LIST.parent.mkdir(exist_ok=True)
    LIST.write_text(f"# Faults, and what happens\n\n{table()}\n", encoding="utf-8")
    PAGE.write_text(with_soak(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"{LIST.relative_to(ROOT)}: {len(faults())} faults")
    return 0


if __name__ == "__main__":
    sys.exit(main())
