# SPDX-License-Identifier: Apache-2.0
"""docs/appendix/measurements.csv holds what the model gives beside measurements: `make validation` writes it."""

import csv

import pytest
from studied import measurements
from validation import MEASUREMENTS

STALE = f"{MEASUREMENTS.name} is stale: make validation"


@pytest.fixture(scope="module")
def rows() -> dict[str, dict[str, str]]:
    """The lines of the file, by what is compared."""
    with MEASUREMENTS.open(newline="", encoding="utf-8") as file:
        return {row["compared"]: row for row in csv.DictReader(file)}


def test_figures_of_the_file_are_those_of_the_model(rows):
    low, high = map(float, rows["Strouhal number of steady eels"]["ours"].split(" to "))
    found = measurements.eel(measurements.FREQUENCIES[1], measurements.WAVELENGTHS[0], measurements.GROWTHS[0])
    assert low - 0.005 <= found.strouhal <= high + 0.005, STALE
    assert found.tail_excursion == pytest.approx(measurements.TAIL * measurements.EEL.length, rel=0.02)
    ratio = measurements.mamba(True).mean_speed / measurements.mamba(False).mean_speed
    ours = rows["speed of Mamba's eel-like motion by that of its lateral undulation"]["ours"]
    assert float(ours) == pytest.approx(ratio, abs=2e-3), STALE


def test_every_line_names_its_source_and_what_came_out(rows):
    assert len(rows) >= 10
    for row in rows.values():
        assert tuple(row) == measurements.COLUMNS and all(row.values())
        assert row["source"] in measurements.SOURCES.values(), STALE
