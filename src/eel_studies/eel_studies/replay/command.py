# SPDX-License-Identifier: Apache-2.0
"""`eel replay-joints`: swim by the log of a robot's joints, with bands.

eel replay-joints log.csv --links 0.18x9 --section 0.055,0.05 --mass 7.2
eel replay-joints amphibot.csv --columns 8-13 --units deg --links 0.094x7 --section 0.0275,0.0165 --seen leds.csv
eel replay-joints bag/ --topic joint_states --body robot.csv --links 0.2,0.1,0.1,0.2 --out path.csv --out path.png
"""

import argparse
from functools import partial
from pathlib import Path

import numpy as np
from eel_base.command.command import command
from eel_base.command.command_line import Parser
from eel_base.quantity import positive
from eel_base.wording import shown
from eel_dynamics.commands.options import add_options, add_repeated, scene_of, set_numbers
from eel_dynamics.runs.exchange.eel_viz_functions import function_of_eel_viz
from eel_dynamics.runs.storage.tables import write_columns
from eel_gaits.sources.joint_log import JointLog, joint_log, law_of_links, read_joint_log
from eel_model.body.body import Body, body_of

from eel_dynamics import Scene
from eel_studies.options import ranges_of
from eel_studies.outputs import Table, checked_outs, write_files
from eel_studies.replay.band import UNCERTAIN, Replayed, replay, robot_body, with_factors
from eel_studies.replay.drawing import Seen, draw

NAME = "eel replay-joints"
FITTING = 1e-6  # part of the length by which the links' sum may miss the body's


def _add_options(parser: Parser) -> None:
    ranges = ", ".join(f"{name}={low:g}:{high:g}" for name, (low, high) in UNCERTAIN.items())
    parser.add_argument("file", metavar="LOG", help=".csv, or a bag (folder, .mcap, .db3) with sensor_msgs/JointState")
    parser.add_argument("--columns", default="", metavar="WHICH", help='joints of a .csv: "8-13", names, "*Fbck*"')
    parser.add_argument("--units", default="", metavar="UNIT", help="rad or deg (as the columns' names say, or rad)")
    parser.add_argument("--topic", metavar="TOPIC", help="of a bag with several of them")
    parser.add_argument("--tail-first", action="store_true", help="the first joint is that at the tail")
    parser.add_argument(
        "--links", required=True, metavar="LENGTHS", help="m, from nose to tail: 0.18x9, or 0.2,0.1x5,0.2"
    )
    parser.add_argument("--section", metavar="A,B", help="m, half-height and half-width of all links")
    add_options(parser, "--body", "--scene", "--duration", "--accuracy", "--out", body=(None, "or --section"),
                duration=(None, "all of the log"), accuracy="1e-3")  # fmt: skip
    parser.add_argument("--mass", type=float, metavar="KG", help="(that of the water in the body's place)")
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
    log = _log(options)
    links = _links(options.links, log.angles.shape[1])
    body = _body(options, float(links.sum()))
    joints = np.cumsum(links)[:-1]
    law = law_of_links(log, joints, body.length)
    scene = scene_of(options.scene, Scene(planar=True, friction="blended"))
    first, alone, drawn = replay(
        law, body, joints, scene, uncertain=ranges_of("--vary", options.vary) or None, samples=options.samples,
        duration=options.duration, accuracy=options.accuracy,
    )  # fmt: skip
    print(law.about, *log.notes, sep="\n")
    print(f"{len(links)} links, {body.length:.4g} m, {body.mass:.4g} kg, {body.volume * 1e3:.4g} l")
    print(table_of(first, drawn, seen.speed if seen else options.speed).text())
    if alone:
        print(effects_of(first, alone).text())
    columns = columns_of(first, drawn)
    picture = partial(draw, first=first, drawn=drawn, columns=columns, seen=seen)
    write_files(outs, partial(write_columns, columns), picture, (6.8, 7.0))


def _log(options: argparse.Namespace) -> JointLog:
    path = Path(options.file)
    if path.is_dir() or path.suffix in (".mcap", ".db3"):
        if options.columns:
            raise ValueError("--columns belong to a .csv file; joints of a bag have names")
        time, angles, names = function_of_eel_viz("joints")(path, options.topic)
        return joint_log(path.name, time, angles, tuple(names), unit=options.units, tail_first=options.tail_first)
    if options.topic is not None:
        raise ValueError("--topic belongs to a bag")
    return read_joint_log(path, columns=options.columns, unit=options.units, tail_first=options.tail_first)


def _links(text: str, joints: int) -> np.ndarray:
    """Lengths [m] of the links, from nose to tail: one more than joints."""
    found: list[float] = []
    for part in text.split(","):
        length, _, count = part.partition("x")
        try:
            found += [float(length)] * int(count or 1)
        except ValueError:
            raise ValueError(
                f"--links must be lengths such as 0.18x9 or 0.2,0.1x5,0.2 [m], got {shown(text)}"
            ) from None
    if len(found) != joints + 1:
        raise ValueError(f"--links must be {joints + 1} lengths for {joints} joints, got {len(found)}")
    return np.array([positive("link", each, "m") for each in found])


def _body(options: argparse.Namespace, length: float) -> Body:
    if (options.body is None) == (options.section is None):
        raise ValueError("one of --body and --section must be given")
    if options.section is not None:
        try:
            half_height, half_width = map(float, options.section.split(","))
        except ValueError:
            raise ValueError(f"--section must be half-height,half-width [m], got {shown(options.section)}") from None
        body = robot_body(length, half_height, half_width)
    else:
        body = body_of(options.body)
        if abs(body.length - length) > FITTING * length:
            raise ValueError(f"--links must add up to the body's length, {body.length:g} m, got {length:g} m")
    body = with_factors(body, {})
    body = body.changed(**set_numbers(options.set))
    return body if options.mass is None else body.changed(density=positive("mass", options.mass, "kg") / body.volume)


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
