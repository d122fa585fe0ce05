# SPDX-License-Identifier: Apache-2.0
"""How an object is shown in a notebook's cell: a small picture, and its numbers."""

import base64
import html
import io
from collections.abc import Callable
from typing import Any

BLUE, ORANGE, GREY = "#0072B2", "#D55E00", "#888888"  # the palette of Okabe and Ito
STYLE: Any = {"font.size": 8.5, "axes.titlesize": "medium", "axes.spines.top": False, "axes.spines.right": False}
DOTS = 90  # per inch


def figure(width: float, height: float, panels: tuple[int, int] = (1, 1), **more: Any) -> tuple[Any, Any]:
    """A matplotlib figure of `width` x `height` [inches] with `panels` (rows, columns), and its axes (rows, columns).

    more: arguments of `subplots`. `ImportError` without matplotlib.
    """
    try:
        from matplotlib import rc_context
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ImportError("a picture needs matplotlib: pip install matplotlib") from error
    with rc_context(STYLE):
        made = Figure(figsize=(width, height), layout="constrained", facecolor="white")
        return made, made.subplots(*panels, squeeze=False, **more)


def cell_of(draw: Callable[[], Any], text: str) -> str:
    """HTML of the figure that `draw` makes, above the `text`. Without matplotlib, or on an error, the text alone."""
    lines = f"<pre style='line-height:1.3'>{html.escape(text)}</pre>"
    try:
        made, file = draw(), io.BytesIO()
        made.savefig(file, format="png", dpi=DOTS)
    except (ImportError, ValueError):
        return lines
    picture = base64.b64encode(file.getvalue()).decode()
    return f"<img alt='' src='data:image/png;base64,{picture}' style='max-width:100%'/>{lines}"
