# SPDX-License-Identifier: Apache-2.0
"""The front as a picture: cost against speed, the parameters along the front, and the gaits as midlines."""

from typing import TYPE_CHECKING

import numpy as np
from eel_dynamics.analysis.measures import described
from eel_dynamics.runs.run import Run

from eel_studies.pictures.style import BLUE, GREY, LOOKS, Axes, Figure

if TYPE_CHECKING:
    from eel_studies.optimisation.front import Front

SIZE = 9.0, 5.6  # inches
MOST_GAITS = 5
PHASES = 9  # midlines in a period
FAR = 2.0  # times the front's greatest cost and speed: gaits beyond are not drawn


def draw_front(figure: Figure, front: "Front") -> None:
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
    lower.supxlabel("midlines over one period [m], seen from above; the head on the left", fontsize="medium")


def _draw_cost(axes: Axes, front: "Front") -> None:
    unit = described(front.cost_name)["units"]
    near = (front.tried[:, 0] <= FAR * front.speed.max()) & (front.tried[:, 1] <= FAR * front.cost.max())
    axes.plot(*front.tried[near].T, ".", color=GREY, markersize=2.5, alpha=0.5, label="gaits tried", zorder=1)
    kept = ~front.dominated
    axes.plot(front.speed, front.cost, "-", color=BLUE, linewidth=1.2, zorder=2)
    axes.plot(front.speed[kept], front.cost[kept], "o", color=BLUE, label="least cost at this speed", zorder=3)
    if not kept.all():
        axes.plot(
            front.speed[~kept],
            front.cost[~kept],
            "o",
            color=BLUE,
            markerfacecolor="white",
            label="another gait is faster and costs less",
            zorder=3,
        )
    axes.set(xlabel="speed [m/s]", ylabel=f"{front.cost_name.replace('_', ' ')} [{unit}]", ylim=(0.0, None))
    axes.set_xlim(0.0, None)
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)


def _draw_parameters(axes: Axes, front: "Front") -> None:
    place = (front.values - front.low) / (front.high - front.low)
    for index, name in enumerate(front.names):
        colour, dash, mark = LOOKS[index % len(LOOKS)]
        label = f"{name}, {front.low[index]:.4g} to {front.high[index]:.4g}"
        axes.plot(front.speed, place[:, index], color=colour, linestyle=dash, marker=mark, markersize=4, label=label)
    axes.set(xlabel="speed [m/s]", ylabel="parameter, between its bounds", ylim=(-0.03, 1.03))
    axes.set_yticks([0.0, 0.5, 1.0], ["low", "", "high"])
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)


def _draw_gait(axes: Axes, run: Run, speed: float) -> None:
    """Midlines over the last period, in the axes of the way: ahead to the left."""
    analysis = run.analysis()
    window = analysis.window
    period = window.period
    start, end = window.center_of_mass(window.end - period), window.center_of_mass(window.end)
    ahead = (end - start)[:2] / np.linalg.norm((end - start)[:2])
    backbone = window.spline(run.backbone)
    for phase, time in enumerate(np.linspace(window.end - period, window.end, PHASES)):
        middle = start + (time - window.end + period) / period * (end - start)
        points = (backbone(time) - middle)[:, :2]
        along, across = -points @ ahead, points @ np.array((-ahead[1], ahead[0]))
        axes.plot(along, across, color=BLUE, linewidth=0.9, alpha=0.25 + 0.75 * phase / (PHASES - 1))
    axes.set_aspect("equal")
    strouhal = analysis.strouhal
    number = "" if strouhal is None else f", St {strouhal:.2f}"
    axes.set_title(f"{speed:.3g} m/s, {1.0 / period:.2g} Hz{number}", fontsize="small")
