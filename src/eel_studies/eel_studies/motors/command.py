# SPDX-License-Identifier: Apache-2.0
"""`eel motors`: check whether a robot's motors follow a gait, and how that depends on one of its numbers.

eel motors eight_servos straight --scene planar=true
eel motors my_robot.urdf straight --servo kp=20 kd=0.5
eel motors eight_servos straight --vary torque_limit=0.3,0.5,1,3 --out limits.png
eel motors passive_tail straight --vary bending_stiffness=0.1,0.3,1 --vary period=0.5,1,2 --out tails.png
eel motors sixteen_servos swim.nc --vary torque_limit=0.3,0.4,0.5        # asked to swim like a run or a bag
"""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.wording import shown
from eel_dynamics.commands.options import add_options, add_repeated, named_texts, set_numbers
from eel_dynamics.model.robot.robot import robot_of

from eel_dynamics import Robot, Run, Swim
from eel_gaits import Law
from eel_studies.motors.motor_figures import Comparison, MotorFigures, comparison, motor_swim, with_number, word_of
from eel_studies.options import add_scene_options, chosen
from eel_studies.outputs import Table, checked_outs, write_files
from eel_studies.pictures import LOOKS, Figure, legend_above, scale_axis
from eel_studies.varied import labelled

NAME = "eel motors"
RECORDED = ".nc", ".mcap", ".db3"
DEMAND = 8  # joints per axis, for the torques of an imposed swim
MOST_VARIED = 2
PANELS: dict[str, Callable[[MotorFigures], float]] = {
    "speed [m/s]": lambda figures: figures.speed,
    "tracking error [%]": lambda figures: 100.0 * figures.tracking_error,
    "energy [J/m]": lambda figures: figures.energy_per_metre,
}
Panels = dict[str, list[list[float]]]  # by panel name: for each comparison, the figures at its values
Varied = tuple[str, Sequence[float | None]]


def _add_options(parser: Parser) -> None:
    parser.add_argument("swimmer", metavar="ROBOT", help="a robot by name, or a .yaml or URDF file")
    add_scene_options(parser, "--robot")
    parser.add_argument(
        "--servo",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=NUMBER",
        help="gains and limits of the servos (fields of Servo); a URDF does not have gains",
    )
    about = "field of joints, servos or tails (robot.PART.FIELD of one), or a number of the gait, and its values"
    about += "; none: without. A second one gives a curve for each of its values"
    add_repeated(parser, "--vary", "FIELD=V1,V2,...", about)
    add_options(parser, "--out")


@command(
    NAME,
    "Swim a robot, and print for each joint in the steady part: the angle that the gait demands, "
    "the servo's error, rate, torque against its limit, and power. With --vary, a row for each value.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    outs = checked_outs(NAME, options)
    if len(options.vary) > MOST_VARIED:
        raise ValueError(f"--vary must be given {MOST_VARIED} times at most, got {len(options.vary)}")
    robot, swim = _robot(options), _swim(options)
    for note in robot.notes:
        print(f"{options.swimmer}: {note}")
    found: list[Comparison] = []
    if options.vary:
        pairs = [(name, _values(name, text)) for name, text in named_texts("--vary", options.vary)]
        found = _compared(robot, swim, *pairs)
        first, tables = found[0].table(), [each.table().rows for each in found]
        table = Table(first.head, [row for rows in tables for row in rows], left=())
        print(table.text())
    elif any(out.suffix != ".csv" for out in outs):
        raise ValueError("--out must end in .csv where nothing is varied")
    else:
        figures = motor_swim(robot, swim)
        table = figures.table()
        print(table.text(), figures.about(), sep="\n\n")
    panels = panels_of(found)
    write_files(outs, table.write_csv, partial(draw, comparisons=found, panels=panels), (3.2 * len(panels), 3.0))


def _compared(robot: Robot, swim: Swim, first: Varied, second: Varied | None = None) -> list[Comparison]:
    """The figures over the values of the `first` name, once for each value of the `second`."""
    if second is None:
        return [comparison(robot, swim, *first)]
    name, values = second
    pairs = [(value, with_number(robot, swim, name, value)) for value in values]
    return [replace(comparison(*each, *first), named=f"{name}={word_of(value)}") for value, each in pairs]


def _swim(options: argparse.Namespace) -> Swim:
    """The swim of a scene or a gait; of a run or a bag its law, body and duration, with a note of its torques."""
    name = options.swim or "straight"
    if Path(name).suffix not in RECORDED and not Path(name).is_dir():
        return chosen(name, options)
    run = Run.load(name) if Path(name).suffix == ".nc" else Run.from_bag(name)
    if not isinstance(run.law, Law) or not run.law.terms:
        raise ValueError(f"{shown(name)}: it holds no law of terms that servos could follow")
    if run.robot is None and run.torque is not None:
        demand = run.actuators(DEMAND)
        axes = {axis: float(getattr(demand, axis).peak["torque"].max()) for axis in ("yaw", "pitch")}
        torques = ", ".join(f"{torque:.3g} N m in {axis}" for axis, torque in axes.items())
        print(f"{name}: the imposed swim takes at most {torques} of {DEMAND} joints an axis\n")
    base = Swim(law=run.law, body=run.body, scene=run.scene, duration=float(run.time[-1]))
    return chosen(base, options)


def _robot(options: argparse.Namespace) -> Robot:
    robot = robot_of(options.swimmer) or Robot.named(options.swimmer)
    gains: dict[str, Any] = dict(set_numbers(options.servo, "--servo"))
    return robot.changed(**gains)


def _values(field: str, text: str) -> list[float | None]:
    try:
        return [None if word.strip() == "none" else float(word) for word in text.split(",")]
    except ValueError:
        raise ValueError(f"--vary must be FIELD=NUMBER,NUMBER,..., got {shown(f'{field}={text}')}") from None


def panels_of(comparisons: Sequence[Comparison]) -> Panels:
    """The `PANELS` with known figures."""
    found = {label: [[of(figures) for _, figures in each] for each in comparisons] for label, of in PANELS.items()}
    return {label: rows for label, rows in found.items() if np.isfinite([*chain(*rows)]).any()}


def draw(figure: Figure, comparisons: Sequence[Comparison], panels: Panels) -> None:
    """Draw a curve for each of the `comparisons` in each of the `panels`, without the value none."""
    for axes, (label, rows) in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels.items(), strict=True):
        for index, (each, row) in enumerate(zip(comparisons, rows, strict=True)):
            colour, dash, mark = LOOKS[index % len(LOOKS)]
            x, y = zip(*((x, y) for x, y in zip(each.values, row, strict=True) if x is not None), strict=True)
            style = {"color": colour, "linestyle": dash, "marker": mark, "markersize": 3.5, "linewidth": 1.2}
            axes.plot(x, y, label=each.named or None, **style)
        axes.set(xlabel=labelled(comparisons[0].field), ylabel=label)
        scale_axis(axes, (value for each in comparisons for value in each.values if value is not None))
    if comparisons[0].named:
        legend_above(figure, len(comparisons))
