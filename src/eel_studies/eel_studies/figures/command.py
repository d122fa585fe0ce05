# SPDX-License-Identifier: Apache-2.0
"""`eel figures`: draw the paper's figures 5 to 9, and more, with the numbers of their page.

eel figures                   # into docs/figures
eel figures --out out/figures --format pdf --columns 1       # for a journal
"""

import argparse
from collections.abc import Callable, Iterable

from eel_base.command.command_line import Parser
from eel_base.command.progress import Progress
from eel_base.command.run_command import run_command
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.commands.options import add_options
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.simulate import simulate
from eel_model.scene import Scene

from eel_gaits import straight
from eel_studies.figures import corrections, further_drawings, kern_comparison, notes, orders, paper_drawings
from eel_studies.outputs import Outputs
from eel_studies.pictures import Figure, letter_panels

NAME = "eel figures"
Drawing = Callable[[Figure, Run, Run, orders.Errors], None]  # of our run, the one as printed, and the errors
FIGURES: dict[str, tuple[Drawing, float, float]] = {  # name of the file: drawing, width and height [inches]
    "figure5_body": (paper_drawings.draw_body, 7.0, 3.6),
    "figure6_configurations": (paper_drawings.draw_configurations, 5.4, 7.8),
    "figure7_wrench_along_the_body": (paper_drawings.draw_wrench_along_the_body, 6.4, 5.0),
    "figure8_wrench_in_time": (paper_drawings.draw_wrench_in_time, 6.8, 5.0),
    "figure9_head_velocity": (paper_drawings.draw_head_velocity, 6.8, 3.8),
    "torque_surface": (further_drawings.draw_torque_surface, 7.6, 6.4),
    "head_path": (further_drawings.draw_head_path, 7.0, 6.2),
    "power_ledger": (further_drawings.draw_ledger, 6.8, 5.8),
    "convergence": (further_drawings.draw_convergence, 7.6, 3.8),
}
FORMATS, KNOWN_FORMATS = ("svg", "png"), ("svg", "png", "pdf")
COLUMN, PAGE = 3.4, 7.0  # inches: widths of a journal's column, and of its page
PAGE_WIDE = ("figure5_body", "torque_surface", "convergence")  # whatever the columns
JOURNAL = {"font.size": 8.0, "lines.linewidth": 1.0, "pdf.fonttype": 42}  # letters as letters, not as curves


def main(arguments: list[str] | None = None) -> int:
    """Exit status as of `run_command`."""
    return run_command(_parser(), _figures, arguments)


def _figures(options: argparse.Namespace) -> int:
    for reading in corrections.READINGS.values():
        Accuracy.of(options.accuracy).in_scene(Scene(**reading))  # refused before the folder exists
    options.page = None
    outputs, progress = Outputs(NAME, options), Progress(NAME, "")
    outputs.page = outputs.folder / "README.md"
    progress.say("runs of the falling gait")
    readings = corrections.swim(accuracy=options.accuracy)
    control = simulate(straight(), readings[0].run.time[-1], accuracy=options.accuracy).in_axes("paper")
    comparison = kern_comparison.compare()
    progress.say("convergence in space and time")
    errors = {rule.__name__: {drag: rule(drag) for drag in (False, True)} for rule in (orders.in_space, orders.in_time)}
    draw(outputs, FIGURES, readings, errors, options.format, options.columns)
    parts = notes.parts_of(readings, comparison)
    print(*parts.values(), sep="\n\n")
    outputs.write(parts, notes.values_of(readings, control, comparison, errors))
    return 0


def draw(
    outputs: Outputs,
    names: Iterable[str],
    readings: list[corrections.Correction],
    errors: orders.Errors,
    formats: Iterable[str] = FORMATS,
    columns: int | None = None,
) -> list[str]:
    """Draw the `FIGURES` of these `names`; returns them as a page links them.

    columns: of a journal's page, 1 or 2, that a figure is wide; None: a size for screens.
    """
    runs = {row.label: row.run for row in readings}
    run, printed = runs[corrections.OWN], runs[corrections.PRINTED]
    links = []
    for name in names:

        def fill(figure: Figure, draw: Drawing = FIGURES[name][0]) -> None:
            draw(figure, run, printed, errors)
            letter_panels(figure)

        settings = JOURNAL if columns else None
        links.append(outputs.draw(name, name, fill, size_of(name, columns), tuple(formats), settings))
    return links


def size_of(name: str, columns: int | None) -> tuple[float, float]:
    """Width and height [inches] of a figure."""
    _, width, height = FIGURES[name]
    if not columns:
        return width, height
    wanted = COLUMN if columns == 1 and name not in PAGE_WIDE else PAGE
    return wanted, height * max(wanted / width, 0.7)  # curves above one another stay high enough to be read


def _parser() -> Parser:
    parser = Parser(
        prog=NAME,
        description="Draw the paper's figures and more from runs of the falling gait, and write the numbers of the "
        "page that explains them, README.md beside them; half a minute.",
    )
    parser.add_argument("-o", "--out", default="docs/figures", metavar="FOLDER", help="where to (docs/figures)")
    parser.add_argument("--format", nargs="+", choices=KNOWN_FORMATS, default=FORMATS, help="file formats (svg png)")
    parser.add_argument(
        "--columns",
        type=int,
        choices=(1, 2),
        help="columns of a journal's page that a figure is wide, 3.4 or 7 inches, with letters of 8 points; panels "
        "side by side take both (a size for screens)",
    )
    add_options(parser, "--accuracy", accuracy="fine")
    return parser
