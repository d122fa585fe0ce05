# SPDX-License-Identifier: Apache-2.0
"""The front of speed against cost that `optimise` finds, as a table and as a picture."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.wording import shown
from eel_dynamics.analysis.measures import described
from eel_dynamics.model.equality import EqualByFields

from eel_dynamics import Run
from eel_studies.outputs import Table
from eel_studies.pictures import BLUE, GREY, LOOKS, PICTURES, Axes, Figure, along_way, write_picture

BOUND = 1e-3  # of the bounds' distance: a closer value is at the bound
SIZE = 9.0, 5.6  # inches
MOST_GAITS = 5
PHASES = 9  # midlines per period
FAR = 2.0  # times the front's greatest cost and speed: gaits beyond are not drawn


@dataclass(frozen=True, eq=False, repr=False)
class Front(EqualByFields):
    """The gaits of least cost at S speeds, by P parameters, slowest first.

    Speeds and costs are those of `runs`, whose errors are estimated. The runs begin at the wanted speed, and last twice
    as long as the swims of the search.
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
    tried: np.ndarray  #: (N, 2) speed [m/s] and cost of all gaits tried
    warnings: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.runs)

    def __repr__(self) -> str:
        return f"Front({len(self)} speeds, {self.cost_name} by {', '.join(self.names)})"

    @property
    def at_bound(self) -> np.ndarray:
        """(S, P) bool: parameters that lie at a bound, which limits the result."""
        place = (self.values - self.low) / (self.high - self.low)
        return np.asarray((place < BOUND) | (place > 1.0 - BOUND))

    @property
    def dominated(self) -> np.ndarray:
        """(S,) bool: gaits that another one dominates: it is at least as fast and costs less."""
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
        return Table(head, list(zip(*cells, strict=True)), left=()).text()

    def draw(self, path: str | Path) -> None:
        """Draw the front, the parameters and the gaits into a file (.png, .svg, .pdf).

        `ValueError` for other suffixes; `ImportError` without matplotlib; `OSError` if the file cannot be written.
        """
        path = Path(path)
        if path.suffix not in PICTURES:
            raise ValueError(f"path must end in {' or '.join(PICTURES)}, got {shown(str(path))}")
        write_picture(lambda figure: draw_front(figure, self), SIZE, path)


def draw_front(figure: Figure, front: Front) -> None:
    """Draw a `Front` into an empty matplotlib figure."""
    upper, lower = figure.subfigures(2, 1, height_ratios=(2.4, 1.0))
    left, right = upper.subplots(1, 2)
    _draw_cost(left, front)
    _draw_parameters(right, front)
    shown = np.unique(np.linspace(0, len(front) - 1, min(MOST_GAITS, len(front))).round().astype(int))
    panels = lower.subplots(1, len(shown), sharex=True, sharey=True, squeeze=False)[0]
    for axes, index in zip(panels, shown, strict=True):
        _draw_gait(axes, front.runs[index], front.speed[index])
    panels[0].set_ylabel("across [m]")
    lower.supxlabel("midlines over one period [m], seen from above; ahead is to the right", fontsize="medium")


def _draw_cost(axes: Axes, front: Front) -> None:
    unit = described(front.cost_name)["units"]
    near = (front.tried[:, 0] <= FAR * front.speed.max()) & (front.tried[:, 1] <= FAR * front.cost.max())
    axes.plot(*front.tried[near].T, ".", color=GREY, markersize=2.5, alpha=0.5, label="gaits tried", zorder=1)
    kept = ~front.dominated
    axes.plot(front.speed, front.cost, "-", color=BLUE, linewidth=1.2, zorder=2)
    axes.plot(front.speed[kept], front.cost[kept], "o", color=BLUE, label="least cost at this speed", zorder=3)
    if not kept.all():
        beaten: dict[str, Any] = {"markerfacecolor": "white", "label": "another gait is faster and costs less"}
        axes.plot(front.speed[~kept], front.cost[~kept], "o", color=BLUE, zorder=3, **beaten)
    axes.set(xlabel="speed [m/s]", ylabel=f"{front.cost_name.replace('_', ' ')} [{unit}]", ylim=(0.0, None))
    axes.set_xlim(0.0, None)
    axes.legend()


def _draw_parameters(axes: Axes, front: Front) -> None:
    place = (front.values - front.low) / (front.high - front.low)
    for index, name in enumerate(front.names):
        colour, dash, mark = LOOKS[index % len(LOOKS)]
        label = f"{name}, {front.low[index]:.4g} to {front.high[index]:.4g}"
        axes.plot(front.speed, place[:, index], color=colour, linestyle=dash, marker=mark, markersize=4, label=label)
    axes.set(xlabel="speed [m/s]", ylabel="parameter, between its bounds", ylim=(-0.03, 1.03))
    axes.set_yticks([0.0, 0.5, 1.0], ["low", "", "high"])
    axes.legend()


def _draw_gait(axes: Axes, run: Run, speed: float) -> None:
    """Midlines over the last period from above, in axes along the path: ahead to the right."""
    analysis = run.analysis()
    window = analysis.window
    period = window.period
    start, end = window.center_of_mass(window.end - period), window.center_of_mass(window.end)
    backbone = window.spline(run.backbone)
    for phase, time in enumerate(np.linspace(window.end - period, window.end, PHASES)):
        middle = start + (time - window.end + period) / period * (end - start)
        line = along_way((backbone(time) - middle)[:, :2], (end - start)[:2])
        axes.plot(*line.T, color=BLUE, linewidth=0.9, alpha=0.25 + 0.75 * phase / (PHASES - 1))
    axes.set_aspect("equal")
    strouhal = analysis.strouhal
    number = "" if strouhal is None else f", St {strouhal:.2f}"
    axes.set_title(f"{speed:.3g} m/s, {1.0 / period:.2g} Hz{number}", fontsize="small")
