# SPDX-License-Identifier: Apache-2.0
"""The table "Against measurements" of docs/appendix/validation.md holds what the model gives: `make validation`."""

import re

import measurements
import pytest
from validation import PAGE

STALE = f"{PAGE.name} is stale: make validation"


@pytest.fixture(scope="module")
def page() -> str:
    if not PAGE.is_file():
        pytest.skip("a package alone has no page")
    return PAGE.read_text(encoding="utf-8").partition("## Against measurements")[2]


def row_of(page: str, beginning: str) -> list[str]:
    (row,) = (line for line in page.splitlines() if line.startswith(f"| {beginning}"))
    return [cell.strip() for cell in row.strip("|").split("|")]


def test_figures_of_the_page_are_those_of_the_model(page):
    low, high = map(float, row_of(page, "Strouhal number of steady eels")[2].split(" to "))
    found = measurements.eel(measurements.FREQUENCIES[1], measurements.WAVELENGTHS[0], measurements.GROWTHS[0])
    assert low - 0.005 <= found.strouhal <= high + 0.005, STALE
    assert found.tail_excursion == pytest.approx(measurements.TAIL * measurements.EEL.length, rel=0.02)
    ratio = measurements.mamba(True).mean_speed / measurements.mamba(False).mean_speed
    assert float(row_of(page, "speed of Mamba's eel-like motion")[2]) == pytest.approx(ratio, abs=2e-3), STALE


def test_every_line_names_its_source_and_what_came_out(page):
    rows = [row for row in page.splitlines() if row.startswith("| ") and not row.startswith("| compared")]
    assert len(rows) >= 10
    for row in rows:
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        assert len(cells) == 4 and all(cells)
        assert re.search(r"\[(\w+)\]$", cells[1])[1] in measurements.SOURCES
    for text in measurements.SOURCES.values():
        assert text in page, STALE
