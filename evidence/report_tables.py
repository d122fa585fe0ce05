# SPDX-License-Identifier: Apache-2.0
"""`python evidence/report_tables.py`: write the tables of README.md and docs that come from reports.

They stand between two marker lines and come from the newest report in benchmarks/reports that has them (the output of
`make bench`), or from docs/appendix/validation.csv (`make validation`).
"""

import csv
import re
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from eel_common.files.markdown import table, with_part
from others.speed_chart import TITLE, speed_chart

ROOT = Path(__file__).resolve().parent.parent
REPORTS = ROOT / "benchmarks" / "reports"
OF_OTHERS = "peers", "paper_scheme"  # figures of evidence/comparisons.py
VALIDATION = ROOT / "docs" / "appendix" / "validation.csv"
LIFE = ROOT / "docs" / "explanation" / "life.md"


class Report:
    """The newest report that has a figure: its lines, by label."""

    def __init__(self, figure: str):
        self.figure, self.command = figure, f"make bench ARGS={figure}"
        if figure in OF_OTHERS:
            self.command = f"python evidence/comparisons.py {figure}"
        for self.path in sorted(REPORTS.glob("*.txt"), reverse=True):
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

    def ratios(self, case: str) -> tuple[float, float]:
        """The least and the greatest number of times that we are cheaper.

        Of the cases whose heading matches, and of the sizes listed under it.
        """
        found, inside = [], False
        for line in self.lines:
            if re.match(r"\d|with |motion alone$|[A-Z]", line):
                size = line[0].isdigit() and not re.match(r"\d+ (links|elements)", line)  # of the case above it
                inside = bool(re.match(case, line)) or (inside and size)
            elif inside and (ratio := re.match(r"ours is cheaper +(\S+) times", line)):
                found.append(float(ratio[1]))
        if not found:
            raise ValueError(f"{self.path.name} has no case {case!r} under {self.figure}: {self.command}")
        return min(found), max(found)


def link(report: Report, folder: str = "") -> str:
    """Markdown, from a page that lies so deep."""
    return f"[{report.path.stem}]({folder}benchmarks/reports/{report.path.name})"


TARGETS = {"0.01": "1e-2 (`draft`)", "0.001": "1e-3", "0.0001": "1e-4 (`standard`)", "1e-06": "1e-6 (`fine`)"}
AGAIN = ", on a busy machine, to be measured again"  # where a report says so
MOTION, ALL = "motion alone", "ledger, wrench, 201 samples"


CHART = ROOT / "docs" / "images" / "speed.svg"


def others() -> dict[str, tuple[float, float]]:
    """Least and greatest number of times that other programs take longer for the falling gait, by program."""
    peers = Report("peers")
    return {
        "the paper's own scheme": Report("paper_scheme").ratios("motion alone"),
        "MuJoCo, joints prescribed": peers.ratios("[0-9]+ links, joints prescribed"),
        "MuJoCo, servos": peers.ratios("10 links, step"),
        "PyElastica": peers.ratios("[0-9]+ elements"),
    }


def bars(folder: str) -> str:
    """README and the landing page: the chart, and what it says in words."""
    told = ", ".join(f"{name} {least:,.0f} to {most:,.0f}" for name, (least, most) in others().items())
    return f"![{TITLE}: this simulator 1, {told}]({folder}images/speed.svg)"


def speed() -> str:
    """docs/explanation/accuracy.md: error against cost of the falling gait."""
    falling, peers = Report("falling"), Report("peers")
    rows = []
    for target, label in TARGETS.items():
        cells = [label]
        for case in (MOTION, ALL):
            figures = falling.rest(f"{case}, target {target}")
            pace, error = re.findall(r"(\S+) times real time, error (\S+),", figures)[0]
            cells.append(f"{float(f'{float(pace):.2g}'):,.0f} ({error})")
        rows.append(cells)

    cases = [f"with the error estimate, {case}, target {target}" for case in (MOTION, ALL) for target in TARGETS]
    longer = [falling.value(case) for case in cases]
    again = AGAIN if "to be measured again" in peers.path.read_text(encoding="utf-8") else ""
    return f"""{table(("target", MOTION, ALL), rows)}

Times real time (error of the head's position, by its path). A run that measures its own error, as
`simulate` does, takes {min(longer):.1f} to {max(longer):.1f} times as long.
From {link(falling, "../../")}; other programs: {link(peers, "../../")}{again}."""


ACTUATORS, OF_PATH = " of the actuators' work", " of the path"
CHECKS = {  # what the page says: the lines of validation.csv whose worst it is, and what it is relative to
    "accelerations, wrench, loads against a second code; no drag": (
        r"(head's acceleration|internal torque and force|shape in space).* without drag",
        "",
    ),
    "head's path over 10 s against that code, laminar friction": (".*laminar friction, accuracy reference.*", OF_PATH),
    "closure of the internal wrench at the nose": ("(torque|force) left over at the nose, any swimmer", ""),
    "energy ledger, falling gait, accuracy standard": ("residual that the live node publishes.*", ACTUATORS),
    "energy ledger, the worst of eight scenes": ("residual, .* accuracy standard.*", ACTUATORS),
    "Lighthill's eq. (1) in the plane": ("rate of the water's momentum.*|flux and pressure.*|resultant.*", ""),
    "Munk's moment, coasting, Euler's top in closed form": ("Munk's moment.*|coasting.*|Euler's top.*", ""),
}
MASS = "mass of the paper's robot"


