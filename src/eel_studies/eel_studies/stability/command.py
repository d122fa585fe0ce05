# SPDX-License-Identifier: Apache-2.0
"""`eel stability`: drive the simulator to its extremes, and map where it stops.

eel stability                   # every study; pictures into docs/images
eel stability --study drift     # one of them: maps, condition, drift, plane
eel stability --page docs/appendix/stability.md --out docs/images
"""

import os
from pathlib import Path

from eel_base.command.command_line import Parser
from eel_base.command.progress import Progress
from eel_base.command.run_command import run_command
from eel_base.files.markdown import with_part, write_page
from eel_base.files.output_file import check_output
from eel_dynamics.runs.storage.tables import needed

from eel_studies.pictures.picture_file import write_picture
from eel_studies.stability.studies import STUDIES

SIZE = 5.6, 4.2  # inches


def main(arguments: list[str] | None = None) -> int:
    """Exit status as of `run_command`."""
    return run_command(_parser(), _study, arguments)


def _study(options) -> int:
    needed("matplotlib", "stability", "eel_studies[pictures]")
    if options.points < 2:
        raise ValueError(f"points must be >= 2, got {options.points}")
    if options.page:
        _check_page(options.page, options.study or STUDIES)
    folder = Path(options.out)
    folder.mkdir(exist_ok=True)
    progress = Progress("eel stability", "")
    for name in options.study or STUDIES:
        progress.say(f"study {name}")
        study = STUDIES[name](options.points)
        print(f"{study.text}\n")
        for picture, (_, draw) in study.pictures.items():
            write_picture(draw, SIZE, folder / f"stability_{picture}.svg")
        if options.page:
            page = Path(options.page)
            link = os.path.relpath(folder, page.parent)
            write_page(page, with_study(page.read_text(encoding="utf-8"), name, study, link))
    return 0


def _check_page(page: str, studies):
    """`ValueError` for a page that cannot be written, or lacks the marker lines of a study; `OSError`: not readable."""
    check_output("--page", page)
    text = Path(page).read_text(encoding="utf-8")
    for name in studies:
        with_part(text, name, "")


def with_study(page: str, name: str, study, folder: str) -> str:
    """The text of the page with the tables and pictures of the study `name` between its marker lines.

    folder: of the pictures, as seen from the page. `ValueError` where the marker lines are missing.
    """
    pictures = [f"![{title}]({folder}/stability_{picture}.svg)" for picture, (title, _) in study.pictures.items()]
    return with_part(page, name, "\n".join([study.text, *(["", *pictures] if pictures else [])]))


def _parser() -> Parser:
    parser = Parser(
        prog="eel stability",
        description="Drive the simulator to the extremes: maps of where a swim is accurate, inaccurate, or stops, the "
        "condition of the inertia, drift over 100,000 periods, growth out of a plane.",
    )
    parser.add_argument(
        "--study", action="append", choices=STUDIES, metavar="NAME", help=f"one of {', '.join(STUDIES)} (all)"
    )
    parser.add_argument("--out", default="docs/images", metavar="FOLDER", help="where to (docs/images)")
    parser.add_argument("--points", type=int, default=13, help="swims along each side of a map (13)")
    parser.add_argument("--page", metavar="FILE", help="page whose parts between the marker lines are written anew")
    return parser
