# SPDX-License-Identifier: Apache-2.0
"""A picture of each tutorial, from what its Python blocks compute: docs/images/tutorial_NAME.png ."""

import importlib
import os
import re
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from eel_studies.pictures import BLUE, ORANGE, Figure, write_picture

from eel_dynamics import simulate
from eel_gaits import straight

DOCS = Path(__file__).resolve().parents[1] / "docs"
SIZE = (7.0, 2.6)  # inches
Values = dict[str, Any]  # the name space that a page leaves


def values_of(name: str) -> Values:
    """What the Python blocks of a tutorial leave; files that they write go into the working folder."""
    space: Values = {"__name__": "__main__"}
    page = (DOCS / "tutorials" / f"{name}.md").read_text(encoding="utf-8")
    for listing, source in re.findall(r"(<!-- listing[^\n]*\n)?```python\n(.*?)```", page, re.DOTALL):
        if not listing:
            exec(source, space)
    return space


def draw_path(axes: Any, run: Any, **looks: Any) -> None:
    """The head's path from above."""
    axes.plot(run.position[:, 0], run.position[:, 1], **looks)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", "datalim")


def own_gait(figure: Figure, values: Values) -> None:
    """The law of the page over time and body, and the path that it swims."""
    law, path = figure.subplots(1, 2)
    run = values["run"]
    rows = np.array([run.law.curvature(time, run.x)[0][:, 2] for time in run.time])
    bound = np.max(np.abs(rows))
    law.grid(False)
    drawn = law.pcolormesh(run.time, run.x, rows.T, cmap="PuOr", vmin=-bound, vmax=bound, shading="gouraud")
    figure.colorbar(drawn, ax=law, label="$K_3$ [rad/m]")
    law.set(xlabel="time [s]", ylabel="X [m], nose to tail")
    law.invert_yaxis()
    draw_path(path, run, color=BLUE)


def own_controller(figure: Figure, values: Values) -> None:
    """The heading and the depth that the controller of the page reaches."""
    rows = ("headings", 0.6, "heading [rad]"), ("depths", 0.3, "depth [m]")
    for axes, (name, goal, label) in zip(figure.subplots(1, 2), rows, strict=True):
        axes.plot(0.02 * np.arange(len(values[name])), values[name], color=BLUE, label="swimmer")
        axes.axhline(goal, color=ORANGE, linestyle=(0, (4, 2)), label="goal")
        axes.set(xlabel="time [s]", ylabel=label)
        axes.legend()
        axes.margins(x=0.0)


def own_body(figure: Figure, values: Values) -> None:
    """The body of the page from the side and from above, and its swim."""
    shape, path = figure.subplots(1, 2)
    body, x = values["body"], np.linspace(0.0, 0.8, 300)
    for shift, half, name in ((0.06, body.half_height(x), "from the side"), (-0.06, body.half_width(x), "from above")):
        shape.fill_between(x, shift - half, shift + half, alpha=0.7, label=name)
    shape.set(xlabel="X [m], nose to tail", ylabel="[m]", ylim=(-0.12, 0.2))
    shape.set_aspect("equal")
    shape.legend(loc="upper right", ncols=2)
    draw_path(path, values["run"], color=BLUE)


def bag_to_figure(figure: Figure, values: Values) -> None:
    """What the page draws from a bag."""
    for axes, drawn in zip(figure.subplots(2, 1, sharex=True), values["figure"].axes, strict=True):
        (line,) = drawn.get_lines()
        axes.plot(*line.get_data(), color=BLUE)
        axes.set_ylabel(drawn.get_ylabel().replace(" [", "\n["))
    axes.set_xlabel("time [s]")


def motors(figure: Figure, values: Values) -> None:
    """The servos' error and the speed of the page's robot over the limit of its motors."""
    found = list(values["limits"])
    errors, speeds = [100.0 * each.tracking_error for _, each in found], [each.speed for _, each in found]
    labelled = ("tracking error [%]", errors), ("speed [m/s]", speeds)
    for axes, (label, row) in zip(figure.subplots(1, 2), labelled, strict=True):
        axes.semilogx([limit for limit, _ in found], row, marker="o", color=BLUE, clip_on=False)
        axes.set(xlabel="torque limit [N m]", ylabel=label, ylim=(0.0, None))
        axes.margins(x=0.0)


TUTORIALS: dict[str, Callable[..., None]] = {
    "own_gait": own_gait,
    "own_controller": own_controller,
    "own_body": own_body,
    "motors": motors,
    "bag_to_figure": bag_to_figure,
}


def main() -> int:
    mpl.use("Agg")
    sys.path.append(str(DOCS.parent / "test"))
    write_bag = importlib.import_module("test_run_from_bag").write_bag

    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("docs").symlink_to(DOCS)
        write_bag(Path("bag"), simulate(straight(period=0.8), 10.0, sample_period=0.02, load=True))
        for name, draw in TUTORIALS.items():
            path = DOCS / "images" / f"tutorial_{name}.png"
            write_picture(partial(draw, values=values_of(name)), SIZE, path)
            print(path.relative_to(DOCS.parent))
    return 0


if __name__ == "__main__":
    sys.exit(main())
