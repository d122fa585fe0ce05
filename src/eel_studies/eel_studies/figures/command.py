# SPDX-License-Identifier: Apache-2.0
"""`eel figures`: draw the paper's figures 5 to 9, and more, with their page.

eel figures                   # into docs/figures
eel figures --out out/figures --format pdf --columns 1       # for a journal
"""

from pathlib import Path

from eel_base.command.command_line import Parser
from eel_base.command.progress import Progress
from eel_base.command.run_command import run_command
from eel_base.files.markdown import write_page
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.command_options import add_options
from eel_dynamics.runs.run import simulate
from eel_dynamics.runs.storage.tables import needed

from eel_gaits import straight
from eel_studies.figures import corrections, kern_comparison, orders
from eel_studies.figures.notes import page
from eel_studies.pictures.picture_file import write_picture
from eel_studies.pictures.style import letter_panels

SIZES = {  # inches; name of the file
    "figure5_body": (7.0, 3.6),
    "figure6_configurations": (9.0, 4.8),
    "figure7_wrench_along_the_body": (6.4, 5.0),
    "figure8_wrench_in_time": (6.8, 5.0),
    "figure9_head_velocity": (6.8, 3.8),
    "torque_surface": (7.6, 6.4),
    "head_path": (7.0, 6.2),
    "power_ledger": (6.8, 5.8),
    "convergence": (7.6, 3.8),
}
FORMATS, KNOWN_FORMATS = ("svg", "png"), ("svg", "png", "pdf")
COLUMN, PAGE = 3.4, 7.0  # inches: widths of a journal's column, and of its page
PAGE_WIDE = ("figure5_body", "figure6_configurations", "torque_surface", "convergence")  # whatever the columns
JOURNAL = {"font.size": 8.0, "lines.linewidth": 1.0, "pdf.fonttype": 42}  # letters as letters, not as curves


def main(arguments: list[str] | None = None) -> int:
    """Exit status as of `run_command`."""
    return run_command(_parser(), _figures, arguments)


def _figures(options) -> int:
    needed("matplotlib", "figures", "eel_studies[pictures]")
    folder = Path(options.out)
    for reading in corrections.READINGS.values():
        Accuracy.of(options.accuracy).in_scene(Scene(**reading))  # refused before the folder exists
    folder.mkdir(exist_ok=True)
    progress = Progress("eel figures", "")
    progress.say("runs of the falling gait")
    readings = corrections.swim(accuracy=options.accuracy)
    print(corrections.table_of(readings))
    control = simulate(straight(), readings[0].run.time[-1], accuracy=options.accuracy)
    comparison = kern_comparison.compare()
    print(kern_comparison.table_of(comparison))
    progress.say("convergence in space and time")
    errors = {rule.__name__: {drag: rule(drag) for drag in (False, True)} for rule in (orders.in_space, orders.in_time)}
    for path in draw(drawings_of(readings, errors), folder, options.format, options.columns):
        print(f"{path}  {path.stat().st_size / 1000.0:.0f} kB")
    write_page(folder / "README.md", page(readings, control, comparison, errors))
    print(folder / "README.md")
    return 0


def draw(drawings: dict, folder: Path, formats=FORMATS, columns: int | None = None):
    """Draw each of the `drawings` (`drawings_of`) into `folder`; yields the path of each file.

    columns: of a journal's page, 1 or 2, that a figure is wide; None: a size for screens.
    """
    for name, fill in drawings.items():

        def fill_and_letter(figure, fill=fill):
            fill(figure)
            letter_panels(figure)

        paths = [folder / f"{name}.{suffix}" for suffix in formats]
        write_picture(fill_and_letter, size_of(name, columns), *paths, settings=JOURNAL if columns else None)
        yield from paths


def size_of(name: str, columns: int | None) -> tuple[float, float]:
    """Width and height [inches] of a figure."""
    width, height = SIZES[name]
    if not columns:
        return width, height
    wanted = COLUMN if columns == 1 and name not in PAGE_WIDE else PAGE
    return wanted, height * max(wanted / width, 0.7)  # curves above one another stay high enough to be read


def drawings_of(readings, errors) -> dict:
    """Functions that draw into an empty matplotlib figure, by the name of the file."""
    from eel_studies.figures import further_drawings, paper_drawings

    runs = {row.label: row.run for row in readings}
    run, printed = runs[corrections.OWN], runs[corrections.PRINTED]
    return {
        "figure5_body": lambda figure: paper_drawings.draw_body(figure, run.body),
        "figure6_configurations": lambda figure: paper_drawings.draw_configurations(figure, run),
        "figure7_wrench_along_the_body": lambda figure: paper_drawings.draw_wrench_along_the_body(figure, run, printed),
        "figure8_wrench_in_time": lambda figure: paper_drawings.draw_wrench_in_time(figure, run, printed),
        "figure9_head_velocity": lambda figure: paper_drawings.draw_head_velocity(figure, run, printed),
        "torque_surface": lambda figure: further_drawings.draw_torque_surface(figure, run),
        "head_path": lambda figure: further_drawings.draw_head_path(figure, run),
        "power_ledger": lambda figure: further_drawings.draw_ledger(figure, run),
        "convergence": lambda figure: further_drawings.draw_convergence(figure, errors["in_space"], errors["in_time"]),
    }


def _parser() -> Parser:
    parser = Parser(
        prog="eel figures",
        description="Draw the paper's figures and more from runs of the falling gait, and write the page that explains "
        "them; half a minute.",
    )
    parser.add_argument("--out", default="docs/figures", metavar="FOLDER", help="where to (docs/figures)")
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
