# SPDX-License-Identifier: Apache-2.0
"""The notebook of the documentation: its cells run, one after the other, and say what they said when it was written."""

import contextlib
import io
import json
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).resolve().parents[1] / "docs" / "tutorials" / "swim.ipynb"
SMALL = 200_000  # bytes, pictures included


@pytest.mark.soak
def test_every_cell_runs_in_order(tmp_path, monkeypatch):
    import matplotlib

    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    cells = [cell for cell in json.loads(NOTEBOOK.read_text())["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 5
    space: dict = {}
    for number, cell in enumerate(cells, start=1):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            exec(compile("".join(cell["source"]), f"cell {number}", "exec"), space)
        written = "".join(
            line for output in cell["outputs"] if output["output_type"] == "stream" for line in output["text"]
        )
        assert words(said.getvalue()) == words(written), f"cell {number}"
    assert {path.name for path in tmp_path.iterdir()} == {"swim.rrd", "compare.rrd"}


def test_it_is_small_and_valid():
    notebook = json.loads(NOTEBOOK.read_text())
    assert NOTEBOOK.stat().st_size < SMALL
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    for cell in notebook["cells"]:
        assert {"cell_type", "id", "metadata", "source"} <= cell.keys()


def words(text: str) -> list[str]:
    """Without numbers, whose last digits another machine may have otherwise."""
    return [word for word in text.split() if not any(sign.isdigit() for sign in word)]
