# SPDX-License-Identifier: Apache-2.0
"""`eel tradeoff`: measure what accuracy costs, and what poorer models miss.

eel tradeoff falling
eel tradeoff falling straight turning --page docs/appendix/tradeoff.md --pictures docs/images
eel tradeoff straight --set period=0.7 --quick --rerun trade.rrd
eel tradeoff --delivered --seed 7 --page docs/explanation/accuracy.md --pictures docs/images
"""

import os
from pathlib import Path

from eel_base.command.command_line import Parser
from eel_base.command.progress import Progress
from eel_base.command.run_command import run_command
from eel_base.files.output_file import check_output, written_as
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.command_options import add_options, body_of, set_numbers
from eel_gaits.gaits.registry import gait

from eel_studies.pictures.picture_file import write_picture
from eel_studies.tradeoff import measuring, models
from eel_studies.tradeoff.delivered import COUNT, SEED, deliver, delivered_table
from eel_studies.tradeoff.delivered_page import write_delivered_page
from eel_studies.tradeoff.drawing import DELIVERED_SIZE, SIZE, draw_delivered, draw_trade
from eel_studies.tradeoff.page import reference_line, write_page
from eel_studies.tradeoff.price import draw_prices, prices
from eel_studies.tradeoff.settings import settings
from eel_studies.tradeoff.table import model_table, trade_table, write_csv

NAME = "eel tradeoff"
PROGRESS = Progress(NAME, "settings")
OF_GAITS = {  # options that do not go with --delivered: their defaults
    "gaits": ["falling"],
    "set": [],
    "duration": 10.0,  # s
    "body": "boyer2010",
    "repeats": 5,
    "quick": False,
    "all": False,
    "csv": False,
    "rerun": None,
}
OF_SWIMS = {"count": COUNT, "seed": SEED}  # options of --delivered alone: their defaults


def main(arguments: list[str] | None = None) -> int:
    """Exit status as of `run_command`."""
    return run_command(_parser(), _trade, arguments)


def _trade(options) -> int:
    _fill_in_defaults(options)
    _check_outputs(options)
    if options.delivered:
        if options.count < 1:
            raise ValueError(f"--count must be 1 or more, got {options.count}")
        if options.seed < 0:
            raise ValueError(f"--seed must be 0 or more, got {options.seed}")
        return _deliver(options)
    found = _measure_all(options)
    for trade, poorer in found:
        print(f"\n{trade.law.name}, {trade.duration:g} s. {reference_line(trade)}\n")
        print(trade_table(trade, everything=options.all))
        print()
        print(model_table(poorer, trade))
    for path in _write_all(options, found):
        print(f"written to {written_as(path)}")
    return 0


def _fill_in_defaults(options):
    """`ValueError` names options that were given, and do not go with --delivered or without it."""
    for defaults, allowed in ((OF_GAITS, not options.delivered), (OF_SWIMS, options.delivered)):
        given = []
        for name, default in defaults.items():
            value = getattr(options, name)
            if value is None or value is False or value == []:
                setattr(options, name, default)
            else:
                given.append("GAIT" if name == "gaits" else f"--{name}")
        if given and not allowed:
            told = "does not go with" if options.delivered else "must be given for"
            raise ValueError(f"--delivered {told} {', '.join(given)}")


def _check_outputs(options):
    """Before all the work; makes the folder of the pictures."""
    for name in filter(None, (options.pictures, options.page, options.rerun)):
        if not Path(name).parent.is_dir():
            raise ValueError(f"{Path(name).parent} must be a folder that exists")
    for option, name in (("--page", options.page), ("--rerun", options.rerun)):
        if name:
            check_output(option, name)
    if options.pictures:
        Path(options.pictures).mkdir(exist_ok=True)


