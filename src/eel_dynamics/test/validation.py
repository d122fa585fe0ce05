# SPDX-License-Identifier: Apache-2.0
"""What the tests of the mechanics measure: recorded while they run, listed at their end, kept in
docs/appendix/validation.csv. docs/explanation/trust.md has the worst of each kind.

    make validation        # runs those tests, and writes the file and measurements.csv beside it

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

ROOT = Path(__file__).resolve().parents[3]
RECORD = ROOT / "out" / "validation.csv"  # of the last session
KEPT = ROOT / "docs" / "appendix" / "validation.csv"
MEASUREMENTS = KEPT.with_name("measurements.csv")
COLUMNS = "identity", "compared", "measured", "tolerance", "cases", "share of tolerance", "test"

IDENTITIES = (
    "Energy ledger",
    "Closure",
    "Lighthill",
    "No water",
    "Righting moment",
    "Bodies that weigh",
    "Fins",
    "Rigid body",
    "Symmetry",
    "Convergence",
    "Scaling",
    "Second implementation",
    "Pressure at the tail",
    "Bodies",
    "Read off a run",
)


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
        """Keep the record, where there is a kept one: a package that is tested alone has none."""
        if not KEPT.is_file():
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


def main() -> int:
    RECORD.unlink(missing_ok=True)
    tests = [sys.executable, "-m", "pytest", "-m", "identity and not soak", "src/eel_dynamics/test", "-q"]
    status = subprocess.run(tests, cwd=ROOT).returncode
    if status:
        return status
    sys.path.append(str(ROOT / "test"))
    from studied import measurements  # simulates, which the tests that import this file need not

    shutil.copy(RECORD, KEPT)
    measurements.write(MEASUREMENTS)
    print(f"wrote {KEPT.relative_to(ROOT)} and {MEASUREMENTS.name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
