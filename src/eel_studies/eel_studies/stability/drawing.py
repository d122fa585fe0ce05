# SPDX-License-Identifier: Apache-2.0
"""The maps as pictures.

Colour is the error relative to the target. A cross marks a stop with a message. A dot marks a warning of a limit of the
model. A plus marks a warning of an open energy ledger.
"""

import numpy as np

from eel_studies.pictures.style import BLACK
from eel_studies.stability.maps import STOPPED, Measured

DECADES = 3.0  # range of the colours, above and below the target


def draw(figure, measured: Measured):
    """Draw one map into an empty matplotlib figure."""
    axes, item = figure.subplots(), measured.map
    size = np.log10(np.maximum(measured.size, 1e-300))
    mesh = axes.pcolormesh(
        _edges(item.x), _edges(item.y), size, cmap="PuOr_r", vmin=-DECADES, vmax=DECADES, edgecolors="none"
    )
    row, column = np.nonzero(measured.outcome == STOPPED)
    if len(row):
        axes.plot(item.x[column], item.y[row], "x", color=BLACK, markersize=5, label="stopped with a message")
    row, column = np.nonzero(measured.limits & (measured.outcome != STOPPED))
    if len(row):
        axes.plot(item.x[column], item.y[row], ".", color=BLACK, markersize=2.5, label="warned: a limit of the model")
    row, column = np.nonzero(measured.warned)
    if len(row):
        axes.plot(item.x[column], item.y[row], "+", color=BLACK, markersize=5, label="warned: energy ledger open")
    if axes.lines:
        figure.legend(loc="outside lower center", frameon=False, ncols=3)
    axes.set(xscale="log", yscale="log", xlabel=item.x_label, ylabel=item.y_label)
    if item.y_names:
        axes.set_yticks(item.y, item.y_names)
        axes.set_yticks([], minor=True)
    axes.set_title(item.title, fontsize="medium")
    bar = figure.colorbar(mesh, ax=axes, extend="both")
    bar.set_label("error / target, log10: accurate below 0")


def draw_condition(figure, conditions):
    """Draw one map of condition numbers into an empty matplotlib figure."""
    axes = figure.subplots()
    mesh = axes.pcolormesh(
        _edges(conditions.x), _edges(conditions.y), np.log10(conditions.value), cmap="cividis", edgecolors="none"
    )
    axes.set(xscale="log", yscale="log", xlabel=conditions.x_label, ylabel=conditions.y_label)
    axes.set_title(conditions.title, fontsize="medium")
    figure.colorbar(mesh, ax=axes).set_label("condition, log10")


def _edges(values: np.ndarray) -> np.ndarray:
    """Borders (n + 1,) of the cells around `values` (n,), which form a geometric sequence."""
    factor = np.sqrt(values[1] / values[0])
    return np.append(values / factor, values[-1] * factor)
