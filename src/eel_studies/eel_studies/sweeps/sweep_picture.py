# SPDX-License-Identifier: Apache-2.0
"""The picture of a sweep: curves over one parameter, maps over two, with the place of the extremes."""

from typing import Any

import numpy as np
from eel_dynamics.analysis.measures import MEASURES

from eel_studies.pictures import BLACK, BLUE, Axes, Figure, is_wide, scale_axis
from eel_studies.varied import labelled

FIRST = "mean_speed", "cost_of_transport", "strouhal", "greatest_torque"  # drawn unless others are asked for
MOST = 6  # panels
PANEL = 3.4, 2.9  # inches
COLUMNS = {1: 1, 2: 2, 4: 2}  # of so many panels; of others 3
EXTREMES: dict[str, tuple[Any, str]] = {
    "least": (np.nanargmin, "v"),
    "most": (np.nanargmax, "^"),
}  # name: place and mark


def drawn_axes(grid: dict[str, list[Any]]) -> list[str]:
    """The one or two names of `grid` with several values: the axes. `ValueError` for another number of them."""
    names = [name for name, values in grid.items() if len(values) > 1]
    if not 1 <= len(names) <= 2:
        raise ValueError(f"--plot needs one or two --vary with several values, got {len(names)}")
    return names


def drawn_measures(data: Any, asked: tuple[str, ...] = ()) -> list[str]:
    """The measures in `data` to draw: those `asked` for, else `FIRST`; without those that are nowhere defined."""
    return [name for name in asked or FIRST if name in data and bool(data[name].notnull().any())][:MOST]


def size_of(count: int) -> tuple[float, float]:
    """Width and height [inches] of the picture of `count` measures."""
    rows, columns = _shape(count)
    return PANEL[0] * columns, PANEL[1] * rows


def draw_sweep(figure: Figure, data: Any, names: list[str], measures: list[str]) -> None:
    """Draw the `measures` of a sweep's `data` over its axes `names` into an empty matplotlib figure."""
    panels = figure.subplots(*_shape(len(measures)), squeeze=False).ravel()
    for axes, measure in zip(panels, measures, strict=False):
        found = data[measure].squeeze().sortby([name for name in names if _numeric(data[name].values)])
        values, places = found.transpose(*names[::-1]), [_places(found[name].values) for name in names]
        axes.set_title(f"{measure.replace('_', ' ')}{_unit(measure)}", fontsize="medium")
        if len(names) == 1:
            _draw_curve(axes, places[0], values.values)
        else:
            _draw_map(axes, places[0], places[1], values.values)
        for set_axis, name in zip((axes.set_xlabel, axes.set_ylabel), names, strict=False):
            set_axis(labelled(name))
        for dimension, name in zip("xy", names, strict=False):
            _mark_values(axes, dimension, values[name].values)
        _mark_extremes(axes, places, values.values)
    for axes in panels[len(measures) :]:
        axes.set_axis_off()


def extremes_of(array: Any) -> str:
    """Least and greatest value of a labelled `array`, each with its place if that is one: "0.2 (period 2) to 0.4"."""
    told = []
    for place, _ in EXTREMES.values():
        value = array.values.flat[int(place(array.values))]
        where = np.argwhere(array.values == value)
        names = [name for name in array.dims if array.sizes[name] > 1]
        if len(where) == 1 and names:
            at = dict(zip(array.dims, where[0], strict=True))
            told.append(f"{value:.4g} ({', '.join(f'{name} {_word(array[name].values[at[name]])}' for name in names)})")
        else:
            told.append(f"{value:.4g}")
    return " to ".join(told)


def _shape(count: int) -> tuple[int, int]:
    columns = COLUMNS.get(count, 3)
    return -(-count // columns), columns


def _draw_curve(axes: Axes, x: np.ndarray, values: np.ndarray) -> None:
    axes.plot(x, values, color=BLUE, marker="o", markersize=3.0, linewidth=1.2)
    axes.margins(y=0.18)


def _draw_map(axes: Axes, x: np.ndarray, y: np.ndarray, values: np.ndarray) -> None:
    axes.grid(False)
    mesh = axes.pcolormesh(_edges(x), _edges(y), values, cmap="cividis", edgecolors="none")
    axes.figure.colorbar(mesh, ax=axes)


def _mark_values(axes: Axes, dimension: str, values: np.ndarray) -> None:
    """Words on the axis for values that are no numbers, and a logarithmic axis for numbers over a wide range."""
    if not _numeric(values):
        getattr(axes, f"set_{dimension}ticks")(np.arange(len(values)), [_word(value) for value in values])
    else:
        scale_axis(axes, values, dimension)


def _mark_extremes(axes: Axes, places: list[np.ndarray], values: np.ndarray) -> None:
    """A mark with the value at the least and the greatest of `values`, over the `places` along each axis."""
    found = [np.unravel_index(int(place(values)), values.shape)[::-1] for place, _ in EXTREMES.values()]
    for (name, (_, mark)), at in zip(EXTREMES.items(), found, strict=True):
        point = [float(along[k]) for along, k in zip(places, at, strict=True)]
        text = f"{name} {values[at[::-1]]:.3g}"
        point = point if len(point) == 2 else [*point, float(values[at[::-1]])]
        axes.plot(*point, mark, color="white", markeredgecolor=BLACK, markersize=7, clip_on=False, zorder=5)
        aside = "left" if at[0] < len(places[0]) / 2 else "right"
        in_a_row = len(places) == 1 or found[0][-1] == found[1][-1]
        above = name == "most" if in_a_row else at[-1] < len(places[-1]) / 2
        box = {"facecolor": "white", "alpha": 0.75, "pad": 1.0, "linewidth": 0.0}
        offset = 6.0 if aside == "left" else -6.0, 7.0 if above else -7.0
        look = {"ha": aside, "va": "bottom" if above else "top", "fontsize": "small", "bbox": box, "zorder": 6}
        axes.annotate(text, point, xytext=offset, textcoords="offset points", **look)


def _numeric(values: np.ndarray) -> bool:
    return values.dtype.kind in "iuf"


def _places(values: np.ndarray) -> np.ndarray:
    """Where the `values` (n,) of an axis lie: numbers at themselves, words one after the other."""
    return values.astype(float) if _numeric(values) else np.arange(len(values), dtype=float)


def _edges(places: np.ndarray) -> np.ndarray:
    """Borders (n + 1,) of cells around `places` (n,): halfway between neighbours, by ratio where the range is wide."""
    if is_wide(places):
        return np.asarray(places[0] * np.exp(_edges(np.log(places / places[0]))))
    middles = 0.5 * (places[1:] + places[:-1])
    return np.concatenate(([2.0 * places[0] - middles[0]], middles, [2.0 * places[-1] - middles[-1]]))


def _unit(measure: str) -> str:
    unit = MEASURES[measure][0]
    return f" [{unit}]" if unit else ""


def _word(value: Any) -> str:
    return f"{value:g}" if isinstance(value, (int, float, np.number)) else str(value)
