# SPDX-License-Identifier: Apache-2.0
"""How well the pilot swims: random courses, held courses and stations. `make pilot` writes the table of
docs/howto/pilot.md and its picture; `--courses N` swims fewer than 100 of each.
"""

import argparse
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from eel_base.files import markdown
from eel_gaits.pilot.settings import PilotSettings
from eel_studies.pictures import BLUE, ORANGE, write_picture
from eel_studies.pilot.courses import figures_of, random_path, swim_path
from matplotlib.patches import Circle

ROOT = Path(__file__).resolve().parent.parent
PAGE, PICTURE = ROOT / "docs/howto/pilot.md", ROOT / "docs/images/pilot.png"
HEIGHTS = (0.0, 0.002, 0.005)  # m, metacentric heights
SHOWN = 4  # seed of the course in the picture


def table(courses: int, processes: int) -> str:
    """The figures of so many `courses`, held courses and stations at each metacentric height, as Markdown."""
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        found = [list(pool.map(partial(figures_of, metacentric_height=height), range(courses))) for height in HEIGHTS]
    rows = {
        "way points reached within a quarter of the length": lambda all: share(
            miss < 0.25 for each in all for miss in each.misses
        ),
        "distance from a way point, median and greatest [lengths]": lambda all: extremes(
            [miss for each in all for miss in each.misses]
        ),
        "depth held within 2 cm": lambda all: share(each.depth < 0.02 for each in all),
        "error of the depth, median and greatest [cm]": lambda all: extremes([100.0 * each.depth for each in all]),
        "heading held within 3 degrees": lambda all: share(each.heading < math.radians(3.0) for each in all),
        "error of the heading, median and greatest [degrees]": lambda all: extremes(
            [math.degrees(each.heading) for each in all]
        ),
        "station held within half a length": lambda all: share(each.station < 0.5 for each in all),
        "distance from the station, median and greatest [lengths]": lambda all: extremes(
            [each.station for each in all]
        ),
        "greatest roll on a course, median and greatest [degrees]": lambda all: extremes(
            [math.degrees(each.course_roll) for each in all]
        ),
        "roll while a course is held, median and greatest [degrees]": lambda all: extremes(
            [math.degrees(each.straight_roll) for each in all]
        ),
    }
    heads = ["no keel", *(f"metacentric height {1e3 * height:g} mm" for height in HEIGHTS[1:])]
    told = f"{courses} random tasks of each kind, seeds 0 to {courses - 1}."
    cells = [[name, *(figure(each) for each in found)] for name, figure in rows.items()]
    return f"{told}\n\n{markdown.table(['', *heads], cells)}"


def share(good) -> str:
    """Of how many, in words."""
    good = list(good)
    return f"{sum(good)} of {len(good)}"


def extremes(values) -> str:
    """Median and greatest value."""
    return f"{np.median(values):.2g}, {np.max(values):.2g}"


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
    """Swim, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--courses", type=int, default=100)
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    page = PAGE.read_text(encoding="utf-8")
    markdown.with_part(page, "pilot", "")  # refused before the swims
    draw(PICTURE)
    text = table(options.courses, options.processes)
    markdown.write_page(PAGE, markdown.with_part(page, "pilot", text))
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
