# SPDX-License-Identifier: Apache-2.0
"""Maps of the outcome of a swim over two numbers at a time. No cell may be wrong in silence.

Each cell is swum, and again at a tenth of its target. Its error is the distance of the two in position and torque, in
the sense of `accuracy`. A cell has one of the `OUTCOMES`:

accurate: the error is within the target. sensitive: it is not, the run says so, and errors grow at least a hundredfold.
inaccurate: it is not, and the run says so, by its estimate or a warning. stopped, refused: with a message.
unchecked: the finer run stops, or may miss its own target. silent: the error exceeds the target by more than the finer
run's uncertainty, and the run does not say so.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from eel_dynamics.accuracy.accuracy import FINEST, Accuracy
from eel_dynamics.batches.simulate_batch import in_threads
from eel_dynamics.runs.companion import relative_errors

from eel_dynamics import Run, Swim
from eel_studies.reference import attempt
from eel_studies.varied import varied

TARGET = 1e-3  # of settings without a target
FINER = 0.1  # of the target
SAMPLES, STATIONS = 96, 33  # enough for a torque that jumps from limit to limit
# Evaluations: per simulated second and decade of the target; a cell's total is that of this duration [s].
MOST_EVALUATIONS, LONGEST = 1e4, 4.0
OUTCOMES = ACCURATE, SENSITIVE, INACCURATE, STOPPED, REFUSED, UNCHECKED, SILENT = (
    *("accurate", "sensitive", "inaccurate", "stopped", "refused", "unchecked", "silent"),
)
CELL = np.dtype(
    [
        ("outcome", object),
        ("size", float),  # error relative to the target; NaN without one
        ("text", object),  # message of a stop or a refusal, or a remark
        ("rate", float),  # 1/s, at which errors grow
        ("steps", int),  # number of time steps
        ("limits", bool),  # the run warns of a limit of the model
    ]
)


class Axis(NamedTuple):
    """An axis of a map: label, name of the number (`varied`), least and greatest value, or the rows' values."""

    label: str
    name: str
    low: float = 1.0
    high: float = 1.0
    choices: tuple[Any, ...] = ()

    def values(self, points: int) -> np.ndarray:
        """Places along the axis: `points` in geometric sequence, or powers of 2 for choices."""
        return 2.0 ** np.arange(len(self.choices)) if self.choices else np.geomspace(self.low, self.high, points)

    def settings(self, points: int) -> list[Any]:
        """The values of the number at these places."""
        return list(self.choices) or self.values(points).tolist()


@dataclass(frozen=True)
class Map:
    """A grid of `points` by `points` over two axes, of a `swim`, or of a number at(x, y)."""

    name: str
    title: str
    across: Axis
    up: Axis
    points: int
    swim: Swim | None = None
    at: Callable[[Any, Any], Any] | None = None

    @property
    def x(self) -> np.ndarray:
        """Values along the map."""
        return self.across.values(self.points)

    @property
    def y(self) -> np.ndarray:
        """Values of the rows."""
        return self.up.values(self.points)

    def found(self, x: Any, y: Any) -> Any:
        """The swim or the number at x and y. `ValueError` if it is refused."""
        if self.at is not None:
            return self.at(x, y)
        assert self.swim is not None
        return varied(self.swim, {self.across.name: x, self.up.name: y})

    def values(self, of: Callable[[Callable[[], Any]], Any] = lambda found: found()) -> np.ndarray:
        """`of` applied to the finder of each cell, over threads: (len(y), len(x), ...)."""
        cells = product(self.up.settings(self.points), self.across.settings(self.points))
        found = in_threads(lambda cell: of(lambda: self.found(cell[1], cell[0])), cells)
        return np.array(found).reshape(len(self.y), len(self.x), *np.shape(found[0]))


@dataclass(frozen=True)
class Measured:
    """The results of a map: `cells` (len(y), len(x)) of the type `CELL`."""

    map: Map
    cells: np.ndarray

    def count(self, outcome: str) -> int:
        """The number of cells with this outcome."""
        return int(np.sum(self.cells["outcome"] == outcome))

    @property
    def worst(self) -> float:
        """Greatest error relative to the target among finished runs; NaN if none finished."""
        size = self.cells["size"]
        return float(np.nanmax(size)) if np.isfinite(size).any() else np.nan

    def texts(self, outcome: str) -> list[str]:
        """The distinct messages of this outcome, without times and values."""
        cells = self.cells[self.cells["outcome"] == outcome]
        if outcome == SENSITIVE:  # the fastest of them
            return [f"errors grow by a factor of e in {1.0 / cells['rate'].max():.2g} s"] if len(cells) else []
        return sorted({text.partition("s: ")[2].partition(" (")[0] or text for text in cells["text"] if text})


def measure(item: Map) -> Measured:
    """Swim every cell of the map, and once more at a tenth of its target."""
    with warnings.catch_warnings(action="ignore"):  # the runs keep them
        return Measured(item, item.values(cell_of))


def cell_of(swim_of: Callable[[], Swim]) -> np.ndarray:
    """The cell (`CELL`) of the swim made by `swim_of()`, which may be refused."""
    try:
        swim = swim_of()
    except ValueError as error:
        return _cell(REFUSED, str(error))
    target = getattr(Accuracy.of(swim.accuracy), "target", None) or TARGET
    run = _swum(swim, target)
    if isinstance(run, Exception):
        own = getattr(run, "run", None)
        return _cell(REFUSED if isinstance(run, ValueError) else STOPPED, str(run), steps=own.steps if own else 0)
    about: dict[str, Any] = {
        "steps": run.steps,
        "limits": any("ledger" not in text and "error" not in text for text in run.warnings),
    }
    finer = _swum(swim.changed(accuracy=Accuracy.of(max(FINER * target, FINEST))), FINER * target)
    if isinstance(finer, Exception):
        return _cell(UNCHECKED, str(finer), **about)
    own, others = run.error_estimate, finer.error_estimate
    assert own is not None and others is not None
    apart = relative_errors(run, finer).worst
    about |= {"size": apart / target, "rate": own.growth_rate}
    if apart <= target:
        return _cell(ACCURATE, **about)
    if own.worst > target or any("ledger" in text for text in run.warnings):
        return _cell(SENSITIVE if own.sensitive(float(run.time[-1])) else INACCURATE, **about)
    if apart <= target + others.worst:
        return _cell(UNCHECKED, f"the finer run has an error of {others.worst:.1e}", **about)
    return _cell(SILENT, f"the error is {apart:.1e}, the estimate {own.worst:.1e}", **about)


def _cell(outcome: str, text: str = "", **about: Any) -> np.ndarray:
    values = {"size": np.nan, "rate": 0.0, "steps": 0, "limits": False} | about | {"outcome": outcome, "text": text}
    return np.array(tuple(values[name] for name in CELL.names or ()), CELL)


def _swum(swim: Swim, target: float) -> Run | Exception:
    duration = float(swim.duration)
    most = MOST_EVALUATIONS * max(1.0, -np.log10(target)) * min(max(1.0, duration), LONGEST) / duration
    how = {"sample_period": duration / SAMPLES, "stations": STATIONS, "most_evaluations": most, "estimate": True}
    return attempt(swim.changed(scene=replace(swim.scene, ledger=True)), **how)
