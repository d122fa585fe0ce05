# SPDX-License-Identifier: Apache-2.0
"""docs/reference/manoeuvres.md: it has every gait with its picture, and the figures that a swim gives."""

import csv
import re
from pathlib import Path

import manoeuvres
import pytest
from eel_gaits.gaits.registry import GAITS

from eel_gaits import sequence_from_file

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs/reference/manoeuvres.md").read_text()


@pytest.mark.parametrize("name", sorted(GAITS))
def test_page_has_the_gait_and_a_small_picture(name):
    picture = ROOT / "docs/images/manoeuvres" / f"{name}.png"
    assert f"| [{name}](../images/manoeuvres/{name}.png) |" in PAGE and picture.stat().st_size < 200_000


def test_the_figures_of_the_page_are_those_of_a_swim():
    swim = manoeuvres.Swim("c_start")
    with (ROOT / "docs/reference/manoeuvres.csv").open(newline="") as file:
        *row, note = next(row for row in csv.reader(file) if row[0] == "c_start")
    assert row == swim.row() and f" | {' | '.join(row[-3:])} |" in PAGE
    assert manoeuvres.NOTES["c_start"](swim, {"straight": swim}).split(";")[0] == note.split(";")[0]


def test_the_sequence_of_the_page_is_read(tmp_path):
    (tmp_path / "patrol.yaml").write_text(re.search(r"```yaml\n(.*?)```", PAGE, re.DOTALL)[1])
    assert sequence_from_file(tmp_path / "patrol.yaml").name == "patrol"
