# SPDX-License-Identifier: Apache-2.0
"""What was identified, as a picture: measurements and the swims that were found, residuals, and intervals."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from eel_studies.identification.fit import Identified
from eel_studies.identification.measurements import MeasuredAngles, MeasuredPath, MeasuredSpeed, Measurements
from eel_studies.pictures import BLUE, GREY, ORANGE, Axes, Figure

FORMATS = ".png", ".svg"
SIZE = 10.0, 3.4  # inches
MILLI = 1e3


def draw_identified(figure: Figure, found: Identified, measured: Measurements) -> None:
    """Draw what was `found` of `measured`, in that order, into an empty matplotlib figure."""
    left, middle, right = figure.subplots(1, 3)
    draw = {MeasuredPath: _draw_paths, MeasuredAngles: _draw_angles, MeasuredSpeed: _draw_speeds}[type(measured[0])]
    middle.set(xlabel="t [s]", title="residuals")
    draw(left, middle, found, measured)
    _draw_intervals(right, found)


def _draw_paths(left: Axes, middle: Axes, found: Identified, measured: Sequence[Any]) -> None:
    for each, residual in zip(measured, found.residuals, strict=True):
        fitted = each.position[:, : residual.shape[1]] - residual
        left.plot(*each.position[:, :2].T, ".", color=GREY, markersize=3, label="measured")
        left.plot(*fitted[:, :2].T, color=BLUE, linewidth=1.2, label="of the swim found")
        for name, values, colour in zip("xyz", residual.T, (BLUE, ORANGE, GREY), strict=False):
            middle.plot(each.time, MILLI * values, ".-", color=colour, linewidth=0.6, markersize=3, label=name)
    left.set(xlabel="x [m]", ylabel="y [m]", title="path")
    left.set_aspect("equal", adjustable="datalim")
    middle.set_ylabel("measured less found [mm]")
    for axes in (left, middle):
        handles: dict[str, Any] = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
        axes.legend(handles.values(), handles.keys())


def _draw_angles(left: Axes, middle: Axes, found: Identified, measured: Sequence[Any]) -> None:
    for each, residual in zip(measured, found.residuals, strict=True):
        left.plot(each.time, each.angles, ".", color=GREY, markersize=2)
        left.plot(each.time, each.angles - residual, color=BLUE, linewidth=0.8)
        middle.plot(each.time, MILLI * residual, linewidth=0.8)
    left.set(xlabel="t [s]", ylabel="angle [rad]", title="joints: measured (dots), of the swim found")
    middle.set_ylabel("measured less found [mrad]")


def _draw_speeds(left: Axes, middle: Axes, found: Identified, measured: Sequence[Any]) -> None:
    speed, residual = np.array([each.speed for each in measured]), np.concatenate(found.residuals)
    swim = np.arange(1, len(speed) + 1)
    left.plot(swim, speed, "o", color=GREY, label="measured")
    left.plot(swim, speed - residual, "x", color=BLUE, label="of the swim found")
    left.set(xlabel="swim", ylabel="speed [m/s]", title="speeds", ylim=(0.0, None))
    left.legend()
    middle.axhline(0.0, color=GREY, linewidth=0.8)
    middle.plot(swim, MILLI * residual, "o", color=BLUE)
    middle.set(xlabel="swim", ylabel="measured less found [mm/s]")
    for axes in (left, middle):
        axes.set_xticks(swim if len(swim) <= 12 else axes.get_xticks())


def _draw_intervals(axes: Axes, found: Identified) -> None:
    """Each parameter, relative to its value."""
    row = np.arange(len(found.names))
    size = np.where(found.value, np.abs(found.value), 1.0)
    low, high = 100.0 * (found.value - found.low) / size, 100.0 * (found.high - found.value) / size
    axes.errorbar(np.zeros(len(row)), row, xerr=(low, high), fmt="o", color=BLUE, capsize=4)
    labels = [f"{name}\n{value:.4g}" for name, value in zip(found.names, found.value, strict=True)]
    axes.set_yticks(row, labels)
    axes.set(xlabel="% of the value", title=f"{100.0 * found.level:.4g} % intervals", ylim=(len(row) - 0.5, -0.5))
    axes.grid(False, axis="y")
