# SPDX-License-Identifier: Apache-2.0
"""The picture of a body: its outlines from above and from the side."""

from typing import Any

import numpy as np
from eel_base.cell import BLUE, ORANGE, figure

POINTS = 400


def picture_of_body(body: Any) -> Any:
    """A matplotlib figure of the outlines from the side and from above, one over the other, in one scale."""
    x = body.length * np.sin(np.linspace(0.0, np.pi / 2, POINTS)) ** 2  # dense at the ends
    made, ((axes,),) = figure(6.4, 1.9)
    for half, name, colour in (
        (body.half_height(x), "height, from the side", ORANGE),
        (body.half_width(x), "width, from above", BLUE),
    ):
        axes.fill_between(x, -half, half, color=colour, alpha=0.25, linewidth=0)
        axes.plot(x, half, x, -half, color=colour, linewidth=1.0)
        axes.plot([], color=colour, label=name)
    for kink in body.kinks:
        axes.axvline(kink, color="#888888", linewidth=0.5, linestyle=":")
    axes.set(aspect="equal", xlabel="X from the nose [m]", ylabel="[m]", xlim=(-0.01 * body.length, 1.01 * body.length))
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    return made


def lines_of_body(body: Any) -> str:
    """Its numbers, with units."""
    x = np.linspace(0.0, body.length, POINTS)
    return (
        f"{body.name}: length {body.length:g} m, mass {body.mass:.4g} kg, mean density {body.density:.4g} kg/m^3\n"
        f"width at most {2e3 * body.half_width(x).max():.3g} mm, height {2e3 * body.half_height(x).max():.3g} mm, "
        f"volume {1e3 * body.volume:.4g} l\n"
        f"drag coefficients: lateral {body.lateral_drag:g}, vertical {body.vertical_drag:g}, roll {body.roll_drag:g}, "
        f"nose {body.nose_drag:g}"
    )
