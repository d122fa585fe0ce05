# SPDX-License-Identifier: Apache-2.0
"""The figures of benchmarks/reports: what `make bench` printed, read back by label."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REPORTS = ROOT / "benchmarks" / "reports"


class Report:
    """The newest report that has a figure: its lines, by label."""

    def __init__(self, figure: str):
        self.figure, self.command = figure, f"make bench ARGS={figure}"
        for self.path in sorted(REPORTS.glob("*.md"), reverse=True):
            found = re.search(rf"^{figure}: .*\n((?:  .*\n)+)", self.path.read_text(encoding="utf-8"), re.MULTILINE)
            if found:
                self.lines = [line.strip() for line in found[1].splitlines()]
                return
        raise ValueError(f"no report in {REPORTS.relative_to(ROOT)} has the figure {figure}: {self.command}")

    def rest(self, label: str) -> str:
        """What stands behind a label: value and unit."""
        for line in self.lines:
            if re.match(rf"{re.escape(label)}\s{{2,}}", line):
                return line.removeprefix(label).strip()
        raise ValueError(f"{self.path.name} has no line {label!r} under {self.figure}: {self.command}")

    def value(self, label: str) -> float:
        """The number behind a label."""
        return float(self.rest(label).split()[0])

    def ratios(self, case: str) -> list[float]:
        """How many times cheaper we are in the cases whose heading matches, and in the sizes listed under it."""
        found, inside = [], False
        for line in self.lines:
            if re.match(r"\d|with |motion alone$|[A-Z]", line):
                size = line[0].isdigit() and not re.match(r"\d+ (links|elements)", line)  # of the case above it
                inside = bool(re.match(case, line)) or (inside and size)
            elif inside and (ratio := re.match(r"ours is cheaper +(\S+) times", line)):
                found.append(float(ratio[1]))
        if not found:
            raise ValueError(f"{self.path.name} has no case {case!r} under {self.figure}: {self.command}")
        return found
