# SPDX-License-Identifier: Apache-2.0
"""The pictures of the studies: one style, and files (.png, .svg, .pdf) that are reproducible.

Colours are those of Okabe and Ito, distinct for colour-blind readers. Each has its own dash for print without colour.
Colour maps are perceptually uniform (cividis) or diverging without red and green (PuOr).
"""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from eel_common.files.output_file import replacing

Figure: TypeAlias = Any  # of matplotlib, which takes longer to import than all the rest
Axes: TypeAlias = Any
Draw: TypeAlias = Callable[[Figure], object]  # draws into an empty figure
BLACK, BLUE, ORANGE, GREEN, PURPLE = "#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7"
PALE_BLUE, GREY = "#d9e6f0", "#888888"
LOOKS = (  # of several curves in one panel: colour, dash, mark
    (BLUE, "-", "o"),
    (ORANGE, (0, (4, 2)), "s"),
    (GREEN, (0, (1, 1)), "^"),
    (PURPLE, (0, (6, 2, 1, 2)), "D"),
    (BLACK, (0, (2, 2)), "v"),
)
OWN = {"color": BLUE, "linewidth": 1.6, "label": "corrected"}
AS_PRINTED = {"color": ORANGE, "linewidth": 1.2, "linestyle": (0, (4, 2)), "label": "as printed"}
SETTINGS: dict[str, Any] = {
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "legend.fontsize": "small",
    "legend.frameon": False,
    "mathtext.fontset": "dejavusans",
    "svg.hashsalt": "eel",  # identical files from identical data
    "figure.dpi": 100,
    "savefig.dpi": 100,
}
PICTURES = ".png", ".svg", ".pdf"
METADATA = {".png": {"Software": None}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}  # None: left out
COLOUR_BAR = "<colorbar>"  # label that matplotlib gives the axes of a colour bar
WIDE = 5.0  # ratio of the greatest to the least value, above which an axis is logarithmic
MOST_TICKS = 7
PITCH_RAMPS = ((1.0, 3.0), (6.0, 8.0))  # s, intervals with pitch bends of the falling gait: t1 to t3 and t4 to t6


def mark_pitch(panels: Iterable[Axes]) -> None:
    """Shade the intervals in which the falling gait bends in pitch, in each of the `panels`."""
    for axes in panels:
        for start, end in PITCH_RAMPS:
            axes.axvspan(start, end, color=GREY, alpha=0.12, linewidth=0)


def legend_above(figure: Figure, columns: int = 2) -> None:
    """One legend above all panels of a figure, clear of the curves. Curves of the same name are listed once."""
    named: dict[str, Any] = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            named.setdefault(label, handle)
    figure.legend(named.values(), named.keys(), loc="outside upper center", ncols=columns, frameon=False)


def is_wide(values: Iterable[float]) -> bool:
    """Whether the axis of these `values` is logarithmic: they are above 0 and range over more than `WIDE`."""
    known = np.asarray([*values])
    return bool(known.min() > 0.0 and known.max() > WIDE * known.min())


def scale_axis(axes: Axes, values: Iterable[float], dimension: str = "x") -> None:
    """Make the axis `dimension`, x or y, logarithmic where its `values` are wide; ticks are then among them."""
    known = sorted({*values})
    if is_wide(known):
        getattr(axes, f"set_{dimension}scale")("log")
        getattr(axes, f"{dimension}axis").set_minor_locator(_no_ticks())
        ticks = known[:: -(-len(known) // MOST_TICKS)]
        getattr(axes, f"set_{dimension}ticks")(ticks, [f"{each:.3g}" for each in ticks])


def _no_ticks() -> Any:
    from matplotlib.ticker import NullLocator

    return NullLocator()


def spread(values: Iterable[float], gap: float, low: float = -np.inf) -> np.ndarray:
    """The `values` (n,), moved as little as possible until none is below `low` and no two are closer than `gap`."""
    from scipy.optimize import isotonic_regression

    given = np.asarray([*values], dtype=float)
    order, steps = np.argsort(given, kind="stable"), gap * np.arange(len(given))
    apart = np.empty_like(given)
    if len(given):
        apart[order] = np.maximum(isotonic_regression(given[order] - steps).x, low) + steps
    return apart


def along_way(points: np.ndarray, ahead: np.ndarray) -> np.ndarray:
    """The `points` (..., 2) in axes along and across the direction `ahead` (2,)."""
    x, y = ahead / np.linalg.norm(ahead)
    return np.asarray(points @ np.array([[x, -y], [y, x]]))


def letter_panels(figure: Figure) -> None:
    """Put (a), (b), ... above the panels of a figure with more than one, except colour bars."""
    panels = [axes for axes in figure.axes if axes.get_label() != COLOUR_BAR]
    for number, axes in enumerate(panels if len(panels) > 1 else ()):
        axes.set_title(f"({chr(ord('a') + number)})", loc="left", fontsize="medium", fontweight="bold")


def write_picture(draw: Draw, size: tuple[float, float], *paths: Path, settings: dict[str, Any] | None = None) -> None:
    """Draw with `draw(figure)` into an empty matplotlib figure, and write it to each of the `paths`.

    size: width and height [inches]. The suffix of a path gives the format. settings: of matplotlib, instead of those
    in `SETTINGS`. `ImportError` without matplotlib; `NotWritten` if a file cannot be completed.
    """
    import matplotlib.figure  # here: it takes longer to import than all the rest

    chosen: Any = SETTINGS | (settings or {})
    with matplotlib.rc_context(chosen):
        figure = matplotlib.figure.Figure(figsize=size, layout="constrained")
        draw(figure)
        for path in paths:
            with replacing(path) as draft:
                figure.savefig(draft, format=path.suffix[1:], metadata=METADATA[path.suffix])
