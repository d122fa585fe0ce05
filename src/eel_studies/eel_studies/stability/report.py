# SPDX-License-Identifier: Apache-2.0
"""The studies by name. Each returns its part of the page, and draws its pictures."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from eel_base.files.markdown import table

from eel_studies.outputs import Outputs
from eel_studies.stability import inertia, long_runs
from eel_studies.stability.drawing import draw, draw_map
from eel_studies.stability.extremes import maps_of
from eel_studies.stability.maps import (
    OUTCOMES,
    REFUSED,
    SENSITIVE,
    SILENT,
    STOPPED,
    TARGET,
    UNCHECKED,
    Measured,
    measure,
)
from eel_studies.table import Table

SIZE = 5.6, 4.2  # inches


def report(found: list[Measured], outputs: Outputs) -> str:
    """The counts of the maps, their messages, and their pictures, as Markdown."""
    lines = [counts(found).markdown(), "", f"The error is by the target, {TARGET:g} where the settings have none."]
    for outcome in (STOPPED, REFUSED, SENSITIVE, UNCHECKED, SILENT):
        said = sorted({text for each in found for text in each.texts(outcome)})
        lines += [f"{outcome.capitalize()}: {'; '.join(said)}."] if said else []
    return "\n".join([*lines, "", *(_picture(outputs, each.map, partial(draw, measured=each)) for each in found)])


def counts(found: list[Measured]) -> Table:
    """A row for each map: how many cells have which outcome."""
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


STUDIES: dict[str, Callable[[int, Outputs], str]] = {  # of so many points along each side of a map
    "maps": lambda points, outputs: report([measure(item) for item in maps_of(points)], outputs),
    "condition": conditions,
    "drift": lambda points, outputs: long_runs.drifts(),
    "plane": lambda points, outputs: long_runs.planes(),
}


def _picture(outputs: Outputs, item: Any, fill: Callable[[Any], object]) -> str:
    return outputs.draw(f"stability_{item.name}", item.title, fill, SIZE, ("svg",))
