# SPDX-License-Identifier: Apache-2.0
"""Texts in a drawing or in the scene: points, so small that their labels alone are seen."""

from collections.abc import Sequence
from typing import Any, TypeVar

import rerun as rr

from eel_viz.scene3d import colours
from eel_viz.scene3d.colours import Colour

Points = TypeVar("Points", rr.Points2D, rr.Points3D)
DOT = 0.1  # pixels: no point is seen


def text_labels(
    kind: type[Points], places: Any, texts: list[str], shades: Sequence[Colour] = (), dot: float = DOT, **more: Any
) -> Points:
    """The `texts` at `places` (n, 2) or (n, 3).

    shades: their colours; none: that of labels. dot: the radius of the points [pixels].
    """
    shades = shades or [colours.LABEL] * len(texts)
    radius = rr.Radius.ui_points(dot)
    return kind(places, labels=texts, colors=shades, show_labels=True, radii=radius, **more)
