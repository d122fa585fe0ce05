# SPDX-License-Identifier: Apache-2.0
"""The paper's own scheme, as the benchmarks have it, comes to the library's answer: a third code for the equations."""

import importlib
from pathlib import Path

import numpy as np
import pytest

from eel_dynamics import Body, Scene, simulate
from eel_gaits import falling

DURATION, STEP = 3.0, 0.01  # s


@pytest.fixture
def benchmark(monkeypatch):
    """The benchmark, and the Python that has numba."""
    monkeypatch.syspath_prepend(Path(__file__).resolve().parents[1] / "benchmarks")
    found = importlib.import_module("others.against_paper_scheme")
    python = found.environment("numba")
    if python is None:
        pytest.skip("numba, which runs the paper's scheme, could not be installed (no network?)")
    return found, python


@pytest.mark.soak  # it installs numba, which compiles the scheme for a quarter of a minute
@pytest.mark.timeout(900)
def test_paper_scheme_converges_to_the_library(benchmark):
    scheme, python = benchmark
    law, body = falling(), Body.boyer2010()
    scene = Scene(friction="laminar", ledger=False)
    run = simulate(law, DURATION, body=body, scene=scene, accuracy=1e-6, sample_period=STEP, stations=51)
    run = run.in_axes("paper")
    motion, torque = [], []
    for count in (50, 100, 200):
        theirs = scheme.swum(python, law, body, DURATION, STEP, count, wrench=True)
        motion.append(np.max(np.linalg.norm(theirs["position"] - run.position, axis=1)) / run.path_length)
        torque.append(np.max(np.abs(theirs["torque"] - run.torque)) / np.max(np.abs(run.torque)))
    # equal cells do not see the round nose, whose radius goes like the root of X: of order 3/2 at least, not 4
    for errors in (motion, torque):
        assert errors[0] < 1e-3 and errors[1] < errors[0] / 2.3 and errors[2] < errors[1] / 2.3
