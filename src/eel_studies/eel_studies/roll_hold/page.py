# SPDX-License-Identifier: Apache-2.0
"""What docs/howto/fins.md tells of fins that hold the roll: long swims, multipliers of gaits, and the windows."""

from typing import Any

import numpy as np
from eel_base.files.markdown import table
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.runs.swim import Swim
from eel_gaits.laws.law import Law
from eel_model.fins.fins import Fin
from eel_model.fins.text import fins_from_text

from eel_gaits import falling, straight, turning
from eel_studies.outputs import Outputs, Table
from eel_studies.points import base_point
from eel_studies.roll_hold.study import PAIR, RollWindow, holding, linearised, roll_window, swum
from eel_studies.stability.report import draw_map

PARTS = "gaits", "window"
SIZE = 9.0, 4.0  # inches
PUSH, LONG, DIVE = 0.05, 40.0, 10.0  # rad/s of roll at the start; s, of the straight and of the falling gait
EXPECTED = {  # area [m^2], k_p of a pair at X = 0.2 m: roll, depth, way to the side by an independent prototype
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
OVER = {"fins.area": (2e-4, 5e-3), "fins.k_p": (0.5, 16.0)}  # m^2, of a fin; 1


def page_parts(outputs: Outputs, points: int) -> dict[str, str]:
    """The parts of the page, with windows of so many `points` along each side."""
    ahead, amidships = holding(1e-3, 2.0), fins_from_text(PAIR)
    windows = [roll_window(_swim(straight(), fins), OVER, points) for fins in (ahead, amidships)]
    for window, fins in zip(windows, (ahead, amidships), strict=True):
        object.__setattr__(window.map, "title", f"fins at X = {fins[0].station:g} m")
    picture = outputs.draw(
        "roll_hold", "Growth over area and gain", lambda figure: draw_windows(figure, windows), SIZE, ("png",)
    )
    outputs.write_table("fins", _swims(amidships))
    return {"gaits": _gaits(ahead, amidships), "window": picture}


def draw_windows(figure: Any, windows: list[RollWindow]) -> None:
    """Growth in a period over two numbers, side by side; within the line disturbances decay."""
    for part, window in zip(np.atleast_1d(figure.subfigures(1, len(windows))), windows, strict=True):
        item, growth = window.map, window.growth
        label = "growth in a period, log10: below 0 roll is held"
        axes = draw_map(part, item, growth, label, "both", cmap="PuOr_r", vmin=-0.6, vmax=0.6)
        axes.tick_params(which="minor", labelbottom=False, labelleft=False)
        if window.held.any() and not window.held.all():
            axes.contour(item.x, item.y, growth, [1.0], colors="black", linewidths=1.2)


def _swim(law: Law, fins: tuple[Fin, ...]) -> Swim:
    return base_point(None, None, Accuracy.of(1e-3))._replace(law=law, fins=fins)


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
