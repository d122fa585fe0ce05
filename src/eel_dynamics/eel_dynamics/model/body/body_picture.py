# SPDX-License-Identifier: Apache-2.0
"""The picture of a body: its outlines from above and from the side."""

from typing import Any

import numpy as np
from eel_common.cell import BLUE, ORANGE, figure

POINTS = 400


def picture_of_body(body: Any) -> Any:
    """A matplotlib figure of the outlines from the side and from above, one above the other, to the same scale."""
    x = body.length * np.sin(np.linspace(0.0, np.pi / 2, POINTS)) ** 2  # dense at the ends
    made, ((axes,),) = figure(6.4, 1.9)
    for half, name, colour in (
        (body.half_height(x), "height, from the side", ORANGE),
        (body.half_width(x), "width, from above", BLUE),
    ):
        axes.fill_between(x, -half, half, color=colour, alpha=0.25, linewidth=0)
        axes.plot(x, half, x, -half, color=colour, linewidth=1.0)
        axes.plot([], color=colour, label=name)
    for each in body.appendages:
        axes.plot(each.x, each.z or each.y, "s", color="#444444", markersize=3)
    for kink in body.kinks:
        axes.axvline(kink, color="#888888", linewidth=0.5, linestyle=":")
    axes.set(aspect="equal", xlabel="X from the nose [m]", ylabel="[m]", xlim=(-0.08 * body.length, 1.08 * body.length))
    for end, name, aside in ((0.0, "nose", "right"), (1.0, "tail", "left")):
        gap = (2.0 * end - 1.0) * 0.015 * body.length
        axes.text(end * body.length + gap, 0.0, name, ha=aside, va="center", fontsize="small")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    return made


def lines_of_body(body: Any) -> str:
    """Its numbers, with units."""
    x = np.linspace(0.0, body.length, POINTS)
    return (
        f"{body.name}: length {body.length:g} m, mass {body.mass:.4g} kg, mean density {body.density:.4g} kg/m^3\n"
        f"width at most {2e3 * body.half_width(x).max():.3g} mm, height {2e3 * body.half_height(x).max():.3g} mm, "
        f"volume {1e3 * body.volume:.4g} l\n"
        f"drag coefficients: lateral {_said(body.lateral_drag)}, vertical {_said(body.vertical_drag)}, "
        f"roll {body.roll_drag:g}, nose {body.nose_drag:g}, base {body.base_drag:g}, links {body.joint_drag:g}"
        f"{_appendages(body)}"
    )


def _said(given: Any) -> str:
    return (
        given if isinstance(given, str) else f"{given:g}" if np.ndim(given) == 0 and not callable(given) else "along X"
    )


def _appendages(body: Any) -> str:
    if not body.appendages:
        return ""
    area = 1e4 * body.appendage_factor * sum(each.drag1 for each in body.appendages)
    return f"\n{len(body.appendages)} appendages, C_D A along the body {area:.4g} cm^2 in all"
