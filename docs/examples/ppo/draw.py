# SPDX-License-Identifier: Apache-2.0
"""Draws the learning curves of curves.csv, which train.py has printed: python docs/examples/ppo/draw.py PNG."""

import csv
import sys
from pathlib import Path

from matplotlib.figure import Figure

PANELS = {  # by task: label and bound of the score, scale of the axis
    "heading": ("error of the heading at the end [degrees]", 5.0, "log"),
    "way_points": ("points reached, of 5", 4.0, "linear"),
}

with open(Path(__file__).with_name("curves.csv")) as file:
    rows = list(csv.DictReader(file))
figure = Figure(figsize=(9.0, 3.4), dpi=100, layout="constrained")
for axes, (task, (label, bound, scale)) in zip(figure.subplots(1, 2), PANELS.items(), strict=True):
    for seed in sorted({row["seed"] for row in rows if row["task"] == task}):
        curve = [row for row in rows if row["task"] == task and row["seed"] == seed]
        steps = [float(row["steps"]) for row in curve]
        axes.plot(steps, [float(row["score"]) for row in curve], marker=".", linewidth=1.0, label=f"seed {seed}")
    axes.axhline(bound, color="#888888", linestyle="--", linewidth=1.0)
    axes.set(xlabel="control steps", ylabel=label, yscale=scale, title=f"PPO, defaults: {task.replace('_', ' ')}")
    axes.grid(alpha=0.3)
    axes.legend()
figure.savefig(sys.argv[1])
