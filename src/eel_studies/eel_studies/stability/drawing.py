# SPDX-License-Identifier: Apache-2.0
"""The maps as pictures. Colour is the error relative to the target; marks tell the other outcomes, and warnings."""

from typing import Any

import numpy as np

from eel_studies.pictures import BLACK, ORANGE
from eel_studies.stability.maps import INACCURATE, REFUSED, SENSITIVE, SILENT, STOPPED, UNCHECKED, Map, Measured

DECADES = 3.0  # range of the colours, above and below the target
MARKS = {  # outcome: mark, size, what it is called
    STOPPED: ("x", 5, "stopped with a message"),
    REFUSED: ("_", 5, "refused"),
    SENSITIVE: ("^", 4, "sensitive, said"),
    INACCURATE: ("+", 5, "inaccurate, said"),
    UNCHECKED: ("1", 5, "no finer run to check by"),
    SILENT: ("*", 9, "WRONG IN SILENCE"),
}


def draw(figure: Any, measured: Measured) -> None:
    """Draw one map into an empty matplotlib figure."""
    item, cells = measured.map, measured.cells
    colours = {"cmap": "PuOr_r", "vmin": -DECADES, "vmax": DECADES}
    axes = draw_map(figure, item, cells["size"], "error / target, log10: accurate below 0", "both", **colours)
    marked = [(cells["outcome"] == outcome, *mark) for outcome, mark in MARKS.items()]
    for where, mark, size, label in (*marked, (cells["limits"], ".", 2.5, "warned: a limit of the model")):
        row, column = np.nonzero(where)
        if len(row):
            colour = ORANGE if mark == "*" else BLACK
            axes.plot(item.x[column], item.y[row], mark, color=colour, markersize=size, label=label)
    if axes.lines:
        figure.legend(loc="outside lower center", frameon=False, ncols=3)
    if item.up.choices:
        axes.set_yticks(item.y, [" ".join(map(str, each)) if isinstance(each, tuple) else each
                                 for each in item.up.choices])  # fmt: skip
        axes.set_yticks([], minor=True)


def draw_map(figure: Any, item: Map, values: np.ndarray, label: str, extend: str = "neither", **colours: Any) -> Any:
    """Draw the decadic logarithms of `values` (len(y), len(x)), and a bar of their colours; returns the axes."""
    axes = figure.subplots()
    size = np.log10(np.maximum(values, 1e-300))
    mesh = axes.pcolormesh(_edges(item.x), _edges(item.y), size, edgecolors="none", **colours)
    axes.set(xscale="log", yscale="log", xlabel=item.across.label, ylabel=item.up.label)
    axes.set_title(item.title, fontsize="medium")
    figure.colorbar(mesh, ax=axes, extend=extend).set_label(label)
    return axes


def _edges(values: np.ndarray) -> np.ndarray:
    """Borders (n + 1,) of the cells around `values` (n,), which form a geometric sequence."""
    factor = np.sqrt(values[1] / values[0])
    return np.append(values / factor, values[-1] * factor)
