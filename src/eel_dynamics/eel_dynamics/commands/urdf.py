# SPDX-License-Identifier: Apache-2.0
"""`eel urdf`: print a robot as a URDF, for RViz and other tools.

eel urdf --robot eight_servos > eel.urdf
eel urdf --body fish.csv --yaw-joints 10 --frame camera=0.02 > fish.urdf
"""

import argparse

from eel_common.command.command import command
from eel_common.command.command_line import Parser, print_to_stderr

from eel_dynamics.commands.options import add_options, add_repeated, scene_of, set_numbers
from eel_dynamics.model.body.text import body_of
from eel_dynamics.model.robot.robot import robot_of
from eel_dynamics.model.robot.urdf_writer import urdf_of

NAME = "eel urdf"


def _add_options(parser: Parser) -> None:
    add_options(parser, "--robot", "--body", "--scene", body=(None, "the robot's own, or boyer2010"))
    for axis in ("yaw", "pitch"):
        parser.add_argument(
            f"--{axis}-joints",
            type=int,
            default=0,
            metavar="N",
            help=f"without --robot: joints in {axis} of the chain, as {axis}_joints of the node dynamics (0)",
        )

    about = "a further link without mass at X [m], as of a sensor, on the link that is there"
    add_repeated(parser, "--frame", "NAME=X", about)


@command(
    NAME,
    "Print a robot, or a body whose shape is imposed, as a URDF: links with mass and inertia, joints with limits.",
    epilog="Without --robot and joints the body is one rigid link. Of the scene its density is written alone. "
    "What a URDF cannot express is printed, and listed in a comment: docs/howto/urdf.md.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    """Print the URDF."""
    body = None if options.body is None else body_of(options.body)
    text, left_out = urdf_of(
        body,
        robot_of(options.robot),
        yaw_joints=options.yaw_joints,
        pitch_joints=options.pitch_joints,
        density=scene_of(options.scene).density,
        frames=set_numbers(options.frame, "--frame"),
    )
    if left_out:
        print_to_stderr(NAME, f"left out: {'; '.join(left_out)}")
    print(text, end="")
