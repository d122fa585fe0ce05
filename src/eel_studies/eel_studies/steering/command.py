# SPDX-License-Identifier: Apache-2.0
"""`eel steering`: linearise swims over a period: what grows, what bends do.

eel steering                                         # prints a line per gait and height, draws out/steering.png
eel steering --page docs/explanation/steering.md     # the page, and its picture in docs/images
"""

import os
from pathlib import Path

from eel_base.command.command_line import Parser
from eel_base.command.progress import Progress
from eel_base.command.run_command import run_command
from eel_base.files.output_file import check_output, written_as
from eel_dynamics.runs.storage.tables import needed

from eel_studies.pictures.picture_file import write_picture
from eel_studies.steering.drawing import SIZE, draw_multipliers
from eel_studies.steering.page import scans_of, write_page

FEWEST = 2


def main(arguments: list[str] | None = None) -> int:
    """Exit status as of `run_command`."""
    return run_command(_parser(), _scan, arguments)


def _scan(options) -> int:
    if options.points < FEWEST:
        raise ValueError(f"--points must be {FEWEST} or more, got {options.points}")
    if options.page:
        check_output("--page", options.page)
    needed("matplotlib", "steering", "eel_studies[pictures]")
    folder = Path(options.out)
    folder.mkdir(exist_ok=True)
    scans = scans_of(options.points, Progress("eel steering", "gaits"))
    for scan in scans:
        for height, growth in zip(scan.heights, scan.growth, strict=True):
            print(f"{scan.name}: metacentric height {1e3 * height:.3g} mm, growth {growth:.4g} a period")
    paths = folder / "steering.png", folder / "steering.svg"
    write_picture(lambda figure: draw_multipliers(figure, scans), SIZE, *paths)
    for path in paths:
        print(f"written to {written_as(path)}")
    if options.page:
        picture = os.path.relpath(paths[1], Path(options.page).parent)
        write_page(Path(options.page), scans, picture)
        print(f"written to {written_as(options.page)}")
    return 0


def _parser() -> Parser:
    parser = Parser(
        prog="eel steering",
        description="Linearise swims over a period of their gaits, at metacentric heights: what grows, and whether "
        "bends in yaw and pitch can hold it.",
    )
    parser.add_argument("--out", default="out", metavar="FOLDER", help="where the picture goes (out)")
    parser.add_argument("--points", type=int, default=51, metavar="N", help="metacentric heights of each gait (51)")
    parser.add_argument("--page", metavar="FILE", help="write the page too")
    return parser
