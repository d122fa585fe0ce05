# SPDX-License-Identifier: Apache-2.0
"""`python evidence/delivered.py`: what the targets of accuracy deliver over random swims.

python evidence/delivered.py --seed 7 --page docs/explanation/accuracy.md --out docs/images
"""

import argparse
import sys
from functools import partial

from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_studies.options import check_least
from eel_studies.outputs import Outputs, add_output_options
from studied.random_swims import COUNT, SEED, deliver, delivered_table, draw_delivered

NAME = "delivered.py"
PARTS, SIZE = ("delivered", "errors"), (4.5, 3.6)  # parts of the page; inches


def _add_options(parser: Parser) -> None:
    parser.add_argument("--count", type=int, default=COUNT, help=f"of the random swims ({COUNT})")
    parser.add_argument("--seed", type=int, default=SEED, help=f"of the random swims ({SEED})")
    add_output_options(parser)


@command(
    NAME,
    "Measure what the targets of accuracy deliver over random swims, and how well runs judge their own error.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    check_least(options, count=1, seed=0)
    outputs, progress = Outputs(NAME, options, PARTS), Progress(NAME, "swims")
    trials = deliver(options.count, options.seed, progress.say)
    table = delivered_table(trials)
    print(table.text())
    draw = partial(draw_delivered, trials=trials)
    picture = outputs.draw("delivered", "Estimated and true errors", draw, SIZE, ("svg", "png"))
    values = {"count": str(options.count), "seed": str(options.seed), "swims": str(len(trials))}
    outputs.write(dict(zip(PARTS, (table.markdown(), picture), strict=True)), values)


if __name__ == "__main__":
    sys.exit(main())
