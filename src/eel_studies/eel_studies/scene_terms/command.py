# SPDX-License-Identifier: Apache-2.0
"""`eel terms`: swim a scene without each term of the model, and find the smallest scene that suffices.

eel terms scene.yaml
eel terms straight --set period=0.7 --tolerance 0.05 --out small.yaml
"""

import argparse

from eel_common.command.command import checked_out, command
from eel_common.command.command_line import Parser
from eel_common.files.output_file import written_as
from eel_dynamics.runs.scene_file import SUFFIXES, save_scene

from eel_studies.options import add_scene_options, chosen
from eel_studies.scene_terms.study import terms

NAME = "eel terms"
TOLERANCE = 0.02


def _add_options(parser: Parser) -> None:
    add_scene_options(parser)
    parser.add_argument(
        "--tolerance",
        type=float,
        default=TOLERANCE,
        metavar="X",
        help=f"greatest relative change of path, mean speed, greatest torque and cost of transport ({TOLERANCE:g})",
    )
    parser.add_argument("-o", "--out", metavar="FILE.yaml", help="where to write the recommended scene")


@command(
    NAME,
    "Swim a scene with each term of the model off in turn. Print the change and the CPU time; "
    "then recommend the smallest scene within a tolerance, swum once more against the whole one.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    out = None if options.out is None else checked_out(NAME, options.out, SUFFIXES)
    found = terms(chosen(options.swim, options), options.tolerance)
    print(found.table().text(), found.about(), sep="\n\n")
    if out is not None:
        save_scene(found.recommended, out)
        print(f"written to {written_as(out)}")
