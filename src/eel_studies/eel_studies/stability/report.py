# SPDX-License-Identifier: Apache-2.0
"""The studies by name. Each returns its part of the page, and draws its pictures."""

from collections.abc import Callable
from functools import partial
from typing import Any

from eel_base.files.markdown import table
from eel_model.inertia import MOST

from eel_studies.outputs import Outputs
from eel_studies.stability import condition, drift, plane
from eel_studies.stability.drawing import draw, draw_map
from eel_studies.stability.explicit import STEPS, treat
from eel_studies.stability.extremes import maps_of
from eel_studies.stability.maps import (
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
from eel_studies.table import Table

SIZE = 5.6, 4.2  # inches
EXPLICIT_COLUMNS = (
    *("density of the body, by water's", "growth per step", "explicit acceleration, by the right one"),
    "condition of the 6 x 6 matrix",
)
RATIOS = (1e-3, 1e-2, 1e-1, 0.5, 1.0, 10.0, 1e3)


def maps(points: int, outputs: Outputs) -> str:
    """Maps of runs over two numbers, with `points` values of each, and the explicit treatment of the added mass."""
    text = report([measure(item) for item in maps_of(points)], outputs)
    explicit = [
        (f"{each.ratio:g}", f"{each.growth:.3g}", f"{each.explicit:.3g}", f"{each.condition:.3g}")
        for each in map(treat, RATIOS)
    ]
    return f"""{text}

The added mass is implicit in the 6 x 6 matrix. Treated explicitly, with the acceleration of the step before, it is
unstable wherever the growth per step exceeds 1, whatever the step; after {STEPS} steps:

{table(EXPLICIT_COLUMNS, explicit)}"""


def report(found: list[Measured], outputs: Outputs) -> str:
    """The counts of the maps, their messages, and their pictures, as Markdown."""
    pictures = [_picture(outputs, each.map, partial(draw, measured=each)) for each in found]
    lines = [counts(found).markdown(), "", f"The error is by the target, {TARGET:g} where the settings have none."]
    for outcome in (STOPPED, REFUSED, SENSITIVE, UNCHECKED, SILENT):
        said = sorted({text for each in found for text in each.texts(outcome)})
        lines += [f"{outcome.capitalize()}: {'; '.join(said)}."] if said else []
    return "\n".join([*lines, "", *pictures])


def counts(found: list[Measured]) -> Table:
    """A row for each map: how many cells have which outcome."""
    rows = []
    for each in found:
        texts = [str(each.count(outcome)) for outcome in OUTCOMES]
        limits, steps = each.cells["limits"].sum(), each.cells["steps"].max()
        rows.append([each.map.title, *texts, str(limits), f"{each.worst:.2g}", str(steps)])
    return Table(("map", *OUTCOMES, "beyond a limit of the model", "worst error by target", "most steps"), rows)


def conditions(points: int, outputs: Outputs) -> str:
    """Maps of the condition number of the 6 x 6 matrix, with `points` values of each parameter; singular bodies."""
    rows, pictures = [], []
    for item in condition.maps_of(points):
        values = item.values()
        rows.append((item.title, f"{values.min():.3g}", f"{values.max():.3g}"))
        fill = partial(draw_map, item=item, values=values, label="condition, log10", cmap="cividis")
        pictures.append(_picture(outputs, item, fill))
    refused = f"Bodies of a condition above {MOST:g} are refused as singular:"
    return "\n".join([table(("map", "least", "greatest"), rows), "", refused, "", condition.needles(), "", *pictures])


def drifts(points: int, outputs: Outputs) -> str:
    """Drift over 100,000 periods; `points` has no effect."""
    return drift.table([drift.drift_of(name, *each) for name, each in drift.swimmers().items()])


def planes(points: int, outputs: Outputs) -> str:
    """Growth of round-off out of the plane of a planar law; `points` has no effect."""
    return plane.table()


STUDIES: dict[str, Callable[[int, Outputs], str]] = {
    "maps": maps,
    "condition": conditions,
    "drift": drifts,
    "plane": planes,
}


def _picture(outputs: Outputs, item: Map, fill: Callable[[Any], object]) -> str:
    return outputs.draw(f"stability_{item.name}", item.title, fill, SIZE, ("svg",))
