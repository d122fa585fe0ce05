# SPDX-License-Identifier: Apache-2.0
"""The studies by name. Each returns its part of the page, and draws its pictures.

Colour shows the error relative to the target. Marks show the other outcomes, and warnings.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from eel_common.files.markdown import table

from eel_studies.outputs import Outputs, Table
from eel_studies.pictures import BLACK, ORANGE
from eel_studies.stability import inertia, long_runs
from eel_studies.stability.extremes import maps_of
from eel_studies.stability.maps import (
    INACCURATE,
    OUTCOMES,
    REFUSED,
    SENSITIVE,
    SILENT,
    STOPPED,
    TARGET,
    UNCHECKED,
    Map,
    Measured,
    measure,
)

SIZE = 5.6, 4.2  # inches
DECADES = 3.0  # range of the colours, above and below the target
MARKS = {  # outcome: mark, size, label
    STOPPED: ("x", 5, "stopped with a message"),
    REFUSED: ("_", 5, "refused"),
    SENSITIVE: ("^", 4, "sensitive, said"),
    INACCURATE: ("+", 5, "inaccurate, said"),
    UNCHECKED: ("1", 5, "no finer run to check by"),
    SILENT: ("*", 9, "WRONG IN SILENCE"),
}


def report(found: list[Measured], outputs: Outputs) -> str:
    """The counts of the maps, their messages, and their pictures, as Markdown."""
    lines = [counts(found).markdown(), "", f"The error is by the target, {TARGET:g} where the settings have none."]
    for outcome in (STOPPED, REFUSED, SENSITIVE, UNCHECKED, SILENT):
        said = sorted({text for each in found for text in each.texts(outcome)})
        lines += [f"{outcome.capitalize()}: {'; '.join(said)}."] if said else []
    return "\n".join([*lines, "", *(_picture(outputs, each.map, partial(draw, measured=each)) for each in found)])


def counts(found: list[Measured]) -> Table:
    """A row for each map: the number of cells with each outcome."""
    rows = []
    for each in found:
        texts = [str(each.count(outcome)) for outcome in OUTCOMES]
        limits, steps = each.cells["limits"].sum(), each.cells["steps"].max()
        rows.append([each.map.title, *texts, str(limits), f"{each.worst:.2g}", str(steps)])
    return Table(("map", *OUTCOMES, "beyond a limit of the model", "worst error by target", "most steps"), rows)


def conditions(points: int, outputs: Outputs) -> str:
    """Maps of the condition number of the 6 x 6 matrix; singular bodies."""
    rows, pictures = [], []
    for item in inertia.maps_of(points):
        values = item.values()
        least, most, refused = np.nanmin(values), np.nanmax(values), np.isnan(values).sum()
        rows.append((item.title, f"{least:.3g}", f"{most:.3g}", str(refused)))
        fill = partial(draw_map, item=item, values=values, label="condition, log10", cmap="cividis")
        pictures.append(_picture(outputs, item, fill))
    return "\n".join([table(("map", "least", "greatest", "refused"), rows), "", inertia.explicit(), "", *pictures])


STUDIES: dict[str, Callable[[int, Outputs], str]] = {  # arguments: points along each side of a map, outputs
    "maps": lambda points, outputs: report([measure(item) for item in maps_of(points)], outputs),
    "condition": conditions,
    "drift": lambda points, outputs: long_runs.drifts(),
    "plane": lambda points, outputs: long_runs.planes(),
}


def _picture(outputs: Outputs, item: Any, fill: Callable[[Any], object]) -> str:
    return outputs.draw(f"stability_{item.name}", item.title, fill, SIZE, ("svg",))


def draw(figure: Any, measured: Measured) -> None:
    """Draw one map into an empty matplotlib figure."""
    item, cells = measured.map, measured.cells
    colours = {"cmap": "PuOr_r", "vmin": -DECADES, "vmax": DECADES}
    axes = draw_map(figure, item, cells["size"], "error / target, log10: accurate below 0", "both", **colours)
    marked = [(cells["outcome"] == outcome, *mark) for outcome, mark in MARKS.items()]
    for where, mark, size, label in (*marked, (cells["limits"], ".", 2.5, "warned: a limit of the model")):
        row, column = np.nonzero(where)
        if len(row):
            colour = ORANGE if mark == "*" else BLACK
            axes.plot(item.x[column], item.y[row], mark, color=colour, markersize=size, label=label)
    if axes.lines:
        figure.legend(loc="outside lower center", ncols=3)
    if item.up.choices:
        names = [" ".join(map(str, each)) if isinstance(each, tuple) else each for each in item.up.choices]
        axes.set_yticks(item.y, names)
        axes.set_yticks([], minor=True)


def draw_map(figure: Any, item: Map, values: np.ndarray, label: str, extend: str = "neither", **colours: Any) -> Any:
    """Draw the decadic logarithms of `values` (len(y), len(x)), with a colour bar. Returns the axes."""
    axes = figure.subplots()
    axes.grid(False)
    size = np.log10(np.maximum(values, 1e-300))
    mesh = axes.pcolormesh(_edges(item.x), _edges(item.y), size, edgecolors="none", **colours)
    axes.set(xscale="log", yscale="log", xlabel=item.across.label, ylabel=item.up.label)
    axes.set_title(item.title, fontsize="medium")
    figure.colorbar(mesh, ax=axes, extend=extend).set_label(label)
    return axes


def _edges(values: np.ndarray) -> np.ndarray:
    """Borders (n + 1,) of the cells around `values` (n,), which form a geometric sequence."""
    factor = np.sqrt(values[1] / values[0])
    return np.append(values / factor, values[-1] * factor)
