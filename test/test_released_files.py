# SPDX-License-Identifier: Apache-2.0
"""Files that released versions have saved (`make_released_files.py`) are read, with the numbers that were in them."""

import csv
import json
import warnings

import numpy as np
import pytest
from make_released_files import MOST_BYTES, RELEASED

from eel_dynamics import Batch, Run

VERSIONS = sorted(path for path in RELEASED.iterdir() if path.is_dir())
pytestmark = pytest.mark.parametrize("version", VERSIONS, ids=[path.name for path in VERSIONS])


@pytest.fixture
def expected(version) -> dict:
    return json.loads((version / "expected.json").read_text())


def check(run: Run, expected: dict) -> None:
    assert run.position[-1] == pytest.approx(expected["position"], abs=1e-12)
    assert abs(run.torque).max() == pytest.approx(expected["greatest_torque"], rel=1e-12)


def test_a_run_is_loaded_without_a_warning(version, expected):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = Run.load(version / "run.nc")
    check(run, expected)
    assert run.scene.friction == expected["friction"] and run.energy is not None and run.error_estimate is not None


def test_a_batch_is_loaded_without_a_warning(version, expected):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        batch = Batch.load(version / "batch.nc")
    assert batch.position[:, -1] == pytest.approx(np.array(expected["batch"]), abs=1e-12)


def test_a_bag_becomes_a_run(version, expected):
    check(Run.from_bag(version / "bag", scene=Run.load(version / "run.nc").scene), expected)


def test_a_table_has_the_columns_of_today(version, expected):
    with (version / "run.csv").open() as table:
        rows = list(csv.DictReader(table))
    assert [float(rows[-1][f"position_{axis}"]) for axis in "xyz"] == pytest.approx(expected["position"], abs=1e-12)


def test_the_files_of_a_version_are_small(version):
    assert 0 < sum(path.stat().st_size for path in version.rglob("*") if path.is_file()) <= MOST_BYTES
