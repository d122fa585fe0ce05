# SPDX-License-Identifier: Apache-2.0
"""The results of the maps, and the explicit treatment of the added mass, as Markdown tables."""

import numpy as np
from eel_base.files.markdown import table

from eel_studies.stability.explicit import STEPS, treat
from eel_studies.stability.maps import ACCURATE, INACCURATE, STOPPED, TARGET

HEAD = (
    *("map", "accurate", "inaccurate", "of them warned of", "of them shown by the estimate", "by neither", "stopped"),
    *("beyond a limit of the model, and warned of", "worst error by target", "most steps"),
)
EXPLICIT_HEAD = (
    *("density of the body, by water's", "growth per step", "explicit acceleration, by the right one"),
    "condition of the 6 x 6 matrix",
)
RATIOS = (1e-3, 1e-2, 1e-1, 0.5, 1.0, 10.0, 1e3)


def report(maps) -> str:
    """Counts and greatest errors of the maps, then the explicit treatment of the added mass, as Markdown."""
    rows = []
    for each in maps:
        accurate, inaccurate, stopped = (each.outcome == kind for kind in (ACCURATE, INACCURATE, STOPPED))
        estimated, warned = each.estimate > 1.0, inaccurate & (each.warned | each.limits)
        neither = inaccurate & ~warned & ~estimated
        counts = accurate, inaccurate, warned, estimated, neither, stopped, each.limits
        cells = [str(np.sum(kind)) for kind in counts]
        rows.append([each.map.title, *cells, f"{each.worst:.2g}", str(each.steps.max())])
    reasons = sorted({_reason(text) for each in maps for text in each.reason.ravel() if text})
    explicit = [
        (f"{each.ratio:g}", f"{each.growth:.3g}", f"{each.explicit:.3g}", f"{each.condition:.3g}")
        for each in map(treat, RATIOS)
    ]
    return "\n".join(
        [
            table(HEAD, rows),
            "",
            f"Accurate: the head within {TARGET:g} (a preset: its target) of its path, or of the body if longer, of a "
            "finer run's.",
            f"Reasons of the stops: {'; '.join(reasons) or 'none'}.",
            "",
            "The added mass is implicit in the 6 x 6 matrix. Treated explicitly, with the acceleration of the step "
            "before, it is unstable",
            f"wherever the growth per step exceeds 1, whatever the step; after {STEPS} steps:",
            "",
            table(EXPLICIT_HEAD, explicit),
        ]
    )


def _reason(text: str) -> str:
    """The reason in a stop's message, without time and value."""
    return text.partition("s: ")[2].partition(" (")[0]