def checks() -> str:
    """docs/explanation/trust.md: what the checks of the mechanics measure, the worst of each kind."""
    with VALIDATION.open(newline="", encoding="utf-8") as file:
        measured = {row["compared"]: row["measured"] for row in csv.DictReader(file)}
    rows = []
    for check, (pattern, scale) in CHECKS.items():
        found = [float(value.split()[0]) for what, value in measured.items() if re.fullmatch(pattern, what)]
        if not found:
            raise ValueError(f"docs/appendix/validation.csv has no line like {pattern!r}: make validation")
        rows.append((check, f"{max(found):.1e}{scale}"))
    return table(("check", "difference"), [*rows, (f"{MASS} (printed: 1.94 kg)", measured[MASS])])


QUOTED_OF_LIFE = (  # rows that agree, and the one that agrees least
    ("lamprey", "Strouhal number"),
    ("lamprey", "speed [m/s]"),
    ("AmphiBot III", "speed [m/s]"),
    ("Mamba, eel-like", "speed [m/s]"),
    ("tendon fish", "speed, film of 0.50 Hz [m/s]"),
)


def life() -> str:
    """README: measured swimmers, the some rows of docs/explanation/life.md, and the worst."""
    lines = LIFE.read_text(encoding="utf-8").splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    rows = []
    for quoted in QUOTED_OF_LIFE:
        found = [row for row in cells if tuple(row[:2]) == quoted]
        if len(found) != 1:
            raise ValueError(f"docs/explanation/life.md must have one row {quoted}, it has {len(found)}")
        swimmer, what, measured, ours, *_, words = found[0]
        rows.append((f"{swimmer}: {what}", measured, ours, words))
    return table(("measured swimmer", "measured", "ours", "in plain words"), rows)


METHODS = r"method|Runge-Kutta 4, .*|adaptive: (adams [345]|dormand.*)"  # of the report, those that the page shows


def integrators() -> str:
    """docs/explanation/integrators.md: evaluations by method and target."""
    report = Report("integrators")
    head, *rows = [cells for line in report.lines if re.fullmatch(METHODS, (cells := re.split(r" {2,}", line))[0])]
    return _from(report, head, rows)


def lockstep() -> str:
    """docs/howto/controllers.md: what a tick of a controller in the loop costs."""
    labels = "the library alone", "bare messages, there and back", "the dynamics node", "node over the sum, by turns"
    return _labelled("lockstep", ("way", "a tick"), labels)


def gym() -> str:
    """docs/howto/learning.md: what a control step of the environments costs."""
    labels = [label for name in ("Heading", "Depth") for label in (f"Eel/{name}-v0", f"Eel/{name}-v0 by bare")]
    return _labelled("gym", ("what", "measured"), labels)


ROBOTS = "eight_servos", "16 servos, kp 100 N m/rad", "series_elastic", "passive_tail"


def robots() -> str:
    """docs/howto/bending.md: times real time of robots, at a delivered 1e-3 and at the target 1e-3."""
    report = Report("robots")
    found: dict[str, list[str]] = {}
    form = r"(?:plane|space), (.*), target \S+ +(\S+) times real time, error (\S+),"
    for label, times, error in (row for line in report.lines for row in re.findall(form, line)):
        found.setdefault(label, []).append(f"{float(times):.0f} ({error})")
    head = ("robot", "plane, delivered 1e-3", "plane, target 1e-3", "space, delivered 1e-3", "space, target 1e-3")
    rows = [(label, *cells) for label, cells in found.items() if label in ROBOTS]
    return _from(report, head, rows, f" (`{report.command}`), which has more robots")


def _labelled(figure: str, head: Sequence[str], labels: Sequence[str]) -> str:
    """A row for each of the `labels` of a report's `figure`."""
    report = Report(figure)
    return _from(report, head, [(label, report.rest(label)) for label in labels], f" (`{report.command}`)")


def _from(report: Report, head: Sequence[str], rows: Sequence[Sequence[str]], made: str = "") -> str:
    """A table below the line that names its report."""
    return f"From {link(report, '../../')}{made}.\n\n{table(head, rows)}"


BLOCKS: dict[str, dict[str, Callable[[], str]]] = {
    "README.md": {"life": life, "bars": partial(bars, "docs/")},
    "docs/index.md": {"life": life, "bars": partial(bars, "")},
    "docs/explanation/accuracy.md": {"speed": speed},
    "docs/explanation/trust.md": {"checks": checks},
    "docs/howto/controllers.md": {"lockstep": lockstep},
    "docs/howto/learning.md": {"gym": gym},
    "docs/howto/bending.md": {"robots": robots},
    "docs/explanation/integrators.md": {"integrators": integrators},
}


def with_figures(page: str, blocks: dict[str, Callable[[], str]]) -> str:
    """The page's text with what the figures are now between their marker lines."""
    for name, write in blocks.items():
        page = with_part(page, name, write())
    return page


def main() -> int:
    """Write the tables and the chart."""
    CHART.write_text(speed_chart(others()), encoding="utf-8")
    for name, blocks in BLOCKS.items():
        path = ROOT / name
        path.write_text(with_figures(path.read_text(encoding="utf-8"), blocks), encoding="utf-8")
        print(f"{name}: {', '.join(blocks)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
