# SPDX-License-Identifier: Apache-2.0
"""`eel drafting`: speed and power of the straight gait behind a cylinder, over spacing and phase of its street.

eel drafting                                          # prints a line per spacing, draws out/drafting.png
eel drafting --page docs/explanation/drafting.md --out docs/images    # the page and its picture
"""

import argparse

import numpy as np
from eel_base.command.command import command
from eel_base.command.command_line import Parser
from eel_base.command.progress import Progress

from eel_studies.drafting.drawing import SIZE, draw_study
from eel_studies.drafting.study import Study, Wake
from eel_studies.outputs import Outputs, add_output_options
from eel_studies.table import Table

NAME = "eel drafting"
PARTS = ("picture",)
SPACINGS = (0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.1, 1.25, 1.5, 2.0, 3.0)  # m
PHASES = 6
LOCKED = 5e-3  # part of the speed of one spacing a beat, within which a swim is locked


def _add_options(parser: Parser) -> None:
    add_output_options(parser)
    parser.add_argument("--phases", type=int, default=PHASES, metavar="N", help=f"at the start, of each ({PHASES})")


@command(
    NAME,
    "Swim the straight gait in the street of vortices behind a cylinder that moves as fast as the "
    "swimmer does in still water, over spacing and phase: speed and power against still water.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    if options.phases < 1:
        raise ValueError(f"--phases must be 1 or more, got {options.phases}")
    outputs, progress = Outputs(NAME, options, PARTS), Progress(NAME, "swims")
    study = Study.of(np.array(SPACINGS), np.arange(options.phases) / options.phases, progress)
    rows = [_row(study, index) for index in range(len(study.spacings))]
    for row in rows:
        print(f"spacing {row[0]} m: cylinder {row[1]} m, speed {row[3]}, power {row[4]}, locked {row[6]}")
    picture = outputs.draw("drafting", "Behind a cylinder", lambda figure: draw_study(figure, study), SIZE, ("png",))
    head = "spacing [m]", "cylinder [m]", "core [m]", "speed", "power", "positive part", "locked"
    still, wake = study.still, Wake(study.still.speed, 1.0)
    values = {
        "still_speed": f"{still.speed:.3f}",
        "still_power": f"{still.power:.3f}",
        "mean": f"{wake.mean / still.speed:.2f}",
        "drafting": f"{study.drafting.speed / still.speed:.2f}",
        "least_power": f"{study.table('power').min() / still.power:.2f}",
    }
    outputs.write_table("drafting", Table(head, rows))
    outputs.write({"picture": picture}, values)


def _row(study: Study, index: int) -> tuple[str, ...]:
    still, wake = study.still, Wake(study.still.speed, float(study.spacings[index]))
    speed, power, paid = (study.table(name)[index] for name in ("speed", "power", "paid"))
    locked = np.abs(speed / study.locked_speed(wake) - 1.0) < LOCKED
    return (
        f"{wake.spacing:g}",
        f"{wake.diameter:.2f}",
        f"{wake.core:.2f}",
        _range(speed / still.speed),
        _range(power / still.power),
        _range(paid / still.paid),
        f"{np.count_nonzero(locked)} of {len(locked)}",
    )


def _range(values: np.ndarray) -> str:
    least, most = f"{values.min():.2f}", f"{values.max():.2f}"
    return least if least == most else f"{least} to {most}"
