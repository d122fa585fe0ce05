# SPDX-License-Identifier: Apache-2.0
"""The front of speed against cost that `optimise` finds, as a table and as a picture."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from eel_base.wording import shown
from eel_dynamics.analysis.measures import described
from eel_dynamics.model.equality import same_fields
from eel_dynamics.runs.run import Run

from eel_studies.optimisation.drawing import SIZE, draw_front
from eel_studies.pictures.picture_file import write_picture
from eel_studies.table import Table

BOUND = 1e-3  # of the bounds' distance: nearer to one of them is at it
FORMATS = (".png", ".svg")


@dataclass(frozen=True, eq=False, repr=False)
class Front:
    """The gaits of least cost at S speeds, by P parameters, slowest first.

    Speeds and costs are those of `runs`, whose errors are estimated; they begin at the wanted speed, and last twice as
    long as the swims of the search.
    """

    cost_name: str  #: measure that was minimised
    names: tuple[str, ...]  #: of the parameters
    low: np.ndarray  #: (P,) bounds of the parameters
    high: np.ndarray  #: (P,)
    wanted: np.ndarray  #: (S,) m/s
    values: np.ndarray  #: (S, P)
    speed: np.ndarray  #: (S,) m/s
    cost: np.ndarray  #: (S,), unit of the measure `cost_name`
    runs: tuple[Run, ...]
    tried: np.ndarray  #: (N, 2) speed [m/s] and cost of the gaits that were tried
    warnings: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.runs)

    def __eq__(self, other: object) -> bool:
        return same_fields(self, other)

    __hash__ = None  # type: ignore[assignment]  # typeshed has `object` hashable; this holds arrays

    def __repr__(self) -> str:
        return f"Front({len(self)} speeds, {self.cost_name} by {', '.join(self.names)})"

    @property
    def at_bound(self) -> np.ndarray:
        """(S, P) bool: parameters that lie at a bound, which then decides."""
        place = (self.values - self.low) / (self.high - self.low)
        return np.asarray((place < BOUND) | (place > 1.0 - BOUND))

    @property
    def dominated(self) -> np.ndarray:
        """(S,) bool: gaits for which another one is at least as fast and costs less."""
        faster = self.speed[None] >= self.speed[:, None]
        return np.asarray(np.any(faster & (self.cost[None] < self.cost[:, None]), axis=1))

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """The columns (S,) of the table by name."""
        found = {"speed": self.speed, self.cost_name: self.cost}
        for name in ("strouhal", "stride", "tail_excursion", "speed_change"):
            figures = [getattr(run.analysis(), name) for run in self.runs]
            found[name] = np.array([np.nan if each is None else each for each in figures], dtype=float)
        return found | dict(zip(self.names, self.values.T, strict=True))

    def table(self) -> str:
        """The gaits as lines of text. A star marks a parameter at its bound, and a gait that another one dominates."""
        unit = described(self.cost_name)["units"]
        columns = {"speed": "speed [m/s]", self.cost_name: f"{self.cost_name} [{unit}]", "tail_excursion": "tail [m]"}
        cells = []
        for name, values in self.columns.items():
            stars = self.dominated if name == "speed" else np.zeros(len(self), dtype=bool)
            if name in self.names:
                stars = self.at_bound[:, self.names.index(name)]
            cells.append([f"{value:.4g}{'*' if star else ' '}" for value, star in zip(values, stars, strict=True)])
        head = [f"{columns.get(name, name)} " for name in self.columns]
        return Table(head, list(zip(*cells, strict=True)), left=0).text()

    def draw(self, path: str | Path) -> None:
        """Draw the front, the parameters and the gaits into a file (.png, .svg).

        `ValueError` for another suffix; `ImportError` without matplotlib; `OSError` where the file cannot be written.
        """
        path = Path(path)
        if path.suffix not in FORMATS:
            raise ValueError(f"path must end in {' or '.join(FORMATS)}, got {shown(str(path))}")
        write_picture(lambda figure: draw_front(figure, self), SIZE, path)
