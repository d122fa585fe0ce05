# SPDX-License-Identifier: Apache-2.0
"""`eel identify`: find coefficients of the model from measured swims.

eel identify path.csv --gait turning --first body.lateral_drag=1.5 --first body.nose_drag=0.1 --out fit.png
eel identify speeds.csv --gait straight --first body.lateral_drag=1.5 --noise 0.005
eel identify angles.csv --gait straight --robot my_robot.yaml --first robot.kp=10 --first robot.kd=0.2
eel identify run.nc --first body.lateral_drag=1.5 --out fit.png --out fit.csv
"""

import argparse
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_common.wording import shown
from eel_dynamics.commands.options import add_options, add_repeated, scene_of, set_numbers
from eel_dynamics.model.body.text import body_of
from eel_dynamics.model.robot.robot import robot_of
from eel_dynamics.runs.storage.tables import write_columns

from eel_dynamics import Scene
from eel_gaits import Law
from eel_studies.identification.fit import Identified
from eel_studies.identification.identify import identify
from eel_studies.identification.measured_file import MeasuredFile, read_measured
from eel_studies.identification.measurements import MeasuredAngles, MeasuredPath, MeasuredSpeed, Measurements, count_of
from eel_studies.outputs import checked_outs, write_files
from eel_studies.pictures import BLUE, GREY, ORANGE, Axes, Figure
from eel_studies.points import ROBOT, Gait

NAME = "eel identify"
SIZE = 10.0, 3.4  # inches
MILLI = 1e3


def _add_options(parser: Parser) -> None:
    parser.add_argument(
        "file",
        nargs="+",
        help="a table or .npz with columns time, x, y (perhaps z); or time and a robot's joints; or speed and numbers "
        "of the gait; a run (.nc); a bag. All of one kind",
    )
    about = "a parameter and its first guess: body.FIELD, scene.FIELD, robot.FIELD, initial.v_x, a number of the "
    about += "gait"
    add_repeated(parser, "--first", "NAME=VALUE", about, required=True)
    add_options(
        parser,
        "--gait",
        "--set",
        "--scene",
        "--body",
        "--robot",
        "--accuracy",
        "--out",
        gait=(None, "the law of the run or bag"),
        scene=([], "that of the run; the friction is blended unless it is given here"),
        body=(None, "that of the run, or boyer2010"),
        accuracy=1e-4,
    )
    parser.add_argument("--station", type=float, default=0.0, metavar="X", help="m, of the point that was tracked (0)")
    parser.add_argument("--path", action="store_true", help="fit the robot to the path, not to its joints' angles")
    parser.add_argument("--namespace", metavar="NS", help="of the swimmer in a bag; by default that of the only one")
    parser.add_argument("--noise", type=float, metavar="SIZE", help="standard deviation of the errors, m or m/s")
    parser.add_argument("--level", type=float, default=0.95, help="of the intervals (0.95)")


@command(
    NAME,
    "Find coefficients of the model, with their intervals, from measured paths or steady speeds.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    start, progress = time.perf_counter(), Progress(NAME, "evaluations")
    outs = checked_outs(NAME, options)
    first, numbers = set_numbers(options.first, "--first"), set_numbers(options.set)
    robot, angles = robot_of(options.robot), any(name.startswith(ROBOT) for name in first) and not options.path
    files = [
        read_measured(path, station=options.station, namespace=options.namespace, robot=robot, angles=angles)
        for path in options.file
    ]
    measured = [each for file in files for each in file.measured]
    found = identify(
        first,
        measured,
        gait=_gait(options, files),
        numbers=numbers,
        body=body_of(options.body) if options.body is not None else (robot and robot.body) or _common("body", files),
        scene=_scene(options, files),
        robot=_common("robot", files) if robot is None else robot,
        accuracy=options.accuracy,
        noise=options.noise,
        level=options.level,
        progress=lambda done, _: progress(done, None),
    )
    print(found.table())
    print(f"wall time  {time.perf_counter() - start:.1f} s, {count_of(measured)} measured numbers")
    columns = {"name": found.names, "value": found.value, "standard_error": found.error}
    columns |= {"low": found.low, "high": found.high}
    write_files(outs, partial(write_columns, columns), partial(draw_identified, found=found, measured=measured), SIZE)


def _gait(options: argparse.Namespace, files: list[MeasuredFile]) -> Gait:
    """The gait of the options, or the law in the file."""
    if options.gait is not None:
        return str(options.gait)
    law = files[0].law
    if law is None:
        raise ValueError(f"--gait must be given: {shown(options.file[0])} does not tell how the body was moved")
    if any(each.law != law for each in files):
        raise ValueError("--gait must be given: the files do not have one law")
    if options.set:
        raise ValueError("--set belongs to --gait, which is not given: the law is that of the file")

    def law_of_the_file() -> Law:
        return law

    return law_of_the_file


def _common(name: str, files: list[MeasuredFile]) -> Any:
    """The body or the scene, by its `name`, shared by all files that hold one. `ValueError` if they differ."""
    known = [getattr(file, name) for file in files if getattr(file, name) is not None]
    if any(each != known[0] for each in known[1:]):
        raise ValueError(f"--{name} must be given: the files do not have one {name}")
    return known[0] if known else None


def _scene(options: argparse.Namespace, files: list[MeasuredFile]) -> Scene:
    """The scene of the options, or of the files. The friction is blended unless --scene sets it."""
    scene: Scene | None = None if options.scene else _common("scene", files)
    if scene is None:
        return scene_of(options.scene, Scene(friction="blended"))
    return replace(scene, friction="blended") if scene.friction == "printed" else scene


def draw_identified(figure: Figure, found: Identified, measured: Measurements) -> None:
    """Draw the result `found` from `measured`, in the same order, into an empty matplotlib figure."""
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
