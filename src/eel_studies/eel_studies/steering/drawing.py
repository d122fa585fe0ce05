# SPDX-License-Identifier: Apache-2.0
"""The multipliers over the metacentric height as a picture."""

import numpy as np

from eel_studies.pictures import BLUE, GREY, LOOKS, Axes, Figure
from eel_studies.steering.linearisation import OUT_OF_PLANE, STATES
from eel_studies.steering.study import Scan

SIZE = 9.0, 4.0  # inches


def draw_multipliers(figure: Figure, scans: list[Scan]) -> None:
    """On the left the magnitudes of all multipliers of the first of the `scans`, on the right the greatest of each."""
    left, right = figure.subplots(1, 2)
    _draw_all(left, scans[0])
    for scan, (colour, dash, _) in zip(scans, LOOKS, strict=True):
        right.plot(1e3 * scan.heights, scan.growth, color=colour, linestyle=dash, label=scan.name)
    right.set(ylabel="greatest growth in a period", yscale="log")
    right.set_yticks([1.0, 1.5, 2.0, 3.0, 4.0], ["1", "1.5", "2", "3", "4"])
    right.set_yticks([], minor=True)
    right.legend(frameon=False)
    for axes in (left, right):
        axes.axhline(1.0, color=GREY, linewidth=0.8)
        axes.set_xlabel("metacentric height [mm]")
        axes.grid(alpha=0.3)
        axes.margins(x=0.02)


def _draw_all(axes: Axes, scan: Scan) -> None:
    rows = [STATES.index(name) for name in OUT_OF_PLANE]
    for in_plane, colour, mark, label in (
        (False, BLUE, "o", "roll, pitch, vertical"),
        (True, GREY, "s", "in the plane"),
    ):
        points = np.array(
            [
                (1e3 * height, abs(each.multipliers[mode]))
                for height, each in zip(scan.heights, scan.found, strict=True)
                for mode in range(len(STATES))
                if (each.participation[rows, mode].sum() < 0.5) == in_plane
            ]
        )
        axes.plot(*points.T, mark, color=colour, markersize=2.5, label=label)
    axes.set(ylabel="magnitude of the multipliers", ylim=(0.0, None))
    axes.set_title(scan.name, fontsize="medium")
    axes.legend(frameon=False)
