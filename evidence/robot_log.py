# SPDX-License-Identifier: Apache-2.0
"""`python evidence/robot_log.py`: swim by the log of a robot's joints, with bands.

python evidence/robot_log.py log.csv --links 0.18x9 --section 0.055,0.05 --joint-drag 0.65 --mass 7.2
python evidence/robot_log.py amphibot.csv --columns 8-13 --units deg --links 0.094x7 --section 0.03,0.02 --joint-drag 0
python evidence/robot_log.py bag/ --topic joint_states --body robot.csv --links 0.2,0.1,0.1,0.2 --out path.png
"""

import argparse
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_dynamics.commands.logged import add_joint_options, logged_robot
from eel_dynamics.commands.options import add_options, add_repeated, scene_of, set_numbers
from eel_dynamics.runs.storage.tables import write_columns
from eel_studies.options import ranges_of
from eel_studies.outputs import Table, checked_outs, write_files
from studied.band import UNCERTAIN, Replayed, replay, with_factors
from studied.seen import Seen, draw

from eel_dynamics import Scene

NAME = "robot_log.py"


def _add_options(parser: Parser) -> None:
    ranges = ", ".join(f"{name}={low:g}:{high:g}" for name, (low, high) in UNCERTAIN.items())
    parser.add_argument("file", metavar="LOG", help=".csv, or a bag (folder, .mcap, .db3) with sensor_msgs/JointState")
    parser.add_argument("--units", metavar="UNIT", help="rad or deg (as the columns' names say, or rad)")
    parser.add_argument("--time", default="", metavar="COLUMN", help="of times in a table, by its name or number")
    add_joint_options(parser)
    add_options(parser, "--body", "--scene", "--duration", "--accuracy", "--out", body=(None, "or --section"),
                duration=(None, "all of the log"), accuracy="1e-3")  # fmt: skip
    add_repeated(parser, "--set", "NAME=VALUE", "a number of the body")
    add_repeated(parser, "--vary", "NAME=LOW:HIGH", f"factors of a number that is uncertain, in place of {ranges}")
    parser.add_argument("--samples", type=int, default=32, metavar="N", help="bodies of the band (32)")
    parser.add_argument(
        "--seen", metavar="FILE", help="points that a camera saw: .csv with time_s, x_m, y_m, unordered"
    )
    parser.add_argument("--speed", type=float, metavar="M/S", help="as measured, to stand beside ours")


@command(
    NAME,
    "Swim by the joint angles in a robot's log. Path, speed and torques come with a band from what is "
    "uncertain: bodies whose numbers lie anywhere in their ranges.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    outs = checked_outs(NAME, options)
    seen = None if options.seen is None else Seen.of_file(Path(options.seen))
    if seen and options.speed is not None:
        raise ValueError("--seen gives the measured speed: leave out --speed")
    robot = logged_robot(options.file, options)
    law, joints = robot.law, robot.joints
    body = with_factors(robot.body, {}).changed(**set_numbers(options.set))
    if options.mass is not None:
        body = body.changed(density=options.mass / body.volume)
    scene = scene_of(options.scene, Scene(planar=True, friction="blended"))
    first, alone, drawn = replay(
        law, body, joints, scene, uncertain=ranges_of("--vary", options.vary) or None, samples=options.samples,
        duration=options.duration, accuracy=options.accuracy,
    )  # fmt: skip
    print(*replace(robot, body=body).about(), sep="\n")
    print(table_of(first, drawn, seen.speed if seen else options.speed).text())
    if alone:
        print(effects_of(first, alone).text())
    columns = columns_of(first, drawn)
    picture = partial(draw, first=first, drawn=drawn, columns=columns, seen=seen)
    write_files(outs, partial(write_columns, columns), picture, (6.8, 7.0))


def table_of(first: Replayed, drawn: list[Replayed], measured: float | None) -> Table:
    """Figures of the first swim, and between which the drawn ones lie."""
    figures, others = first.figures, [each.figures for each in drawn]
    rows = []
    for place, (name, value) in enumerate(figures.items()):
        all_of_them = [value, *(each[name] for each in others)]
        rows.append([name, f"{value:.4g}", f"{min(all_of_them):.4g} to {max(all_of_them):.4g}", ""])
        if place == 0 and measured is not None:
            low, high = (end / measured - 1.0 for end in (min(all_of_them), max(all_of_them)))
            rows[-1][-1] = f"{measured:.4g}: {value / measured - 1.0:+.0%}, band {low:+.0%} to {high:+.0%}"
    return Table(("", "ours", f"band of {len(drawn)} bodies", "measured"), rows)


def effects_of(first: Replayed, alone: dict[str, tuple[Replayed | None, Replayed | None]]) -> Table:
    """What each uncertain number does to the speed, alone, at its two ends."""

    def cell(end: Replayed | None) -> str:
        return "stops" if end is None else f"{end.speed / first.speed - 1.0:+.1%}"

    rows = [(name, *(cell(end) for end in ends)) for name, ends in alone.items()]
    return Table(("speed, one number at an end of its range", "low", "high"), rows)


def columns_of(first: Replayed, drawn: list[Replayed]) -> dict[str, np.ndarray]:
    """Columns over time: the head, the centre of mass and the torques, each with its band."""
    series = [_series(each) for each in (first, *drawn)]
    found = {"time": first.run.time}
    for name, values in series[0].items():
        all_of_them = np.array([each[name] for each in series])
        found |= {name: values, f"{name}_low": all_of_them.min(axis=0), f"{name}_high": all_of_them.max(axis=0)}
    return found


def _series(swim: Replayed) -> dict[str, np.ndarray]:
    run = swim.run
    speed = np.linalg.norm(np.gradient(run.center_of_mass, run.time, axis=0), axis=1)
    found = {"x": run.position[:, 0], "y": run.position[:, 1], "speed": speed}
    return found | {f"torque_{place + 1}": each for place, each in enumerate(swim.torque.T)}


if __name__ == "__main__":
    sys.exit(main())
