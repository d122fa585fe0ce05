# SPDX-License-Identifier: Apache-2.0
"""`eel compare`: draw two runs, files or gaits, and print the measures of both.

eel compare straight turning --out pair.rrd
eel compare before.nc after.nc --out pair.png
eel compare measured.nc straight          # the gait swims in the body, scene and time of the file
"""

import argparse
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.command.command import checked_out, command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_common.files.output_file import written_as
from eel_common.wording import bring_viz
from eel_dynamics.analysis.measures import MEASURES, measures_of
from eel_dynamics.commands.options import add_options, scene_of, set_numbers
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.text import body_of
from eel_dynamics.runs.settled_duration import until_settled

from eel_dynamics import Run, Scene, simulate
from eel_gaits import gait
from eel_studies.outputs import Table
from eel_studies.pictures import BLUE, ORANGE, PICTURES, Figure, legend_above, write_picture

NAME = "eel compare"
DURATION = 10.0  # s, default duration of two gaits
SIZE = 6.8, 6.4  # inches
STYLES: tuple[dict[str, Any], ...] = ({"color": BLUE}, {"color": ORANGE, "linestyle": (0, (4, 2))})


def _add_options(parser: Parser) -> None:
    for name in ("first", "second"):
        parser.add_argument(name, metavar="RUN", help="a run (.nc, of eel simulate --out), or a gait")
    add_options(
        parser, "--set", "--duration", "--accuracy", "--bare", "--body", "--scene",
        duration=(None, f"of a file, or {DURATION:g}"), body=(None, "of a file, or boyer2010"),
    )  # fmt: skip
    parser.add_argument(
        "-o", "--out", metavar="FILE", help=".rrd: for Rerun's viewer (needs eel_viz); .png, .svg, .pdf"
    )


@command(
    NAME,
    "Draw two runs in one picture, and print the measures of both with their difference. A gait "
    "beside a file swims with the body, scene and duration of the file.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    out = None if options.out is None else checked_out(NAME, options.out, (".rrd", *PICTURES))
    if out is not None and out.suffix == ".rrd" and None in map(find_spec, ("eel_viz", "rerun")):
        raise ValueError(f"--out .rrd needs eel_viz and rerun-sdk: {bring_viz()}")
    loaded = [Run.load(name) if Path(name).suffix == ".nc" else None for name in (options.first, options.second)]
    like = loaded[0] or loaded[1]
    names = [Path(options.first).stem, Path(options.second).stem]
    first, second = (run or _swum(options, name, like) for run, name in zip(loaded, names, strict=True))
    print(table_of(first, second, names))
    if out is not None:
        if out.suffix == ".rrd":
            first.to_rerun(out, compare=second)
        else:
            write_picture(lambda figure: draw(figure, (first, second), names), SIZE, out)
        print(f"written to {written_as(out)}")


def _swum(options: argparse.Namespace, name: str, like: Run | None) -> Run:
    """The run of the gait `name`. Without an option, the settings are those of the run `like`, if given."""
    body, scene, duration = Body.boyer2010(), Scene(), DURATION
    if like is not None:
        body, scene, duration = like.body, like.scene, float(like.time[-1])
    if options.duration is not None:
        duration = options.duration
    progress = Progress(NAME, f"simulated s of {name}")
    return simulate(
        gait(name, **set_numbers(options.set)),
        duration,
        body=body if options.body is None else body_of(options.body),
        scene=scene_of(options.scene) if options.scene else scene,
        accuracy=options.accuracy,
        estimate=not options.bare,
        progress=lambda reached, left: progress(float(f"{reached:.5g}"), None if until_settled(duration) else duration),
    )


def table_of(first: Run, second: Run, names: list[str]) -> str:
    """The measures of either run, and the second's difference from the first, relative to the first."""
    rows = []
    one, two = measures_of(first), measures_of(second)
    for name, (unit, *_) in MEASURES.items():
        if np.isnan(one[name]) and np.isnan(two[name]):
            continue
        change = two[name] - one[name]
        relative = f"{change / abs(one[name]):+.2%}" if one[name] and np.isfinite(change) else ""
        rows.append((name, f"{one[name]:.5g}", f"{two[name]:.5g}", f"{change:.3g}", relative, unit))
    return Table(("", *names, "difference", "", ""), rows, left=(0, 5)).text()


def draw(figure: Figure, runs: tuple[Run, Run], names: list[str]) -> None:
    """Draw the paths of both heads from above, and their speeds and greatest torques over time."""
    path, speed, torque = figure.subplots(3, 1, height_ratios=(2, 1, 1))
    for run, name, style in zip(runs, names, STYLES, strict=True):
        path.plot(run.position[:, 0], run.position[:, 1], label=name, **style)
        speed.plot(run.time, np.linalg.norm(run.twist[:, 3:], axis=1), **style)
        if run.torque is not None:
            torque.plot(run.time, np.linalg.norm(run.torque, axis=2).max(axis=1), **style)
    path.set(xlabel="x of the head [m]", ylabel="y [m]")
    path.set_aspect("equal", adjustable="datalim")
    speed.set(ylabel="head's speed [m/s]")
    torque.set(xlabel="time [s]", ylabel="most torque [N m]")
    speed.margins(x=0.0)
    torque.margins(x=0.0)
    legend_above(figure)
