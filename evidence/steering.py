# SPDX-License-Identifier: Apache-2.0
"""`python evidence/steering.py`: linearise swims over a period: what grows, what bends do.

python evidence/steering.py     # prints a line per gait and height, draws out/steering.png
python evidence/steering.py --page docs/explanation/steering.md --out docs/images     # the page and its picture
"""

import argparse
import sys
from functools import partial

import numpy as np
from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_common.files.markdown import table
from eel_studies.options import check_least
from eel_studies.outputs import Outputs, Table, add_output_options
from eel_studies.pictures import BLUE, GREY, LOOKS, Axes, Figure
from eel_studies.steering.linearisation import (
    INPUTS,
    OUT_OF_PLANE,
    STATES,
    PeriodicLinearisation,
    periodic_linearisation,
)
from studied.ballast import (
    CONTROLLED,
    GAITS,
    HIGHEST,
    Scan,
    linearised,
    radius_of_gyration,
    recovery,
    sideways_acceleration,
    sway,
)

from eel_gaits import Law

NAME = "steering.py"
SIZE = 9.0, 4.0  # inches
PARTS = "kicks", "recovered", "gaits", "picture"
HEIGHTS = (0.0, 0.01)  # m, of the table of modes, of the first gait
MODES = "metacentric height", "multiplier", "magnitude", "motion", "held by yaw", "by pitch", "by both"
SHOWN = (0.0, 0.005, 0.01, 0.02)  # m, of the table of all gaits
LEANS = (5.0, 20.0)  # degrees
BEND = 0.3  # rad/m, that counts as much as a roll of 1 rad
RISES = (0.1, 0.25, 0.5)  # parts of a period
YAW, PITCH = INPUTS[:3], INPUTS[3:]
SAME = 1e-6  # multipliers that differ by less are one


def _add_options(parser: Parser) -> None:
    add_output_options(parser)
    parser.add_argument("--points", type=int, default=51, metavar="N", help="metacentric heights of each gait (51)")


