# SPDX-License-Identifier: Apache-2.0
"""`python evidence/laws.py`: hold the model against laws of swimming.

python evidence/laws.py gazzola --out docs/images/law_gazzola.png
python evidence/laws.py gazzola --friction taylor
"""

import argparse
import sys
from functools import partial

from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_dynamics.commands.options import add_options
from eel_dynamics.model.scene import FRICTION
from eel_studies.outputs import checked_outs, write_files
from eel_studies.pictures import BLACK, LOOKS, Figure, legend_above
from studied.laws_of_swimming import LAWS, Result

NAME = "laws.py"
SIZE = 5.2, 3.6  # inches


def _add_options(parser: Parser) -> None:
    parser.add_argument("law", choices=LAWS, help="which one: the first lines of eel_studies/laws/laws.py")
    parser.add_argument("--friction", choices=FRICTION, help="law of friction in gazzola (blended)")
    add_options(parser, "--out")


@command(NAME, "Hold the model against a law of swimming that was found on animals.", add_options=_add_options)
def main(options: argparse.Namespace) -> None:
    outs = checked_outs(NAME, options)
    if options.friction and options.law != "gazzola":
        raise ValueError("--friction belongs to gazzola")
    found = LAWS[options.law](options.friction) if options.friction else LAWS[options.law]()
    print(found.table.text())
    write_files(outs, found.table.write_csv, partial(draw, found=found), SIZE)


def draw(figure: Figure, found: Result) -> None:
    """The law as lines, our swims as marks."""
    axes = figure.add_subplot()
    for place, (name, line) in enumerate(found.theirs.items()):
        axes.plot(*line.T, color=BLACK, linestyle=("-", (0, (4, 2)), (0, (1, 1)))[place % 3], label=name)
    for (name, points), (colour, _, mark) in zip(found.ours.items(), LOOKS, strict=False):
        axes.plot(*points.T, mark, color=colour, label=f"ours, {name}")
    if found.logarithmic:
        axes.set(xscale="log", yscale="log")
        axes.tick_params(which="minor", labelbottom=False)
    axes.set(xlabel=found.x, ylabel=found.y)
    legend_above(figure, 2)


if __name__ == "__main__":
    sys.exit(main())
