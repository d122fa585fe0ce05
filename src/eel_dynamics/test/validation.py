# SPDX-License-Identifier: Apache-2.0
"""What the tests of the mechanics measure: recorded while they run, listed at their end, kept in
docs/appendix/validation.csv and told in short by validation.md beside it.

    make validation        # runs those tests and writes both

A test that carries the marker `identity` calls the fixture `measured(what, value, tolerance)`: it fails where the value
is beyond its tolerance, and is recorded else, the worst value of all cases.
"""

import csv
import math
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from eel_base.files import markdown

ROOT = Path(__file__).resolve().parents[3]
RECORD = ROOT / "out" / "validation.csv"  # of the last session
KEPT = ROOT / "docs" / "appendix" / "validation.csv"
PAGE = KEPT.with_suffix(".md")
COLUMNS = "identity", "compared", "measured", "tolerance", "cases", "share of tolerance", "test"

IDENTITIES = {
    "Energy ledger": "The change of the energy of body and water is the integral of the powers.",
    "Closure": "What the internal wrench leaves over at nose and tail; accelerations against the motion marched.",
    "Lighthill": "Planar motion without drag is Lighthill's theory, large amplitude (1971) and linear (1960).",
    "No water": "Momentum stays; kinetic energy is the work of the actuators.",
    "Righting moment": "Weight below buoyancy: a pendulum in water, a torque from a potential, no direction special "
    "but up.",
    "Bodies that weigh": "Gravity, buoyancy, mass along the body, a centre of mass off the axis: closed forms at "
    "release, the roll's frequency, the same at any depth.",
    "Fins": "Lift, drag and added mass of fins by hand and against the second implementation, the roll that they hold, "
    "the ledger and both forms of the balance.",
    "Rigid body": "The straight rigid body has closed forms: Munk's moment, coasting, Euler's top.",
    "Symmetry": "Another pose, a mirror, the plane, rest, a current.",
    "Convergence": "Orders in time and in space, and what the presets reach on the falling gait over 10 s.",
    "Scaling": "Similar swimmers at equal Reynolds number swim alike.",
    "Second implementation": "The equations again from the kinetic energy alone, by other code (`reference.py`).",
    "Pressure at the tail": "Lumped at the tail or distributed along the body: the same resultant and moment.",
    "Bodies": "Geometry and section data against what is printed or known.",
    "Read off a run": "Figures of `Run.analysis()` and `Run.actuators()` against the same, computed another way.",
}


@dataclass
class Check:
    """One line of the record: what is compared, the worst value, its tolerance, where it is measured, how often."""

    identity: str
    what: str
    test: str
    value: float
    tolerance: float
    wanted: float | None
    unit: str
    cases: int = 1

    @property
    def distance(self) -> float:
        return abs(self.value - (self.wanted or 0.0))

    @property
    def measured(self) -> str:
        if self.wanted is None:
            return f"{'0' if self.value == 0.0 else f'{self.value:.1e}'} {self.unit}".rstrip()
        return f"{self.value:.{self._digits}f} {self.unit}".rstrip()

    @property
    def allowed(self) -> str:
        if self.wanted is not None:
            return f"{self.wanted:g} ± {self.tolerance:.2g} {self.unit}".rstrip()
        allowed = "exact" if self.tolerance == 0.0 else f"{self.tolerance:.1e}".replace(".0e", "e")
        return f"{allowed} {self.unit}".rstrip()

    @property
    def _digits(self) -> int:
        return max(0, 1 - math.floor(math.log10(self.tolerance)))

    @property
    def row(self) -> list[str]:
        """Its cells under `COLUMNS`."""
        share = f"{self.distance / self.tolerance:.1e}" if self.tolerance else "0"
        return [self.identity, self.what, self.measured, self.allowed, str(self.cases), share, self.test]


class Checks:
    """The checks of a session, in the order of their first measurement."""

    def __init__(self):
        self.by_name: dict[tuple[str, str], Check] = {}
        self.identity = self.test = None

    def begin(self, item) -> None:
        """The test `item` is about to run."""
        marker = item.get_closest_marker("identity")
        self.identity = marker.args[0] if marker else None
        self.test = f"{item.path.name}::{item.originalname}"

    def measure(self, what: str, value, tolerance: float, *, wanted: float | None = None, unit: str = "") -> None:
        """Assert that the greatest of `value` is at most `tolerance`, or at most that far from `wanted`."""
        if self.identity not in IDENTITIES:
            raise ValueError(f"{self.test} must have a marker identity(...) of validation.py to use `measured`")
        values = np.atleast_1d(np.asarray(value, dtype=float)).ravel()
        worst = float(values[np.argmax(np.abs(values - (wanted or 0.0)))])
        check = Check(self.identity, what, self.test, abs(worst) if wanted is None else worst, tolerance, wanted, unit)
        known = self.by_name.setdefault((self.identity, what), check)
        if known is not check:
            if (known.tolerance, known.wanted, known.unit) != (tolerance, wanted, unit):
                raise ValueError(f"{what}: one tolerance for all cases, got {known.allowed} and {check.allowed}")
            known.cases += 1
            if check.distance > known.distance:
                known.value = check.value
        said = f"{what}: {check.measured}, tolerance {check.allowed}"
        assert check.distance <= tolerance, said  # not-a-number fails

    def grouped(self) -> list[tuple[str, list[Check]]]:
        """Checks by identity, in the order of `IDENTITIES`."""
        listed = {identity: [] for identity in IDENTITIES}
        for check in self.by_name.values():
            listed[check.identity].append(check)
        return [(identity, group) for identity, group in listed.items() if group]

    def save(self) -> None:
        """Keep the record, where there is a page of it: a package that is tested alone has none."""
        if not PAGE.is_file():
            return
        RECORD.parent.mkdir(exist_ok=True)
        with RECORD.open("w", newline="", encoding="utf-8") as file:
            rows = [check.row for _, group in self.grouped() for check in group]
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])

    def lines(self) -> list[str]:
        """The list at the end of a run of tests."""
        out = []
        for identity, group in self.grouped():
            out.append(identity)
            out += [f"  {check.measured:>16}  ({check.allowed})  {check.what}" for check in group]
        return out


def kept() -> list[dict[str, str]]:
    """The lines of docs/appendix/validation.csv, by column."""
    with KEPT.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def summary() -> str:
    """The page's table: what must hold, how many checks show it, and how near the worst comes to its tolerance."""
    lines = []
    for identity, about in IDENTITIES.items():
        shares = [float(row["share of tolerance"]) for row in kept() if row["identity"] == identity]
        if shares:
            lines.append((f"**{identity}.** {about}", str(len(shares)), f"{100.0 * max(shares):.2g} %"))
    return markdown.table(("what must hold", "checks", "worst, of its tolerance"), lines)


def main() -> int:
    RECORD.unlink(missing_ok=True)
    tests = [sys.executable, "-m", "pytest", "-m", "identity and not soak", "src/eel_dynamics/test", "-q"]
    status = subprocess.run(tests, cwd=ROOT).returncode
    if status:
        return status
    sys.path.append(str(ROOT / "test"))
    import measurements  # simulates, which the tests that import this file need not

    shutil.copy(RECORD, KEPT)
    page = PAGE.read_text(encoding="utf-8")
    for name, text in (("identities", summary()), ("measurements", measurements.section())):
        page = markdown.with_part(page, name, text)
    PAGE.write_text(page, encoding="utf-8")
    print(f"wrote {KEPT.relative_to(ROOT)} and {PAGE.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
