# SPDX-License-Identifier: Apache-2.0
"""The panels of a body's grid: where the body is cut along X, and the number of points in each panel."""

import math
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from eel_dynamics.model.body.grid import Panel

FILLED = 8  # the number of nodes is a multiple of this, a block for any processor
WIDEST_PANEL = 24  # points; a longer panel is cut into equal parts
LONG_OF_ROBOT = 4.0 / 3.0  # factor for the points of a long panel if modes bend others
CLOSEST = 1e-3  # lengths: least distance of a panel's end at a law's knot from a kink of the body


@lru_cache(maxsize=256)
def panels_of(
    body: Any, resolution: float, knots: tuple[float, ...] = (), wrench: bool = True, edges: tuple[float, ...] = ()
) -> tuple[Panel, ...]:
    """Panels between the kinks of `body`, the `knots` [m] of a law's splines and the `edges` [m] of a robot's modes.

    Together they have about `resolution` points per body length, and each has three to spare. With `edges`, each has at
    least 2 + (resolution + 1.5) / 8: a mode bends a joint's short panel, which must become finer with the others. With
    three points the torque of a stiff joint that starts is wrong by 0.008 to 0.04, with four by 2e-5, with five by
    1e-7. The part behind the last joint needs more points per length than a bent body, or its torque is wrong by 0.001
    at 18. If the internal `wrench` is wanted, the first panel has more points, as body and loads behave like roots of X
    there (these sections weigh little). So has the last panel if they do so at the tail.

    Processors handle up to eight nodes together. The grid fills such blocks: the panels closest to a further point get
    one.
    """
    least = CLOSEST * body.length
    kinks = np.array([0.0, *body.panel_ends])
    inner = [knot for knot in knots if np.min(np.abs(kinks - knot)) > least and kinks[1] < knot < body.length]
    panels, start, spare, least_points = [], 0.0, 3, 2 + nearest((resolution + 1.5) / 8.0) if edges else 0
    dense = resolution * (LONG_OF_ROBOT if edges else 1.0)
    for end in sorted({*body.panel_ends, *inner, *edges}):
        points = max(least_points, spare + nearest(dense * (end - start) / body.length))
        graded = "start" if start == 0.0 else "end" if end == body.length and body.pointed_tail else ""
        if graded:
            points = 1 + (max(points, 3 + nearest(math.sqrt(resolution))) if wrench else points)
        parts = -(-points // WIDEST_PANEL) if start > 0.0 else 1
        for left, right in pairwise(np.linspace(start, end, parts + 1).tolist()):
            kind = graded if right == end else ""
            panels.append(Panel(start=left, end=right, points=-(-points // parts), graded=kind))
        start = end
    for _ in range(-sum(panel.points for panel in panels) % FILLED):
        index = min(range(len(panels)), key=lambda k: (round(_next_resolution(panels[k], body.length, spare), 6), k))
        panels[index] = replace(panels[index], points=panels[index].points + 1)
    return tuple(panels)


def _next_resolution(panel: Panel, length: float, spare: int) -> float:
    """The resolution at which `panel` of a body of `length` [m] would get a further point."""
    return (panel.points - spare + 0.5 - (1 if panel.graded else 0)) * length / (panel.end - panel.start)


def nearest(count: float) -> int:
    """The nearest whole number, halves upwards. The last bit of `count` depends on the version of NumPy."""
    return math.floor(count + 0.5 + 1e-9)
