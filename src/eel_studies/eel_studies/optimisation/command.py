# SPDX-License-Identifier: Apache-2.0
"""`eel optimise`: find the gait of least cost of transport at each speed.

eel optimise straight --bound period=0.4:3 --bound amplitude_0=0:2 --bound amplitude_2=0:6 --speeds 0.2:0.6:5
eel optimise scene.yaml --bound period=0.4:3 --speeds 0.3
eel optimise kern_fast --body kern2006 --bound period=0.5:2 --bound bend_tail=0:8 --speeds 0.3,0.4 --out front.png
"""

import argparse
import time
from contextlib import suppress
from functools import partial

from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_common.wording import shown
from eel_dynamics.analysis.measures import MEASURES
from eel_dynamics.commands.options import add_changes, add_options, add_repeated, set_numbers, swim_from, varied_values
from eel_dynamics.runs.scene_file import SUFFIXES as SCENES
from eel_dynamics.runs.storage.tables import write_columns

from eel_studies.optimisation.front import SIZE, draw_front
from eel_studies.optimisation.optimise import optimise
from eel_studies.optimisation.searches import METHODS
from eel_studies.options import ranges_of
from eel_studies.outputs import checked_outs, write_files

NAME = "eel optimise"
MOST_SPEEDS = 1000
ACCURACY = 1e-3


def _add_options(parser: Parser) -> None:
    add_options(parser, "gait", gait="straight")
    about = "a parameter and its bounds: a number of the gait, scene.FIELD, body.FIELD, robot.FIELD"
    add_repeated(parser, "--bound", "NAME=LOW:HIGH", about, required=True)
    parser.add_argument("--speeds", required=True, metavar="SPEEDS", help="m/s: a,b,c or start:end:count")
    add_options(parser, "--set", "--out")
    add_changes(parser, "--duration", "--sample-period", accuracy=(None, f"{ACCURACY:g}"))
    parser.add_argument("--cost", default="cost_of_transport", help=f"one of {', '.join(MEASURES)} (cost_of_transport)")
    parser.add_argument("--method", default="gradient", help=f"{' or '.join(METHODS)} (gradient); cma needs cma")
    parser.add_argument("--periods", type=int, default=10, metavar="N", help="of each swim (10)")
    parser.add_argument("--starts", type=int, default=1, metavar="N", help="gaits from which a search begins (1)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of what is random (0)")


@command(
    NAME,
    "Find the gait of least cost at each speed, of a gait by name or the scene in a file. The friction "
    "is blended, unless the file or --scene says otherwise.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    start = time.perf_counter()
    outs = checked_outs(NAME, options)
    smooth = {} if options.gait.endswith(SCENES) else {"scene": {"friction": "blended"}}
    swim = swim_from(options.gait, options, **smooth)
    front = optimise(
        ranges_of("--bound", options.bound),
        _speeds(options.speeds),
        gait=swim,
        numbers=set_numbers(options.set),
        cost=options.cost,
        periods=options.periods,
        accuracy=swim.accuracy if options.accuracy else ACCURACY,
        method=options.method,
        starts=options.starts,
        seed=options.seed,
        progress=Progress(NAME, "speeds"),
    )
    print(front.table())
    if front.at_bound.any() or front.dominated.any():
        print("* a parameter at its bound, or a gait that is slower and costs more than another")
    print(f"wall time  {time.perf_counter() - start:.1f} s, {len(front.tried)} gaits tried")
    write_files(outs, partial(write_columns, front.columns), partial(draw_front, front=front), SIZE)


def _speeds(text: str) -> list[float]:
    with suppress(ValueError):
        found = varied_values(text, _check_count)
        if all(isinstance(speed, float) for speed in found):
            return found
    raise ValueError(f"--speeds must be start:end:count, count >= 1, or a,b,c in m/s, got {shown(text)}")


def _check_count(count: int) -> None:
    if count > MOST_SPEEDS:
        raise ValueError(f"at most {MOST_SPEEDS}")