@command(
    NAME,
    "Linearise swims over a period of their gaits, at metacentric heights: what grows, and whether "
    "bends in yaw and pitch can hold it.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    check_least(options, points=2)
    outputs, progress, scans = Outputs(NAME, options, PARTS), Progress(NAME, "gaits"), []
    for name, law in GAITS.items():
        scans.append(Scan.of(name, law, options.points))
        progress(len(scans), len(GAITS))
    for scan in scans:
        for height, growth in zip(scan.heights, scan.growth, strict=True):
            print(f"{scan.name}: metacentric height {1e3 * height:.3g} mm, growth {growth:.4g} a period")
    write_outputs(outputs, scans)


def write_outputs(outputs: Outputs, scans: list[Scan]) -> None:
    """Draw the `scans` of `GAITS`, and write the page where one is asked for."""
    title = "Multipliers over the metacentric height"
    picture = outputs.draw("steering", title, partial(draw_multipliers, scans=scans), SIZE)
    if not outputs.page:
        return
    law = scans[0].law
    found = {height: linearised(law, height, estimate=True) for height in HEIGHTS}
    free, ballast = found.values()
    gyration, (whole, tail) = radius_of_gyration(free.body), sideways_acceleration(law)
    modes = [(f"{1e3 * height:g} mm", *row) for height, swim in found.items() for row in _modes(swim)]
    outputs.write_table("steering", Table(MODES, modes))
    tables = _kicks(law), _recovered(found), _gaits(scans), picture
    values = {
        "growth": f"{free.growth:.2f}",
        "exponent": f"{np.log(free.growth):.3f}",
        "gyration": f"{1e3 * gyration:.0f}",
        "missing": f"{(0.01 / gyration) ** 2:.0%}",
        "missing_twice": f"{(0.02 / gyration) ** 2:.0%}",
        "whole": f"{whole:.2g}",
        "tail": f"{tail:.2g}",
        "error": f"{max(free.error, ballast.error):.0e}",
    }
    outputs.write(dict(zip(PARTS, tables, strict=True)), values)


def _modes(found: PeriodicLinearisation) -> list[tuple[str, ...]]:
    """The modes as rows; a conjugate pair takes one."""
    rows = []
    held = [found.controllability(inputs) for inputs in (YAW, PITCH, INPUTS)]
    attitude = list(np.flatnonzero(found.neutral))
    for mode, multiplier in enumerate(found.multipliers):
        if multiplier.imag < -SAME or mode in attitude[1:]:
            continue
        value = f"{multiplier.real:.3f}" + (f" ± {multiplier.imag:.3f}i" if multiplier.imag > SAME else "")
        motion = found.motion_of(mode).replace("_", " ")
        if mode in attitude and len(attitude) > 1:
            value, motion = f"{value}, three times", "roll, pitch, heading"
        rows.append((value, f"{abs(multiplier):.3f}", motion, *(_rounded(each[mode]) for each in held)))
    return rows


def _kicks(law: Law) -> str:
    rows = []
    for rise in RISES:
        kick = periodic_linearisation(law, rise=rise, estimate=False).kick(0)[len(YAW) :].real
        rows.append((f"{rise:g}", *(f"{each:+.3f}" for each in kick)))
    return table(("part of the period", "constant", "as cos", "as sin"), rows)


def _rounded(value: float) -> str:
    return "0" if value < 1e-6 else f"{value:.2g}"


def _recovered(found: dict[float, PeriodicLinearisation]) -> str:
    head = "metacentric height", "roll at the start", f"after 1, 2, 4, 8, {CONTROLLED} periods", "greatest bend"
    rows = []
    for height, swim in found.items():
        for lean in LEANS:
            roll, bend = recovery(swim, np.radians(lean), BEND)
            rolls = ", ".join(f"{np.degrees(roll[k - 1]):.2g}" for k in (1, 2, 4, 8, CONTROLLED))
            rows.append((f"{1e3 * height:g} mm", f"{lean:g}°", f"{rolls}°", f"{bend:.2g} rad/m"))
    return table(head, rows)


def _gaits(scans: list[Scan]) -> str:
    heights = [f"{1e3 * height:g} mm" for height in SHOWN]
    head = "gait", "speed", "steady from", f"growth at {', '.join(heights)}", f"sway at {', '.join(heights[1:])}"
    rows = []
    for scan in scans:
        found = [linearised(scan.law, height) for height in SHOWN]
        speed = np.linalg.norm(found[0].end.position) / found[0].period
        growth = ", ".join(f"{each.growth:.3f}" for each in found)
        swaying = ", ".join(f"{np.degrees(sway(each)):.1f}°" for each in found[1:])
        steady = f"none up to {1e3 * HIGHEST:g} mm" if scan.steady_from is None else f"{1e3 * scan.steady_from:.1f} mm"
        rows.append((scan.name, f"{speed:.2f} m/s", steady, growth, swaying))
    return table(head, rows)


def draw_multipliers(figure: Figure, scans: list[Scan]) -> None:
    """On the left the magnitudes of all multipliers of the first of the `scans`, on the right the greatest of each."""
    left, right = figure.subplots(1, 2)
    _draw_all(left, scans[0])
    for scan, (colour, dash, _) in zip(scans, LOOKS, strict=True):
        right.plot(1e3 * scan.heights, scan.growth, color=colour, linestyle=dash, label=scan.name)
    right.set(ylabel="greatest growth in a period", yscale="log")
    right.set_yticks([1.0, 1.5, 2.0, 3.0, 4.0], ["1", "1.5", "2", "3", "4"])
    right.set_yticks([], minor=True)
    right.legend()
    for axes in (left, right):
        axes.axhline(1.0, color=GREY, linewidth=0.8)
        axes.set_xlabel("metacentric height [mm]")
        axes.margins(x=0.02)


def _draw_all(axes: Axes, scan: Scan) -> None:
    rows = [STATES.index(name) for name in OUT_OF_PLANE]
    sizes = np.array([np.abs(each.multipliers) for each in scan.found])
    heights = np.broadcast_to(1e3 * scan.heights[:, None], sizes.shape)
    in_plane = np.array([each.participation[rows].sum(axis=0) for each in scan.found]) < 0.5
    for where, colour, mark, label in (
        (~in_plane, BLUE, "o", "roll, pitch, vertical"),
        (in_plane, GREY, "s", "in the plane"),
    ):
        axes.plot(heights[where], sizes[where], mark, color=colour, markersize=2.5, label=label)
    axes.set(ylabel="magnitude of the multipliers", ylim=(0.0, None))
    axes.set_title(scan.name, fontsize="medium")
    axes.legend()


if __name__ == "__main__":
    sys.exit(main())
