# SPDX-License-Identifier: Apache-2.0
"""The list of faults in out/robustness.md, written from the tests: `make robustness`.

A test that shows what happens at a fault says so by a decorator, once for each fault that it shows:

    @pytest.mark.fault("laws", "a law with NaN or infinity", "refused with one error that names the field")

The picture that `make soak` has left, the memory of the nodes over an hour, goes into docs/images.
"""

import ast
import shutil
import sys
from pathlib import Path
from typing import NamedTuple

from eel_common.files import markdown

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "appendix" / "robustness.md"
LIST = ROOT / "out" / "robustness.md"
SOAK = ROOT / "out" / "soak.png"  # memory of the nodes over an hour
GROUPS = {  # key in the decorator: heading, as the page begins its line, in its order
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


class Fault(NamedTuple):
    """One row: what goes wrong, what happens then, and the test that shows it."""

    group: str
    fault: str
    outcome: str
    test: str  # file::function, from the root


def faults_of(path: Path) -> list[Fault]:
    """The rows that one test file declares, in its order. ValueError for a decorator that is not three texts."""
    found, text = [], path.read_text()
    functions = ast.walk(ast.parse(text)) if "mark.fault(" in text else ()
    for function in (each for each in functions if isinstance(each, ast.FunctionDef)):
        for decorator in function.decorator_list:
            if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "pytest.mark.fault":
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


def main() -> int:
    rows, lines = faults(), ["# Faults, and what happens", ""]
    for group, heading in GROUPS.items():
        cells = [(row.fault, row.outcome, f"`{row.test}`") for row in rows if row.group == group]
        lines += [f"## {heading}", markdown.table(("fault", "what happens", "test"), cells), ""] if cells else []
    LIST.parent.mkdir(exist_ok=True)
    LIST.write_text("\n".join(lines), encoding="utf-8")
    if SOAK.exists():
        shutil.copy(SOAK, ROOT / "docs" / "images" / "soak.png")
    print(f"{LIST.relative_to(ROOT)}: {len(rows)} faults")
    return 0


if __name__ == "__main__":
    sys.exit(main())
