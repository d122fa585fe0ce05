# SPDX-License-Identifier: Apache-2.0
"""`eel stability`: drive the simulator to its extremes, and map where it stops.

eel stability                   # every study; pictures into out
eel stability --study drift     # one of them: maps, condition, drift, plane
eel stability --page docs/appendix/stability.md --out docs/images
"""

import argparse

from eel_base.command.command_line import Parser
from eel_base.command.progress import Progress
from eel_base.command.run_command import run_command

from eel_studies.outputs import Outputs, add_output_options
from eel_studies.stability.report import STUDIES

NAME = "eel stability"


def main(arguments: list[str] | None = None) -> int:
    """Exit status as of `run_command`."""
    return run_command(_parser(), _study, arguments)


def _study(options: argparse.Namespace) -> int:
    if options.points < 2:
        raise ValueError(f"--points must be 2 or more, got {options.points}")
    studies, progress = options.study or list(STUDIES), Progress(NAME, "")
    outputs = Outputs(NAME, options, studies)
    for name in studies:
        progress.say(f"study {name}")
        text = STUDIES[name](options.points, outputs)
        print(f"{text}\n")
        outputs.write({name: text})
    return 0


def _parser() -> Parser:
    parser = Parser(
        prog=NAME,
        description="Drive the simulator to the extremes: maps of where a swim is accurate, inaccurate, or stops, the "
        "condition of the inertia, drift over 100,000 periods, growth out of a plane.",
    )
    parser.add_argument(
        "--study", action="append", choices=STUDIES, metavar="NAME", help=f"one of {', '.join(STUDIES)} (all)"
    )
    parser.add_argument("--points", type=int, default=13, metavar="N", help="swims along each side of a map (13)")
    add_output_options(parser)
    return parser
