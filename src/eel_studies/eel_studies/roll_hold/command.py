# SPDX-License-Identifier: Apache-2.0
"""`eel roll-hold`: map where fins hold the roll of a gait, over two numbers.

eel roll-hold straight                                                        # area and gain of the pair at X = 0.5 m
eel roll-hold turning --fins "pair station=0.3 ..." --over fins.k_p=0.5:10 --over fins.time_constant=0.01:0.5
eel roll-hold --page docs/howto/fins.md --out docs/images                     # tables and pictures of the page
"""

import argparse
from functools import partial
from typing import Any

import numpy as np
from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.files.markdown import table
from eel_dynamics.commands.options import add_repeated
from eel_dynamics.model.fins.text import fins_from_text

from eel_dynamics import Accuracy, Fin, Swim
from eel_gaits import Law, falling, straight, turning
from eel_studies.options import add_scene_options, check_least, chosen, ranges_of
from eel_studies.outputs import Outputs, Table, add_output_options
from eel_studies.roll_hold.study import PAIR, RollWindow, holding, linearised, roll_window, swum
from eel_studies.stability.command import axes_from
from eel_studies.stability.report import draw_map

NAME = "eel roll-hold"
OVER = ["fins.area=2e-4:5e-3", "fins.k_p=0.5:16"]
PARTS = "gaits", "window"
SIZE = 9.0, 4.0  # inches
PUSH, LONG, DIVE = 0.05, 40.0, 10.0  # rad/s of roll at the start; s, of the straight and of the falling gait
EXPECTED = {  # area [m^2], k_p of a pair at X = 0.2 m: roll, depth and drift, by an independent prototype
    (0.0, 0.0): ("17 rad", "22 m", "0.90 m"),
    (1e-3, 2.0): ("0.06 rad", "0.07 m", ""),
    (2e-3, 2.0): ("", "", "0.21 m"),
    (2e-3, 4.0): ("0.4 rad", "", ""),
    (4e-3, 2.0): ("0.6 rad", "", ""),
}
HALF = {"amplitude_0": 0.5, "amplitude_1": 0.25, "amplitude_2": 1.0}
GAITS = {
    "straight, 1.5 Hz": straight(period=2.0 / 3.0),
    "straight, 1 Hz": straight(),
    "straight, 0.3 Hz": straight(period=1.0 / 0.3),
    "straight, 1 Hz, half the amplitude": straight(**HALF),
    "turning, 1 Hz": turning(),
}


def _add_options(parser: Parser) -> None:
    add_scene_options(parser)
    about = f"a number of the window, such as fins.k_d or fins.station; twice ({', '.join(OVER)})"
    add_repeated(parser, "--over", "NAME=LOW:HIGH", about)
    parser.add_argument("--points", type=int, default=13, metavar="N", help="along each side of the window (13)")
    add_output_options(parser)


@command(
    NAME,
    "Linearise a swim with fins that hold its roll over a period of its gait, and draw where "
    "disturbances decay, over two numbers of the fins.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    check_least(options, points=2)
    if options.page:
        outputs = Outputs(NAME, options, PARTS)
        outputs.write(page_parts(outputs, options.points))
        return
    swim = chosen(options.swim or "straight", options)
    swim = swim if swim.fins else swim.changed(fins=fins_from_text(PAIR))
    axes = axes_from(options.over or OVER)
    window = roll_window(swim, {axis.name: (axis.low, axis.high) for axis in axes}, options.points)
    outputs, found = Outputs(NAME, options), linearised(swim)
    print(f"growth                      {found.growth:.4g} a period, of {found.motion_of(0)} (error {found.error:.1g})")
    held = ", ".join(f"{name} = {value:.3g}" for name, value in window.best.items())
    print(f"held                        {int(window.held.sum())} of {window.held.size} points of the window")
    print(f"decays fastest              to {np.nanmin(window.growth):.3g} a period, at {held}")
    outputs.draw("roll_hold", window.map.title, lambda figure: draw_windows(figure, [window]), (SIZE[0] / 2, SIZE[1]))


def page_parts(outputs: Outputs, points: int) -> dict[str, str]:
    """The parts of the page, with windows of `points` by `points`."""
    ahead, amidships = holding(1e-3, 2.0), fins_from_text(PAIR)
    windows = [
        roll_window(_swim(straight(), fins), ranges_of("--over", OVER), points, f"fins at X = {fins[0].station:g} m")
        for fins in (ahead, amidships)
    ]
    draw = partial(draw_windows, windows=windows)
    picture = outputs.draw("roll_hold", "Growth over area and gain", draw, SIZE, ("png",))
    outputs.write_table("fins", _swims(amidships))
    return {"gaits": _gaits(ahead, amidships), "window": picture}


def draw_windows(figure: Any, windows: list[RollWindow]) -> None:
    """Growth per period over two numbers, side by side. Inside the line disturbances decay."""
    for part, window in zip(np.atleast_1d(figure.subfigures(1, len(windows))), windows, strict=True):
        item, growth = window.map, window.growth
        label = "growth in a period, log10: below 0 roll is held"
        axes = draw_map(part, item, growth, label, "both", cmap="PuOr_r", vmin=-0.6, vmax=0.6)
        axes.tick_params(which="minor", labelbottom=False, labelleft=False)
        if window.held.any() and not window.held.all():
            axes.contour(item.x, item.y, growth, [1.0], colors="black", linewidths=1.2)


def _swim(law: Law, fins: tuple[Fin, ...]) -> Swim:
    return Swim(law, accuracy=Accuracy.of(1e-3), fins=fins)


def _swims(amidships: tuple[Fin, ...]) -> Table:
    rows = []
    cases = [(holding(area, k_p) if area else (), *expected) for (area, k_p), expected in EXPECTED.items()]
    for fins, roll, depth, side in (*cases, (amidships, "", "", "")):
        growth = linearised(_swim(straight(), fins), estimate=False).growth
        rolled, sunk, _ = swum(straight(), LONG, fins, PUSH)
        aside = swum(falling(), DIVE, fins)[2]
        about = [(f"{each.station:g} m", f"{1e4 * each.area:g} cm²", f"{each.angle.k_p:g}") for each in fins[:1]]
        own = f"{growth:.2f}", f"{rolled:.2g} rad", roll, f"{sunk:.2g} m", depth, f"{aside:.2g} m", side
        rows.append((*(about or [("none", "", "")])[0], *own))
    head = "X", "area a side", "k_p", "growth", "roll", "expected", "depth", "expected", "to the side", "expected"
    return Table(head, rows)


def _gaits(ahead: tuple[Fin, ...], amidships: tuple[Fin, ...]) -> str:
    rows = []
    for name, law in GAITS.items():
        found = [linearised(_swim(law, fins), estimate=False) for fins in ((), ahead, amidships)]
        rows.append((name, *(f"{each.growth:.2f}" for each in found)))
    pairs = (f"X = {fins[0].station:g} m, {1e4 * fins[0].area:g} cm²" for fins in (ahead, amidships))
    return table(("gait", "no fins", *pairs), rows)
