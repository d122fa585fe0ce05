# SPDX-License-Identifier: Apache-2.0
"""Effect of the paper's misprints on its own run, and a second body beside published numbers.

Each reading of the formulae is a `Scene` for the same falling gait. Two corrections have no option: the sign of the
loads on the nose and that of the local Reynolds number. Without them the equations contradict each other. The second
body is the eel of Kern and Koumoutsakos, J. Exp. Biol. 209 (2006), 4841-4857, doi:10.1242/jeb.02526, who computed the
flow from the Navier-Stokes equations in three dimensions.
"""

from typing import Any

import numpy as np
from eel_dynamics.analysis.analysis import Analysis
from eel_studies.outputs import Table
from eel_studies.points import AccuracyLike

from eel_dynamics import Body, Run, Scene, simulate
from eel_gaits import falling, kern_efficient, kern_fast

READINGS: dict[str, dict[str, Any]] = {  # label: what differs from the library's own reading
    "the library's own: perimeter and added mass corrected, friction as printed": {},
    "perimeter as printed, half of an ellipse's": {"perimeter": "printed"},
    "friction blended over its transition, where the printed one jumps": {"friction": "blended"},
    "friction laminar all along": {"friction": "laminar"},
    "added mass as printed in (37), half-axes exchanged": {"added_mass": "printed"},
    "perimeter, friction and added mass as printed": dict.fromkeys(("perimeter", "friction", "added_mass"), "printed"),
}
COLUMNS = (
    *("reading of the formulae", "head at the end, x, y, z [m]", "apart [m]", "mean speed U [m/s]"),
    *("peak torque [N m]", "in the later half [N m]"),
)
OWN, PRINTED = next(iter(READINGS)), list(READINGS)[-1]
VISCOSITY = 1.4e-4  # L^2/T of the computed flow: Reynolds numbers of some thousands
FASTEST = 0.5  # L per cycle, of the gaits computed
THEIRS = {  # of `Analysis`: in words, and what was computed of it
    "stride": ("mean speed U, stride U T/L", "0.26 to 0.5 over all their gaits; the fast one +42 %"),
    "strouhal": ("Strouhal number f A/U", "live eels near 0.32 (Tytell 2004), at higher Re"),
    "slip": ("slip U T/lambda", ""),
    "reynolds": ("Reynolds number U L/nu", "about 4e3"),
    "propulsive_efficiency": ("propulsive efficiency", "defined otherwise; the fast one -15 %"),
    "hydromechanical_efficiency": ("hydromechanical efficiency", "defined otherwise; the fast one -15 %"),
}


def swim_readings(accuracy: AccuracyLike = "fine", sample_period: float = 0.02, stations: int = 101) -> dict[str, Run]:
    """The falling gait with each of the `READINGS`, by label; runs in the paper's axes.

    sample_period: [s]. accuracy, stations: as in `simulate`.
    """
    how: dict[str, Any] = {"accuracy": accuracy, "sample_period": sample_period, "stations": stations}
    return {
        label: simulate(falling(), 10.0, scene=Scene(**reading), **how).in_axes("paper")
        for label, reading in READINGS.items()
    }


def table_of_readings(runs: dict[str, Run]) -> Table:
    """The readings as a table."""
    cells = []
    for label, run in runs.items():
        apart = np.linalg.norm(run.position[-1] - runs[OWN].position[-1])
        torque, place, time = run.greatest_torque()
        peak, found = f"{torque:.3f} at X = {place:.2f} m, t = {time:.2f} s", run.analysis()
        end = ", ".join(f"{each:+.3f}" for each in run.position[-1])
        figures = f"{apart:.3f}", f"{found.mean_speed:.3f}", peak, f"{found.peak_torque.max():.3f}"
        cells.append((label, f"({end})", *figures))
    return Table(COLUMNS, cells)


def swim_kern() -> tuple[Analysis, Analysis]:
    """20 periods of the fast and of the efficient gait from rest, with L = 1 m and T = 1 s."""
    how: dict[str, Any] = {"body": Body.kern2006(), "scene": Scene(viscosity=VISCOSITY), "accuracy": "standard"}
    return simulate(kern_fast(), 20.0, **how).analysis(), simulate(kern_efficient(), 20.0, **how).analysis()


def table_of_kern(fast: Analysis, efficient: Analysis) -> Table:
    """Our results beside the published ones."""
    rows = []
    for name, (words, theirs) in THEIRS.items():
        one, other = getattr(fast, name), getattr(efficient, name)
        rows.append((words, f"{one:.4g}", f"{other:.4g}", f"{one / other - 1.0:+.1%}", theirs))
    return Table(("quantity", "kern_fast", "kern_efficient", "the former by the latter", "computed flow"), rows)
