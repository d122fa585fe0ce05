# SPDX-License-Identifier: Apache-2.0
"""The picture of evidence/robot_log.py; with points that a camera saw, both motions one above the other."""

import itertools
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from eel_common.files.tables import read_table
from eel_common.files.times import time_of
from eel_studies.pictures import BLACK, BLUE, PALE_BLUE, Axes, Figure, along_way, legend_above

from studied.band import Replayed

SHOWN = 6  # instants of the points that are drawn
SHIFTS = 64  # of the log's time that are tried, to lay the computed beat beside the filmed one


@dataclass(frozen=True)
class Seen:
    """Points on a swimmer that a camera saw at N instants, in any order: its lights, say."""

    time: np.ndarray  # (N,) s, from 0
    points: list[np.ndarray]  # (n, 2) m each

    @classmethod
    def of_file(cls, path: Path) -> "Seen":
        """From columns of time, x and y. `ValueError` for others."""
        table = read_table(path)
        time, rows = time_of(table), np.column_stack((table.column("x", "m"), table.column("y", "m")))
        instants = np.unique(time)
        if len(instants) < 3:
            raise table.error(f"points must be of 3 instants or more, got {len(instants)}")
        return cls(instants - instants[0], [rows[time == each] for each in instants])

    @property
    def velocity(self) -> np.ndarray:
        """(2,) m/s, slope of the points' mean over time."""
        means = np.array([each.mean(axis=0) for each in self.points])
        return np.asarray(np.polyfit(self.time, means, 1)[0])

    @property
    def speed(self) -> float:
        """Its size [m/s]."""
        return float(np.linalg.norm(self.velocity))


def draw(
    figure: Figure, first: Replayed, drawn: list[Replayed], columns: dict[str, np.ndarray], seen: Seen | None
) -> None:
    """Path of the centre of mass or midlines beside what was seen; speed, and the torque of the middle joint."""
    panels = figure.subplots(3, 1, height_ratios=(1.4, 1.0, 1.0))
    if seen is None:
        for each in drawn:
            panels[0].plot(*each.run.center_of_mass[:, :2].T, color=PALE_BLUE, linewidth=0.8)
        panels[0].plot(*first.run.center_of_mass[:, :2].T, color=BLUE, label="computed")
    else:
        draw_midlines(panels[0], first, seen)
    panels[0].set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    middle = f"torque_{len(first.joints) // 2 + 1}"
    for axes, name, label in ((panels[1], "speed", "speed [m/s]"), (panels[2], middle, f"{middle} [N m]")):
        low, high = columns[f"{name}_low"], columns[f"{name}_high"]
        axes.fill_between(columns["time"], low, high, color=PALE_BLUE, label="band")
        axes.plot(columns["time"], columns[name], color=BLUE, label="computed")
        axes.set(xlabel="time [s]", ylabel=label)
        axes.margins(x=0.0)
    if seen is not None:
        panels[1].axhline(seen.speed, color=BLACK, linestyle=(0, (4, 2)), label="measured")
    legend_above(figure, 3)


def draw_midlines(axes: Axes, first: Replayed, seen: Seen) -> None:
    """Points as seen, and the computed midlines at the same times; both begin together and head the same way.

    When in the beat the camera began is not known, nor whether it looked from above: the time and the side are those at
    which the shapes fit best.
    """
    run = first.run
    assert run.backbone is not None  # the run has stations
    way = [along_way(each - seen.points[0].mean(axis=0), seen.velocity) for each in seen.points]
    best, lines = np.inf, [way[0]]
    later = run.time > 0.5 * run.time[-1]
    ahead = np.polyfit(run.time[later], run.center_of_mass[later, :2], 1)[0]
    last = run.time[-1] - seen.time[min(SHOWN, len(seen.time)) - 1]
    for start, side in itertools.product(np.linspace(0.5 * run.time[-1], last, SHIFTS), (1.0, -1.0)):
        places = [int(np.argmin(np.abs(run.time - start - each))) for each in seen.time[:SHOWN]]
        found = [run.backbone[place][:, :2] for place in places]
        found = [along_way(each - found[0].mean(axis=0), ahead) * (1.0, side) for each in found]
        apart = [_distance(a - a.mean(axis=0), b - b.mean(axis=0)) for a, b in zip(way, found, strict=False)]
        if (total := float(np.mean(apart))) < best:
            best, lines = total, found
    for place, (points, line) in enumerate(zip(way[:SHOWN], lines, strict=False)):
        down = -0.35 * place * np.ptp(lines[0][:, 0])
        axes.plot(line[:, 0], line[:, 1] + down, color=BLUE, label="computed")
        axes.plot(points[:, 0], points[:, 1] + down, ".", color=BLACK, label="seen")


def _distance(points: np.ndarray, line: np.ndarray) -> float:
    """Mean distance of the points from the nearest of the line."""
    return float(np.mean(np.min(np.linalg.norm(points[:, None] - line[None], axis=2), axis=1)))
