# SPDX-License-Identifier: Apache-2.0
"""A robot from the log of its joints: options of commands, its links, its body and its motion."""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from eel_common.command.command_line import Parser
from eel_common.files.input_file import number_of
from eel_common.files.table import Table
from eel_common.quantity import positive
from eel_common.wording import shown
from eel_gaits.sources.joint_log import JointLog, law_of_links, read_joint_log
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.links import ALONE, FLUSH, joint_drag_of
from eel_dynamics.model.body.text import body_of
from eel_dynamics.runs.exchange.eel_viz_functions import function_of_eel_viz
from eel_dynamics.runs.run import Run

BAGS = ".mcap", ".db3"
FITTING = 1e-6  # allowed relative difference of the links' total length and the body's


def add_joint_options(parser: Parser) -> None:
    """Add the options for reading a log of joints, and for the robot."""
    parser.add_argument("--columns", default="", metavar="WHICH", help='joints of a table: "8-13", names, "*Fbck*"')
    parser.add_argument("--topic", metavar="TOPIC", help="of a bag with several of sensor_msgs/JointState")
    parser.add_argument("--tail-first", action="store_true", help="the first joint is that at the tail")
    parser.add_argument("--links", metavar="LENGTHS", help="m, from nose to tail: 0.18x9, or 0.2,0.1x5,0.2")
    parser.add_argument("--section", metavar="A,B", help="m, half-height and half-width of all links, or --body")
    parser.add_argument("--joint-drag", metavar="FLUSH|NUMBER",
                        help=f"of a link by itself, 0 ({FLUSH}) to {ALONE}; --section has no default")  # fmt: skip
    parser.add_argument("--clock", type=float, default=1.0, metavar="FACTOR",
                        help="true time by that of the log, whose clock runs fast or slow (1)")  # fmt: skip
    parser.add_argument("--mass", type=float, metavar="KG", help="of the robot (that of the water in its place)")


@dataclass(frozen=True)
class LoggedRobot:
    """A robot of n joints, and the motion in its log."""

    joints: np.ndarray  # (n,) m, their places from the nose
    body: Body
    law: SampledLaw
    notes: tuple[str, ...]  # of the log

    def about(self) -> list[str]:
        """The data read and the robot, one line each."""
        body = self.body
        robot = f"{len(self.joints) + 1} links, {body.length:.4g} m, {body.mass:.4g} kg, {body.volume * 1e3:.4g} l"
        return [self.law.about, *self.notes, robot]

    def torque(self, run: Run) -> np.ndarray:
        """(T, n) N m, of the motors in a `run` with internal wrench."""
        from scipy.interpolate import CubicSpline

        assert run.torque is not None
        return np.asarray(-CubicSpline(run.x, run.torque[:, :, 2], axis=1)(self.joints))


def logged_robot(path: str, options: argparse.Namespace) -> LoggedRobot:
    """The robot of the log at `path`, a table or a bag, with these `options`. `ValueError` for bad input."""
    log = _log(Path(path), options)
    links = _links(options.links, log.angles.shape[1])
    body = _body(options, float(links.sum()), len(links))
    if options.mass is not None:
        body = body.changed(density=positive("mass", options.mass, "kg") / body.volume)
    joints = np.cumsum(links)[:-1]
    return LoggedRobot(
        joints,
        body,
        law_of_links(log, joints, body.length),
        tuple(filter(None, (log.read and f"read: {log.read}", *log.notes))),
    )


def _log(path: Path, options: argparse.Namespace) -> JointLog:
    source: Path | Table = path
    columns, time = options.columns, options.time
    if path.is_dir() or path.suffix in BAGS:
        if columns or time:
            raise ValueError("--columns and --time belong to a table; joints of a bag have names")
        seconds, angles, names = function_of_eel_viz("joints")(path, options.topic)
        head = ["time [s]", *(f"{name} [rad]" for name in names)]
        source, columns = Table(path, head, np.column_stack((seconds, angles))), f"2-{len(head)}"
    elif options.topic is not None:
        raise ValueError("--topic belongs to a bag")
    return read_joint_log(
        source,
        columns=columns,
        time=time,
        unit=options.units or "",
        tail_first=options.tail_first,
        clock=positive("--clock", options.clock),
    )


def _links(text: str | None, joints: int) -> np.ndarray:
    """Lengths [m] of the links, from nose to tail: one more than joints."""
    parts = [part.partition("x") for part in (text or "").split(",")]
    try:
        found = [(number_of(length), int(count or 1)) for length, _, count in parts]
    except ValueError:
        found = []
    if min((count for _, count in found), default=0) < 1:
        raise ValueError(f"--links must be lengths such as 0.18x9 or 0.2,0.1x5,0.2 [m], got {shown(text)}")
    if (total := sum(count for _, count in found)) != joints + 1:
        raise ValueError(f"--links must be {joints + 1} lengths for {joints} joints, got {shown(total)}")
    return np.array([positive("link", length, "m") for length, count in found for _ in range(count)])


def _body(options: argparse.Namespace, length: float, links: int) -> Body:
    if (options.body is None) == (options.section is None):
        raise ValueError("one of --body and --section must be given")
    if options.section is not None:
        try:
            half_height, half_width = map(float, options.section.split(","))
        except ValueError:
            raise ValueError(f"--section must be half-height,half-width [m], got {shown(options.section)}") from None
        if options.joint_drag is None:
            raise ValueError(f"--joint-drag must be given with --section, {FLUSH} or 0 to {ALONE}, got none")
        return Body.of_links(length, links, half_width, half_height, joints=options.joint_drag)
    body = body_of(options.body)
    if abs(body.length - length) > FITTING * length:
        raise ValueError(f"--links must add up to the body's length, {body.length:g} m, got {length:g} m")
    if options.joint_drag is None:
        return body
    return body.changed(joint_drag=joint_drag_of(options.joint_drag), link_length=length / links)
