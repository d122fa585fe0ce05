# SPDX-License-Identifier: Apache-2.0
"""Options, texts and files of commands that were mutated: each runs, or says in one line what does not fit."""

import json
import os
import re
import subprocess
import sys
from collections import Counter
from dataclasses import fields
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from eel_common.texts import made
from eel_common.wording import one_line
from eel_dynamics.model.fins.fins import Fin, RollHold
from eel_gaits.laws.ramp import Ramp
from eel_gaits.pilot.settings import PilotSettings
from fuzzed_texts import EXTREMES, ODD, VALUES, case_of
from interface import classes

from eel_dynamics import (
    Appendage,
    ExternalWrench,
    Gust,
    Joint,
    Muscle,
    PassiveTail,
    Scene,
    Servo,
    Shear,
    Torque,
    Uniform,
    Vortex,
    VortexStreet,
    Wave,
)
from eel_gaits import Law, Term
from eel_studies import MeasuredSpeed

LIMIT, SECONDS = 4000, 20  # MB of address space, and s of wall time, of a case
LONGEST = 330  # characters of a line
SEED, FEW, MANY = 56, 100, 5000
# what Python or numpy says of an error that nobody foresaw
FOREIGN = re.compile(
    r"Traceback|__init__|NoneType|unhashable|object is not|has no attribute|positional argument|unexpected keyword|"
    r"it does not fit|it is damaged or foreign|Errno|out of bounds|could not convert|truth value|encountered in|/dev/fd"
)


class Outcome(NamedTuple):
    """What became of a case: as the script prints it; `status` None where the process ended."""

    number: int
    words: list[str]
    files: dict[str, str]
    status: int | None
    raised: str
    said: str
    seconds: float

    @property
    def fits(self) -> bool:
        """Whether it ran, stopped (3) or could not be written (1), or was refused (2) in one line."""
        lines = [line for line in self.said.splitlines() if ": warning: " not in line]
        short = all(len(line) <= LONGEST and line.isprintable() for line in lines)
        told = self.status in (0, 1, 3) or (self.status == 2 and len(lines) == 1)
        return told and short and not self.raised and not FOREIGN.search(self.said)


def outcomes(folder: Path, seed: int, count: int) -> list[Outcome]:
    """What became of the first cases of a `seed`. The script is started again after a case that ended it."""
    script, found = Path(__file__).with_name("fuzzed_texts.py"), []
    while len(found) < count:
        done = subprocess.run(
            [sys.executable, script, folder, *map(str, (seed, len(found), count, LIMIT, SECONDS))],
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
            capture_output=True,
            text=True,
            timeout=3600,
            check=False,
        )
        found += [Outcome(*json.loads(line)) for line in done.stdout.splitlines()]
        if done.returncode:
            words = case_of(seed, len(found)).words
            found.append(Outcome(len(found), words, {}, None, f"{done.returncode}: {done.stderr[-300:]}", "", SECONDS))
    return found


@pytest.mark.fault(
    "parameters",
    "mutated command lines, texts of flows, fins, bodies and robots, scenes, sequences, robot files, URDF and tables: "
    "extremes, wrong types, what is missing, twice or unknown, other characters, empty",
    "one line, status 2; or a run",
)
@pytest.mark.timeout(600)
@pytest.mark.parametrize("count", [FEW, pytest.param(MANY, marks=[pytest.mark.soak, pytest.mark.timeout(3600)])])
def test_a_mutated_text_is_one_line_or_a_run(tmp_path, count):
    found = outcomes(tmp_path, SEED, count)
    print(f"\n{dict(Counter(each.status for each in found))}, slowest {max(each.seconds for each in found):.1f} s")
    assert not [each for each in found if not each.fits]
    assert {each.status for each in found} >= {0, 2}


FIN = {"station": 0.5, "side": "left", "area": 1e-3, "aspect_ratio": 2.0}
TAIL = {"start": 0.6, "bending_stiffness": 0.5, "damping": 0.01}
WAVE = {"amplitude": (0.5,), "period": 1.0}
OTHERS = np.array(1.0), np.array([]), np.zeros((2, 3)), object(), len, b"a", 1j, {1}, range(3), ("a",)
OBJECTS = (
    (Fin, FIN), (RollHold, {}), (Joint, {"position": 0.5}), (Servo, {}), (Torque, {"torque": (0, 1), "time": (0, 1)}),
    (PassiveTail, TAIL), (Muscle, TAIL | {"end": 0.9, "moment": Law(Term(**WAVE))}), (Scene, {}), (Term, WAVE),
    (Ramp, {"start": 0, "end": 1, "delta": 1}), (Appendage, {"x": 0.1}), (Uniform, {"velocity": (0, 0, 0)}), (Gust, {}),
    (Shear, {}), (Vortex, {}), (VortexStreet, {}), (Wave, {}), (PilotSettings, {}),
    (ExternalWrench, {"station": 0.5}), (MeasuredSpeed, {"speed": 0.3}),
)  # fmt: skip
OBJECTS += tuple((kind, {}) for kind in dict.fromkeys(classes()) if kind not in dict(OBJECTS))


BESIDE = {
    "angle": "time_constant",
    "series_stiffness": "rotor_inertia",
    "knots": "knot",
    "time": "velocity",
}  # goes with


@pytest.mark.parametrize(("kind", "good"), OBJECTS, ids=[kind.__name__ for kind, _ in OBJECTS])
def test_a_plain_value_of_any_field_is_taken_or_refused_by_name(kind, good):
    for item in fields(kind):
        for value in (
            *VALUES,
            *EXTREMES,
            *ODD,
            np.array(1.0),
            np.zeros((2, 3)),
            object(),
            len,
            b"a",
            1j,
            {1},
            range(3),
        ):
            try:
                made(kind, {**good, item.name: value}, kind.__name__.lower())
            except ValueError as error:
                assert not FOREIGN.search(str(error)) and len(one_line(error)) <= LONGEST, (item.name, value, error)
                assert re.search(rf"\b({item.name}|{BESIDE.get(item.name)})\b", str(error)), (item.name, value, error)
