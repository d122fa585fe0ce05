"""The paper's own scheme, as the benchmarks have it, comes to the library's answer: a third code for the equations."""

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

from eel_dynamics import Body, Scene, simulate
from eel_gaits import falling

DURATION, STEP = 3.0, 0.01  # s


@pytest.fixture(scope="module")
def scheme():
    folder = str(Path(__file__).resolve().parents[2] / "benchmarks")
    sys.path.insert(0, folder)  # by its name: numba finds its compiled loops by it
    try:
        yield importlib.import_module("paper_scheme")
    finally:
        sys.path.remove(folder)


@pytest.mark.soak  # its loops take a quarter of a minute to compile
def test_paper_scheme_converges_to_the_library(scheme):
    law, body = falling(), Body.boyer2010()
    scene = Scene(friction="laminar", ledger=False)
    run = simulate(law, DURATION, body=body, scene=scene, accuracy=1e-6, sample_period=STEP, stations=51)
    motion, torque = [], []
    for count in (50, 100, 200):
        shapes = scheme.curvatures(law, DURATION, STEP, count, body.length)
        positions, torques = scheme.swim(scheme.cells_of(body, count), shapes, STEP, wrench=True)
        motion.append(np.max(np.linalg.norm(positions - run.position, axis=1)) / run.path_length)
        torque.append(np.max(np.abs(torques[:, :: count // 50] - run.torque)) / np.max(np.abs(run.torque)))
    # equal cells do not see the round nose, whose radius goes like the root of X: of order 3/2 at least, not 4
    for errors in (motion, torque):
        assert errors[0] < 1e-3 and errors[1] < errors[0] / 2.3 and errors[2] < errors[1] / 2.3
