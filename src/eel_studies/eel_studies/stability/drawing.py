# SPDX-License-Identifier: Apache-2.0
"""The maps as pictures.

Colour is the error relative to the target. A cross marks a stop with a message. A dot marks a warning of a limit of the
model. A plus marks a warning of an open energy ledger.
"""

from typing import Any

import numpy as np

from eel_studies.pictures import BLACK
from eel_studies.stability.maps import STOPPED, Map, Measured

DECADES = 3.0  # range of the colours, above and below the target


def draw(figure: Any, measured: Measured) -> None:
    """Draw one map into an empty matplotlib figure."""
    item, cells, stopped = measured.map, measured.cells, measured.outcome == STOPPED
    colours = {"cmap": "PuOr_r", "vmin": -DECADES, "vmax": DECADES}
    axes = draw_map(figure, item, cells["size"], "error / target, log10: accurate below 0", "both", **colours)
    for marked, mark, size, label in (
        (stopped, "x", 5, "stopped with a message"),
        (cells["limits"] & ~stopped, ".", 2.5, "warned: a limit of the model"),
        (cells["warned"], "+", 5, "warned: energy ledger open"),
    ):
        row, column = np.nonzero(marked)
        if len(row):
            axes.plot(item.x[column], item.y[row], mark, color=BLACK, markersize=size, label=label)
    if axes.lines:
        figure.legend(loc="outside lower center", frameon=False, ncols=3)
    if item.names:
        axes.set_yticks(item.y, item.names)
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
