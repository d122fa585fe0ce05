# SPDX-License-Identifier: Apache-2.0
"""How well the pilot swims: random courses, held courses and stations. `python evidence/pilot.py` writes the table of
docs/howto/pilot.md and its picture; `--courses N`, `--fins N` swim fewer than 100 of each, `--water N` other than 12.
"""

import argparse
import math
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from eel_common.files import markdown
from eel_dynamics.model.fins.text import fins_from_text
from eel_gaits.pilot.settings import PilotSettings
from eel_studies.outputs import Table
from eel_studies.pictures import BLUE, ORANGE, write_picture
from eel_studies.roll_hold.study import PAIR
from matplotlib.patches import Circle
from studied.courses import figures_in, figures_of, random_path, swim_path

ROOT = Path(__file__).resolve().parents[1]
PAGE, PICTURE = ROOT / "docs/howto/pilot.md", ROOT / "docs/images/pilot.png"
KEELS = {  # column of the table: what `figures_of` takes
    "no keel": {},
    **{f"metacentric height {height} mm": {"metacentric_height": 1e-3 * height} for height in (2, 5)},
}
FINS = {"fins in place of the keel": {"fins": fins_from_text(PAIR)}}
SHOWN = 4  # seed of the course in the picture


QUANTITIES: tuple[tuple[Callable, tuple[str, float] | None, str], ...] = (
    # of a task: values; what is counted as good, with its limit; what median and greatest are told of
    (lambda each: each.misses, ("way points reached within a quarter of the length", 0.25),
     "distance from a way point, {} [lengths]"),
    (lambda each: [100.0 * each.depth], ("depth held within 2 cm", 2.0), "error of the depth, {} [cm]"),
    (lambda each: [math.degrees(each.heading)], ("heading held within 3 degrees", 3.0),
     "error of the heading, {} [degrees]"),
    (lambda each: [each.station], ("station held within half a length", 0.5),
     "distance from the station, {} [lengths]"),
    (lambda each: [math.degrees(each.course_roll)], None, "greatest roll on a course, {} [degrees]"),
    (lambda each: [math.degrees(each.straight_roll)], None, "roll while a course is held, {} [degrees]"),
)  # fmt: skip


def swum(task: Callable, count: int, processes: int) -> list:
    """What `task(seed)` gives of so many seeds."""
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        return list(pool.map(task, range(count)))


def figures(swimmers: dict, courses: int, processes: int, path: Path) -> tuple[list[list[str]], list[list[str]]]:
    """Rows of what is met in so many courses, held courses and stations of each of the `swimmers`, and of its greatest
    errors; all of them in `path`."""
    found, met, errors = [swum(partial(figures_of, **each), courses, processes) for each in swimmers.values()], [], []
    for values_of, counted, told in QUANTITIES:
        values = [np.array([value for each in tasks for value in values_of(each)]) for tasks in found]
        if counted:
            met.append([counted[0], *(f"{np.sum(each < counted[1])} of {len(each)}" for each in values)])
        spread = (f"{np.median(each):.2g}, {np.max(each):.2g}" for each in values)
        errors.append([told.format("median and greatest"), *spread])
    Table(("", *swimmers), [*met, *errors]).write_csv(path)
    return met, errors


def sentence(swimmers: dict, courses: int, processes: int) -> str:
    """How many of the tasks of the first of the `swimmers` are met, as a sentence."""
    met, _ = figures(swimmers, courses, processes, PAGE.with_name("pilot_fins.csv"))
    return f"Of {courses} random tasks of each kind, {', '.join(f'{told}: {count}' for told, count, *_ in met)}."


def table(swimmers: dict, courses: int, processes: int) -> str:
    """What is met, and the rolls, of all `swimmers`, as Markdown."""
    met, errors = figures(swimmers, courses, processes, PAGE.with_name("pilot.csv"))
    rows = [*met, *(row for row in errors if row[0].startswith("greatest roll"))]
    told = f"{courses} random tasks of each kind, seeds 0 to {courses - 1}."
    return f"{told}\n\n{markdown.table(['', *swimmers], rows)}"


WATER = (  # figures of WaterFigures: name, factor of the unit
    ("station in a shear: greatest distance in the last 30 s [cm]", "station", 100.0),
    ("course across a street of vortices: greatest error of the heading [degrees]", "heading", math.degrees(1.0)),
    ("the same, in the last 10 s, beyond the street", "after", math.degrees(1.0)),
    ("depth held below waves: greatest error in the last 30 s [cm]", "depth", 100.0),
    ("radius on which the waves move the water there [cm]", "orbit", 100.0),
)


def water_table(tasks: int, processes: int) -> str:
    """The figures of so many `tasks` of each kind in water that moves, as Markdown."""
    found, rows = swum(figures_in, tasks, processes), []
    for told, name, factor in WATER:
        values = factor * np.array([getattr(each, name) for each in found])
        rows.append((told, f"{np.median(values):.2g}", f"{np.max(values):.2g}"))
    told = f"{tasks} random tasks of each kind, seeds 0 to {tasks - 1}, without a keel."
    return f"{told}\n\n{markdown.table(['', 'median', 'greatest'], rows)}"


def draw(path: Path):
    """One course from above and from the side: way points, tubes of tolerance, the head's path."""
    settings = PilotSettings()
    goal = random_path(np.random.default_rng(SHOWN), settings)
    _, voyage = swim_path(goal)
    points, reach = np.vstack((np.zeros(3), goal.points)), settings.reach * settings.length

    def fill(figure):
        views = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
        for axes, column, name in zip(views, (1, 2), ("y, to the left [m]", "z, up [m]"), strict=True):
            axes.plot(points[:, 0], points[:, column], "--", color="0.6", linewidth=0.8, label="legs")
            axes.plot(voyage.head[:, 0], voyage.head[:, column], color=BLUE, linewidth=0.9, label="head")
            for x, value in goal.points[:, (0, column)]:
                axes.add_patch(Circle((x, value), reach, color=ORANGE, alpha=0.4, linewidth=0.0))
            axes.set_aspect("equal")
            axes.set_ylabel(name)
        views[0].plot([], [], "o", color=ORANGE, alpha=0.4, label="within a quarter of the length")
        views[0].legend(loc="best")
        views[1].set_xlabel("x, ahead [m]")

    write_picture(fill, (7.0, 5.0), path, settings={"savefig.dpi": 110})


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--courses", type=int, default=100)
    parser.add_argument("--fins", type=int, default=100, help="tasks of each kind with fins")
    parser.add_argument("--water", type=int, default=12, help="tasks of each kind in water that moves")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    page = PAGE.read_text(encoding="utf-8")
    for part in ("pilot", "fins", "water"):
        markdown.with_part(page, part, "")  # refused before the swims
    if options.courses:
        draw(PICTURE)
    parts: dict[str, tuple[Callable[[int, int], str], int]] = {
        "pilot": (partial(table, KEELS), options.courses),
        "fins": (partial(sentence, FINS), options.fins),
        "water": (water_table, options.water),
    }
    for part, (made, count) in parts.items():
        if count:  # 0: as it was
            text = made(count, options.processes)
            page = markdown.with_part(page, part, text)
            print(text)
    markdown.write_page(PAGE, page)
    return 0


if __name__ == "__main__":
    sys.exit(main())
