# SPDX-License-Identifier: Apache-2.0
"""Robots compared, as a picture: speed, tracking error and drawn energy over one of their numbers."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from eel_studies.motors.motor_figures import Comparison, MotorFigures
from eel_studies.pictures import LOOKS, Figure, legend_above, write_picture

FORMATS = ".png", ".svg"
WIDE = 5.0  # ratio of the greatest to the least value, from which the axis is logarithmic
MOST_TICKS = 7
PANELS: dict[str, Callable[[MotorFigures], float]] = {
    "speed [m/s]": lambda figures: figures.speed,
    "tracking error [%]": lambda figures: 100.0 * figures.tracking_error,
    "energy [J/m]": lambda figures: figures.energy_per_metre,
}


def draw_comparisons(comparisons: Sequence[Comparison], *paths: Path) -> None:
    """Draw a curve for each of the `comparisons`, in a panel for each figure that is known, into files (.png, .svg).

    A value of none is left out. `ImportError` without matplotlib; `NotWritten` where a file cannot be completed.
    """

    def draw(figure: Figure) -> None:
        panels = figure.subplots(1, len(shown))
        for axes, (label, rows) in zip(np.atleast_1d(panels), shown.items(), strict=True):
            for index, (each, row) in enumerate(zip(comparisons, rows, strict=True)):
                colour, dash, mark = LOOKS[index % len(LOOKS)]
                x, y = zip(*((x, y) for x, y in zip(each.values, row, strict=True) if x is not None), strict=True)
                style = {"color": colour, "linestyle": dash, "marker": mark, "markersize": 3.5, "linewidth": 1.2}
                axes.plot(x, y, label=each.named or None, **style)
            axes.set(xlabel=comparisons[0].field, ylabel=label)
            axes.grid(alpha=0.3)
            known = [value for each in comparisons for value in each.values if value is not None]
            if min(known) > 0.0 and max(known) > WIDE * min(known):
                axes.set_xscale("log")
                axes.minorticks_off()
                ticks = sorted(set(known))[:: -(-len(set(known)) // MOST_TICKS)]
                axes.set_xticks(ticks, [f"{each:g}" for each in ticks])
        if comparisons[0].named:
            legend_above(figure, len(comparisons))

    found = {label: [[of(figures) for _, figures in each] for each in comparisons] for label, of in PANELS.items()}
    shown = {label: rows for label, rows in found.items() if np.isfinite(np.concatenate(rows)).any()}
    write_picture(draw, (3.2 * len(shown), 3.0), *paths)
