# SPDX-License-Identifier: Apache-2.0
"""`eel motors`: whether a robot's motors follow a gait, and how that depends on one of its numbers.

eel motors eight_servos straight --scene planar=true
eel motors my_robot.urdf straight --servo kp=20 kd=0.5
eel motors eight_servos straight --vary torque_limit=0.3,0.5,1,3
"""

import argparse
from pathlib import Path
from typing import Any

from eel_base.command.command_line import Parser
from eel_base.command.run_command import checked_out, run_command
from eel_base.files.output_file import written_as
from eel_base.wording import shown
from eel_dynamics.commands.options import named_texts
from eel_model.robot.actuators import Servo
from eel_model.robot.robot import Robot

from eel_studies.motors.motor_figures import comparison, motor_swim
from eel_studies.scene_options import add_scene_options, swim_from

NAME = "eel motors"


def main(arguments: list[str] | None = None) -> int:
    """Exit status as of `run_command`."""
    return run_command(_parser(), _motors, arguments)


def _motors(options: argparse.Namespace) -> int:
    out = None if options.out is None else checked_out(NAME, options.out, (".csv",))
    robot, swim = _robot(options), swim_from(options.swim or "straight", options)
    for note in robot.notes:
        print(f"{options.robot}: {note}")
    if options.vary:
        (field, text), *_ = named_texts("--vary", [options.vary])
        table = comparison(robot, swim, field, _values(field, text)).table()
        print(table.text())
    else:
        figures = motor_swim(robot, swim)
        table = figures.table()
        print(table.text(), figures.about(), sep="\n\n")
    if out is not None:
        table.write_csv(Path(out))
        print(f"written to {written_as(out)}")
    return 0


def _robot(options: argparse.Namespace) -> Robot:
    gains: dict[str, Any] = {name: float(text) for name, text in named_texts("--servo", options.servo)}
    if Path(options.robot).suffix:
        return Robot.from_file(options.robot, Servo(**gains) if gains else None)
    robot = Robot.named(options.robot)
    return robot.changed(**gains)


def _values(field: str, text: str) -> list[float | None]:
    try:
        return [None if word.strip() == "none" else float(word) for word in text.split(",")]
    except ValueError:
        raise ValueError(f"--vary must be FIELD=NUMBER,NUMBER,..., got {shown(f'{field}={text}')}") from None


def _parser() -> Parser:
    parser = Parser(
        prog=NAME,
        description="Swim a robot, and print what each joint does in the steady part: the angle that the gait asks "
        "for, the servo's error, rate, torque against its limit, and power. With --vary a row for each value.",
    )
    parser.add_argument("robot", metavar="ROBOT", help="a robot by name, or a .yaml or URDF file")
    add_scene_options(parser)
    parser.add_argument(
        "--servo",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=NUMBER",
        help="gains and limits of the servos (fields of Servo); a URDF does not have gains",
    )
    parser.add_argument(
        "--vary", metavar="FIELD=V1,V2,...", help="field of joints, servos or tails, and its values; none: without"
    )
    parser.add_argument("-o", "--out", metavar="FILE.csv", help="where to write the table")
    return parser
