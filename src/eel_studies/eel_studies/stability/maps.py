# SPDX-License-Identifier: Apache-2.0
"""Maps of the error over two parameters of a run at a time.

Each run is compared with a finer one. The error is the greatest distance between the two heads over all samples,
relative to the length of the head's path or of the body, whichever is longer. A run is accurate if its error meets the
target. For an inaccurate run the map records whether the run indicates it: by a warning, or by its error estimate.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.runs.swim import Swim
from eel_dynamics.simulation.stopping import SimulationStopped

from eel_studies.workers import in_threads

TARGET, FINER = 1e-3, 1e-6
FINEST = Accuracy(name="finest", resolution=200.0, tolerance=1e-12)  # for comparison with the finer presets
SAMPLES = 32  # of a run
STATIONS = 33
ACCURATE, INACCURATE, STOPPED = "accurate", "inaccurate", "stopped"


class Axis(NamedTuple):
    """An axis of a map: label, least and greatest value."""

    label: str
    low: float
    high: float


class Cell(NamedTuple):
    """One cell of a map: what swims, for how long [s], and the target of its relative error."""

    swim: Swim
    duration: float
    target: float = TARGET


@dataclass(frozen=True)
class Map:
    """A grid over two axes, with `points` values of each in geometric sequence.

    at(x, y): what is there, a `Cell` or a number. names: labels of the rows where y is not a number, but the row.
    """

    name: str
    title: str
    across: Axis
    up: Axis
    points: int
    at: Callable[[float, float], Any]
    names: tuple[str, ...] = ()

    @property
    def x(self) -> np.ndarray:
        """Values along the map."""
        return np.geomspace(self.across.low, self.across.high, self.points)

    @property
    def y(self) -> np.ndarray:
        """Values of the rows; of rows with names the powers of 2."""
        return 2.0 ** np.arange(len(self.names)) if self.names else np.geomspace(*self.up[1:], self.points)

    def values(self, of: Callable[[Any], Any] = lambda found: found) -> np.ndarray:
        """`of(at(x, y))` of every cell, over threads: (len(y), len(x), ...)."""
        rows = range(len(self.names)) if self.names else self.y
        found = in_threads(lambda cell: of(self.at(cell[1], cell[0])), product(rows, self.x))
        return np.array(found).reshape(len(self.y), len(self.x), *np.shape(found[0]))


CELL = np.dtype(
    [
        ("size", float),  # error relative to the target; NaN where the run stopped
        ("reason", object),  # message of the stop, empty where there was none
        ("steps", int),  # in time
        ("limits", bool),  # the run warns of a limit of the model
        ("warned", bool),  # inaccurate, and the run warns of an open energy ledger
        ("estimate", float),  # error estimate of an inaccurate run relative to its target; else NaN
    ]
)


@dataclass(frozen=True)
class Measured:
    """The results of a map: `cells` (len(y), len(x)) of the type `CELL`."""

    map: Map
    cells: np.ndarray

    @property
    def outcome(self) -> np.ndarray:
        """`ACCURATE`, `INACCURATE` or `STOPPED` for each run."""
        kept = np.where(self.cells["size"] <= 1.0, ACCURATE, INACCURATE)
        return np.where(self.cells["reason"] != "", STOPPED, kept)

    @property
    def worst(self) -> float:
        """Greatest error relative to the target among finished runs; NaN where none finished."""
        size = self.cells["size"]
        return float(np.nanmax(size)) if np.isfinite(size).any() else np.nan


def measure(item: Map) -> Measured:
    """Simulate every point of the map, and again with finer settings for comparison."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the runs keep them
        found = item.values(cell_of)
    return Measured(item, found)


def cell_of(cell: Cell) -> np.ndarray:
    """The cell (`CELL`) of one run."""
    how: dict[str, Any] = {"duration": cell.duration, "sample_period": cell.duration / SAMPLES, "stations": STATIONS}
    finest = Accuracy.of(FINER) if cell.target >= TARGET else FINEST
    steps = 0
    try:
        run = cell.swim.run(**how)
        steps = run.steps
        finer = cell.swim._replace(accuracy=finest).run(**how, estimate=False)
    except (SimulationStopped, ValueError) as stop:
        ended = getattr(stop, "run", None)
        return np.array((np.nan, str(stop), steps or (ended.steps if ended else 0), False, False, np.nan), CELL)
    apart = np.linalg.norm(run.position - finer.position, axis=1).max()
    size = apart / max(finer.path_length, run.body.length) / cell.target
    ledger = [text for text in run.warnings if "ledger" in text]
    limits, poor = len(run.warnings) > len(ledger), size > 1.0
    assert run.error_estimate is not None
    estimate = run.error_estimate.worst / cell.target if poor else np.nan
    return np.array((size, "", run.steps, limits, poor and bool(ledger), estimate), CELL)