def _deliver(options) -> int:
    """Measure what the targets deliver; print it, and write page and picture if they are asked for."""
    trials = deliver(options.count, options.seed, PROGRESS.say)
    print(delivered_table(trials))
    if options.pictures or options.page:
        folder = Path(options.pictures or Path(options.page).parent)
        for path in _save(lambda figure: draw_delivered(figure, trials), DELIVERED_SIZE, folder / "delivered"):
            print(f"written to {written_as(path)}")
        found = prices(options.count, options.seed, PROGRESS.say)
        for path in _save(lambda figure: draw_prices(figure, *found), DELIVERED_SIZE, folder / "price"):
            print(f"written to {written_as(path)}")
    if options.page:
        page = Path(options.page)
        paths = (os.path.relpath(folder / name, page.parent) for name in ("delivered.png", "price.png"))
        write_delivered_page(page, trials, options.count, options.seed, *paths)
        print(f"written to {written_as(page)}")
    return 0


def _measure_all(options) -> list[tuple]:
    numbers = set_numbers(options.set)
    laws = [gait(name, **numbers) for name in options.gaits]
    body = body_of(options.body)
    least = measuring.SAMPLE_PERIOD  # a single sample has no error
    if not least <= options.duration < float("inf"):
        raise ValueError(f"--duration must be finite and >= {least} s, got {options.duration}")
    if not options.repeats >= 1:
        raise ValueError(f"--repeats must be 1 or more, got {options.repeats}")
    found = []
    for law in laws:
        fixed = {"duration": options.duration, "body": body, "scene": Scene(), "say": PROGRESS.say}
        PROGRESS.say(f"gait {law.name}")
        rows = settings(fixed["scene"], options.quick)
        trade = measuring.measure(law, rows, repeats=options.repeats, **fixed)
        found.append((trade, models.compare(law, trade.reference, **fixed)))
    return found


def _write_all(options, found):
    folder = Path(options.pictures or "out")
    folder.mkdir(exist_ok=True)
    for trade, poorer in found:
        yield from _draw(trade, poorer, folder)
        if options.csv:
            path = folder / f"tradeoff_{trade.law.name}.csv"
            write_csv(trade, path)
            yield path
    if options.page:
        page = Path(options.page)
        yield write_page(page, found, folder)
        yield page
    if options.rerun:
        from eel_studies.tradeoff.stream import stream

        stream(Path(options.rerun), found)
        yield options.rerun


def _draw(trade, poorer, folder: Path):
    return _save(lambda figure: draw_trade(figure, trade, poorer), SIZE, folder / f"tradeoff_{trade.law.name}")


def _save(draw, size, stem: Path) -> list[Path]:
    """Draw with `draw(figure)` into `stem` with .png and .svg; returns the paths."""
    paths = [stem.with_name(f"{stem.name}.{suffix}") for suffix in ("png", "svg")]
    write_picture(draw, size, *paths)
    return paths


def _parser() -> Parser:
    parser = Parser(
        prog=NAME,
        description="Measure error and cost of many settings for a gait, mark the Pareto front, and compare with the "
        "error of models that leave physics out. Takes about a minute per gait.",
    )
    add_options(parser, "gaits", "--set", "--body", gaits=([], "falling"), body=(None, "boyer2010"))
    parser.add_argument("--duration", type=float, help="s (10)")
    parser.add_argument("--repeats", type=int, help="rounds of timing, of which the median counts (5)")
    parser.add_argument("--quick", action="store_true", help="a ninth of the settings, for a look")
    parser.add_argument("--all", action="store_true", help="print every setting, not the fronts and presets alone")
    parser.add_argument(
        "--pictures", metavar="FOLDER", help="for tradeoff_GAIT.png and .svg (out), or delivered.png and .svg"
    )
    parser.add_argument("--csv", action="store_true", help="everything measured, as .csv beside the pictures")
    parser.add_argument("--page", metavar="FILE.md", help="write tables and picture as a page")
    parser.add_argument("--rerun", metavar="FILE.rrd", help="write the runs and the trade as a Rerun recording")
    parser.add_argument(
        "--delivered",
        action="store_true",
        help="instead: measure what the targets deliver over random swims, and how well runs judge their own error "
        "(a minute or two); of the other options only --count, --seed, --pictures and --page go with it",
    )
    parser.add_argument("--count", type=int, help=f"of the random swims ({COUNT})")
    parser.add_argument("--seed", type=int, help=f"of the random swims ({SEED})")
    return parser
