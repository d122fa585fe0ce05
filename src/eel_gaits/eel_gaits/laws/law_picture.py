# SPDX-License-Identifier: Apache-2.0
"""The picture of a curvature law: its curvature along the body, at some instants of a period."""

from typing import Any

import numpy as np
from eel_common.cell import BLUE, ORANGE, figure

INSTANTS = 8  # per period
POINTS = 121
MOST_SHOWN = 6  # terms, or numbers of a term, in a cell
NAMES = {1: ("pitch $K_2$", ORANGE), 2: ("yaw $K_3$", BLUE)}  # column: name and colour


def picture_of_law(law: Any, length: float, time: float, period: float) -> Any:
    """A matplotlib figure of `law`, a `Law` or `SampledLaw`: one curve for each instant from `time` [s] on; later ones
    are darker."""
    x = np.linspace(0.0, length, POINTS)
    instants = time + period * np.arange(INSTANTS) / INSTANTS
    values = np.array([law.curvature(at, x)[0] for at in instants])
    shown = [column for column in NAMES if np.any(values[:, :, column])] or [2]
    made, panels = figure(3.6 * len(shown), 2.4, (1, len(shown)))
    for axes, column in zip(panels[0], shown, strict=True):
        name, colour = NAMES[column]
        for k, row in enumerate(values[:, :, column]):
            axes.plot(x, row, color=colour, alpha=0.25 + 0.75 * k / (INSTANTS - 1), linewidth=1.1)
        axes.set(title=f"{name} from {time:.3g} s on, each {period / INSTANTS:.2g} s", xlim=(0.0, length))
        axes.set(xlabel="X from the nose [m]", ylabel="curvature [rad/m]")
    return made


def lines_of_law(law: Any) -> str:
    """One line for each of its first terms."""
    lines = [repr(law)]
    for term in law.terms[:MOST_SHOWN]:
        size = ", ".join(f"{value:.4g}" for value in term.amplitude[:MOST_SHOWN])
        size += ", ..." if len(term.amplitude) > MOST_SHOWN else ""
        ramps = f"{len(term.envelope)} ramps" if len(term.envelope) != 1 else "1 ramp"
        lines.append(
            f"  {term.axis:<5} amplitude ({size}), wavelength {term.wavelength:g} m, period {term.period:g} s, "
            f"phase {term.phase:.4g}, {ramps}"
        )
    if len(law.terms) > MOST_SHOWN:
        lines.append(f"  ... and {len(law.terms) - MOST_SHOWN} more")
    return "\n".join(lines)
