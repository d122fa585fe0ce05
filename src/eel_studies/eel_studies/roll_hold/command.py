# SPDX-License-Identifier: Apache-2.0
"""`eel roll-hold`: the window in which fins hold the roll of a gait, over two of their numbers.

eel roll-hold straight                                                        # area and gain of the pair at X = 0.5 m
eel roll-hold turning --fins "pair station=0.3 ..." --over fins.k_p=0.5:10 --over fins.time_constant=0.01:0.5
eel roll-hold --page docs/howto/fins.md --out docs/images                     # tables and pictures of the page
"""

import argparse

import numpy as np
from eel_base.command.command import command
from eel_base.command.command_line import Parser
from eel_dynamics.commands.options import add_repeated, named_texts
from eel_model.fins.text import fins_from_text

from eel_studies.outputs import Outputs, add_output_options
from eel_studies.roll_hold.page import PARTS, SIZE, draw_windows, page_parts
from eel_studies.roll_hold.study import PAIR, linearised, roll_window
from eel_studies.scene_options import add_scene_options, chosen
from eel_studies.stability.command import axis_from

NAME = "eel roll-hold"
OVER = ["fins.area=2e-4:5e-3", "fins.k_p=0.5:16"]


def _add_options(parser: Parser) -> None:
    add_scene_options(parser)
    about = f"a number of the window, such as fins.k_d or fins.station; twice ({', '.join(OVER)})"
    add_repeated(parser, "--over", "NAME=LOW:HIGH", about)
    parser.add_argument("--points", type=int, default=13, metavar="N", help="along each side of the window (13)")
    add_output_options(parser)


@command(
    NAME,
    "Linearise a swim with fins that hold its roll over a period of its gait, and draw where "
    "disturbances decay, over two numbers of the fins.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    if options.points < 2:
        raise ValueError(f"--points must be 2 or more, got {options.points}")
    if options.page:
        outputs = Outputs(NAME, options, PARTS)
        outputs.write(page_parts(outputs, options.points))
        return
    swim = chosen(options.swim or "straight", options)
    swim = swim if swim.fins else swim._replace(fins=fins_from_text(PAIR))
    axes = [axis_from(name, text) for name, text in named_texts("--over", options.over or OVER)]
    window = roll_window(swim, {axis.name: (axis.low, axis.high) for axis in axes}, options.points)
    outputs, found = Outputs(NAME, options), linearised(swim)
    print(f"growth                      {found.growth:.4g} a period, of {found.motion_of(0)} (error {found.error:.1g})")
    held = ", ".join(f"{name} = {value:.3g}" for name, value in window.best.items())
    print(f"held                        {int(window.held.sum())} of {window.held.size} points of the window")
    print(f"decays fastest              to {np.nanmin(window.growth):.3g} a period, at {held}")
    outputs.draw("roll_hold", window.map.title, lambda figure: draw_windows(figure, [window]), (SIZE[0] / 2, SIZE[1]))
