# SPDX-License-Identifier: Apache-2.0
"""`eel steering`: linearise swims over a period: what grows, what bends do.

eel steering                                         # prints a line per gait and height, draws out/steering.png
eel steering --page docs/explanation/steering.md --out docs/images     # the page and its picture
"""

import argparse

from eel_base.command.command import command
from eel_base.command.command_line import Parser
from eel_base.command.progress import Progress

from eel_studies.outputs import Outputs, add_output_options
from eel_studies.steering.page import PARTS, write_outputs
from eel_studies.steering.study import GAITS, Scan

NAME = "eel steering"
FEWEST = 2


def _add_options(parser: Parser) -> None:
    add_output_options(parser)
    parser.add_argument("--points", type=int, default=51, metavar="N", help="metacentric heights of each gait (51)")


@command(
    NAME,
    "Linearise swims over a period of their gaits, at metacentric heights: what grows, and whether "
    "bends in yaw and pitch can hold it.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    if options.points < FEWEST:
        raise ValueError(f"--points must be {FEWEST} or more, got {options.points}")
    outputs, progress, scans = Outputs(NAME, options, PARTS), Progress(NAME, "gaits"), []
    for name, law in GAITS.items():
        scans.append(Scan.of(name, law, options.points))
        progress(len(scans), len(GAITS))
    for scan in scans:
        for height, growth in zip(scan.heights, scan.growth, strict=True):
            print(f"{scan.name}: metacentric height {1e3 * height:.3g} mm, growth {growth:.4g} a period")
    write_outputs(outputs, scans)
