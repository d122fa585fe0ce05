# SPDX-License-Identifier: Apache-2.0
"""`eel tradeoff`: measure the cost of accuracy in a scene, and the effect of each term of the model.

eel tradeoff scene.yaml
eel tradeoff straight --set period=0.7 --within "5 ms"
eel tradeoff falling docs/scenes/street.yaml --page docs/appendix/tradeoff.md --out docs/images
"""

import argparse
import math
import re
from functools import partial
from pathlib import Path

from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_common.files.input_file import is_number
from eel_common.files.output_file import written_as
from eel_common.wording import shown

from eel_studies.options import add_scene_options, check_least, chosen
from eel_studies.outputs import Outputs, add_output_options
from eel_studies.tradeoff.measuring import SAMPLE_PERIOD, affordable, bare, measure
from eel_studies.tradeoff.report import (
    PARTS,
    SIZE,
    draw_trade,
    pace_line,
    parts_of_page,
    reference_line,
    trade_table,
)

NAME = "eel tradeoff"
UNITS = {"us": 1e-6, "ms": 1e-3, "s": 1.0}  # of --within


def _add_options(parser: Parser) -> None:
    add_scene_options(parser, several=True)
    parser.add_argument("--within", metavar="TIME", help="what is most exact within it per simulated second: '5 ms'")
    parser.add_argument(
        "--repeats", type=int, default=5, metavar="N", help="rounds of timing, of which the median counts (5)"
    )
    parser.add_argument("--quick", action="store_true", help="a ninth of the settings, for a look")
    parser.add_argument("--all", action="store_true", help="print every setting, not the front and presets alone")
    parser.add_argument("--csv", action="store_true", help="everything measured, as .csv beside the pictures")
    add_output_options(parser)


def _seconds(text: str) -> float:
    """The time [s] in a text such as "5 ms"."""
    found = re.fullmatch(r"([0-9.]+(?:e[+-]?[0-9]+)?) *(us|ms|s)", text.strip())
    seconds = float(found[1]) * UNITS[found[2]] if found and is_number(found[1]) else 0.0
    if not 0.0 < seconds < math.inf:
        raise ValueError(f"--within must be a time above 0 such as '5 ms' (us, ms or s), got {shown(text)}")
    return seconds


@command(
    NAME,
    "Measure error and cost of many settings for a scene, mark the Pareto front, and compare with the error of models "
    "without one of their terms. Takes about a minute per scene.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    progress, names = Progress(NAME, "settings"), options.swim or ["falling"]
    pace = None if options.within is None else _seconds(options.within)
    swims = {Path(name).stem: chosen(name, options) for name in names}
    for swim in swims.values():
        if isinstance(swim.duration, float) and not swim.duration >= (least := swim.sample_period or SAMPLE_PERIOD):
            raise ValueError(f"--duration must be >= {least} s, got {swim.duration}")
    check_least(options, repeats=1)
    outputs, found, pictures = Outputs(NAME, options, PARTS), [], []
    for name, swim in swims.items():
        progress.say(f"scene {name}")
        swim = bare(swim)
        trade = measure(swim, *affordable(swim, options.quick, options.repeats), progress.say, name)
        found.append(trade)
        about = f"\n{trade.name}, {trade.duration:g} s. {reference_line(trade)}"
        print(about, trade_table(trade, options.all).text(), sep="\n\n")
        if pace is not None:
            print(f"\n{pace_line(trade, pace)}")
        file, title = f"tradeoff_{trade.name}", f"The trade of the scene {trade.name}"
        pictures.append(outputs.draw(file, title, partial(draw_trade, trade=trade), SIZE, ("svg", "png")))
        if options.csv:
            path = outputs.folder / f"{file}.csv"
            trade_table(trade, everything=True).write_csv(path)
            print(f"written to {written_as(path)}")
    outputs.write(*parts_of_page(found, pictures))
