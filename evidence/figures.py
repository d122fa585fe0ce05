# SPDX-License-Identifier: Apache-2.0
"""`python evidence/figures.py`: draw the paper's figures 5 to 9, and more, with the numbers of their page.

python evidence/figures.py                   # into docs/figures
python evidence/figures.py --out out/figures --format pdf --columns 1       # for a journal
"""

import argparse
import sys
from collections.abc import Callable

from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_dynamics.commands.options import add_options
from eel_studies.outputs import Outputs
from eel_studies.pictures import Figure, letter_panels
from paper import drawings, notes, readings

from eel_dynamics import Accuracy, Run, Scene, simulate
from eel_gaits import straight

NAME = "figures.py"
FIGURES: dict[str, tuple[Callable[[Figure, Run, Run], None], float, float]] = {  # file: drawing, width, height [inches]
    "figure5_body": (drawings.draw_body, 7.0, 3.6),
    "figure6_configurations": (drawings.draw_configurations, 5.4, 7.8),
    "figure7_wrench_along_the_body": (drawings.draw_wrench_along_the_body, 6.4, 5.0),
    "figure8_wrench_in_time": (drawings.draw_wrench_in_time, 6.8, 5.0),
    "figure9_head_velocity": (drawings.draw_head_velocity, 6.8, 3.8),
    "torque": (drawings.draw_torque, 6.8, 5.0),
    "power_ledger": (drawings.draw_ledger, 6.8, 5.8),
}
FORMATS = "svg", "png", "pdf"
COLUMN, PAGE = 3.4, 7.0  # inches: widths of a journal's column, and of its page
JOURNAL = {"font.size": 8.0, "lines.linewidth": 1.0, "pdf.fonttype": 42}  # letters as letters, not as curves


def _add_options(parser: Parser) -> None:
    parser.add_argument("-o", "--out", default="docs/figures", metavar="FOLDER", help="where to (docs/figures)")
    parser.add_argument("--format", nargs="+", choices=FORMATS, default=FORMATS[:2], help="file formats (svg png)")
    parser.add_argument(
        "--columns",
        type=int,
        choices=(1, 2),
        help="columns of a journal's page that a figure is wide, 3.4 or 7 inches, with letters of 8 points; the body "
        "takes both (a size for screens)",
    )
    add_options(parser, "--accuracy", accuracy="fine")


@command(
    NAME,
    "Draw the paper's figures and more from runs of the falling gait, and write the numbers of the "
    "page that explains them, README.md beside them; a quarter of a minute.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    for reading in readings.READINGS.values():
        Accuracy.of(options.accuracy).in_scene(Scene(**reading))  # refused before the folder exists
    options.page = None
    outputs = Outputs(NAME, options)
    outputs.page = outputs.folder / "README.md"
    Progress(NAME, "").say("runs of the falling gait")
    runs = readings.swim_readings(accuracy=options.accuracy)
    control = simulate(straight(), runs[readings.OWN].time[-1], accuracy=options.accuracy).in_axes("paper")
    kern = readings.swim_kern()
    draw(outputs, runs, options.format, options.columns)
    tables = {"corrections": readings.table_of_readings(runs), "kern": readings.table_of_kern(*kern)}
    for name, table in tables.items():
        print(f"{table.text()}\n")
        outputs.write_table(name, table)
    if outputs.page.exists():
        outputs.write({}, notes.values_of(runs, control, kern[0]))


def draw(
    outputs: Outputs, runs: dict[str, Run], formats: tuple[str, ...] = FORMATS[:2], columns: int | None = None
) -> None:
    """Draw the `FIGURES`. columns: of a journal's page, 1 or 2, that a figure is wide; None: a size for screens."""
    for name, (drawing, width, height) in FIGURES.items():

        def fill(figure: Figure, drawing: Callable[..., None] = drawing) -> None:
            drawing(figure, runs[readings.OWN], runs[readings.PRINTED])
            letter_panels(figure)

        size = width, height
        if columns:
            wanted = COLUMN if columns == 1 and drawing is not drawings.draw_body else PAGE
            size = wanted, height * max(wanted / width, 0.7)  # curves above one another stay high enough to be read
        outputs.draw(name, name, fill, size, tuple(formats), JOURNAL if columns else None)


if __name__ == "__main__":
    sys.exit(main())
