# SPDX-License-Identifier: Apache-2.0
"""Rerun recordings of the points of a sweep, one file each, which can be queried like a table."""

import itertools
import os
from pathlib import Path
from typing import Any

from eel_common.quantity import checked_instance
from eel_common.wording import shown
from eel_dynamics.runs.exchange.eel_viz_functions import function_of_eel_viz
from eel_dynamics.runs.run import Run

from eel_studies.points import label_of

RATE = 12.5  # Hz: rate of skin and curves, half that in a recording of one run


class SweepRecordings:
    """Records points of a `grid`, values by name, into `folder`, which is created if its parent exists.

    `ValueError` if it cannot be written; `ImportError` without the package eel_viz.
    """

    def __init__(self, folder: str | Path, grid: dict[str, list[Any]]) -> None:
        function_of_eel_viz("rerun")
        self.folder, self._grid = Path(checked_instance("recordings", folder, (str, os.PathLike))), grid
        try:
            self.folder.mkdir(exist_ok=True)
        except OSError as error:
            raise ValueError(f"recordings {shown(str(folder))} cannot be written: {error.strerror}") from None

    def record(self, index: int, run: Run) -> None:
        """Record the `run` of the point with this `index`, without the water's forces."""
        values = next(itertools.islice(itertools.product(*self._grid.values()), index, None))
        numbers = {name: label_of(value) for name, value in zip(self._grid, values, strict=True)}
        if "accuracy" in numbers:
            numbers["accuracy"] = str(numbers["accuracy"])  # a name or a number
        run.to_rerun(self.folder / f"{index:06d}.rrd", load=False, rate=0.0, numbers=numbers, skin_rate=RATE)
