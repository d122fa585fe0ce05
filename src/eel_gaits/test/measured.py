# SPDX-License-Identifier: Apache-2.0
"""Motions as a laboratory would measure them: files of midlines, curvature and joint angles, with noise."""

import csv

import numpy as np

FINE = np.linspace(0.0, 1.0, 801)


def midline_of(law, time, points):
    """Positions (n, 2) [m] on the midline of `law` at `time` [s], at the arc lengths `points` (n,) [m]."""
    bend = law.curvature(time, FINE)[0][:, 2]
    angle = _integral(bend)
    along = np.stack([_integral(np.cos(angle)), _integral(np.sin(angle))], axis=1)
    return np.stack([np.interp(points, FINE, each) for each in along.T], axis=1)


def moved(points, time):
    """The points (n, 2) after a rigid motion: the fish swims on and turns."""
    turn = 0.3 * np.sin(2.0 * np.pi * time) + 0.1 * time
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    return points @ rotation.T + np.array([-0.4 * time, 0.05 * time**2])


def write(path, names, rows):
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows(rows)
    return path


def write_midlines(path, position_at, *, end, rate=50.0, points=21, noise=0.0, seed=0):
    """A file of midlines: position_at(time, arc lengths) gives them, moved rigidly, with normal `noise` [m]."""
    draw, arc = np.random.default_rng(seed), np.linspace(0.0, 1.0, points)
    rows = []
    for time in np.arange(round(end * rate) + 1) / rate:
        place = moved(position_at(time, arc), time) + noise * draw.normal(size=(points, 2))
        rows += [(time, x, *each) for x, each in zip(arc, place.tolist(), strict=True)]
    return write(path, ("time", "arc_length", "x", "y"), rows)


def _integral(values):
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(FINE)
    return np.concatenate(([0.0], np.cumsum(steps)))
