# SPDX-License-Identifier: Apache-2.0
"""Effect of the paper's misprints on its own run: perimeter, friction and added mass as printed and as corrected.

Each reading is a `Scene` for the same falling gait. Two corrections have no option: the sign of the loads on the nose
and that of the local Reynolds number. Without them the equations contradict each other.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_base.files.markdown import table
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.simulate import simulate
from eel_model.scene import Scene

from eel_gaits import falling
from eel_studies.points import AccuracyLike

READINGS: dict[str, dict[str, Any]] = {  # label: what differs from the library's own reading
    "the library's own: perimeter and added mass corrected, friction as printed": {},
    "perimeter as printed, half of an ellipse's": {"perimeter": "printed"},
    "friction blended over its transition, where the printed one jumps": {"friction": "blended"},
    "friction laminar all along": {"friction": "laminar"},
    "added mass as printed in (37), half-axes exchanged": {"added_mass": "printed"},
    "perimeter, friction and added mass as printed": {
        "perimeter": "printed",
        "friction": "printed",
        "added_mass": "printed",
    },
}
COLUMNS = (
    *("reading of the formulae", "head at the end, x, y, z [m]", "apart [m]", "mean speed U [m/s]"),
    *("peak torque [N m]", "in the later half [N m]"),
)
OWN, PRINTED = next(iter(READINGS)), list(READINGS)[-1]


@dataclass(frozen=True)
class Correction:
    """The run of one reading of the formulae."""

    label: str
    run: Run
    apart: float  # m, distance of the head at the end from that of the library's own reading

    @property
    def mean_speed(self) -> float:
        """Mean speed U [m/s] over the later half of the run."""
        return self.run.analysis().mean_speed

    @property
    def later_torque(self) -> float:
        """Greatest internal torque [N m] in the later half of the run."""
        return float(self.run.analysis().peak_torque.max())


def swim(
    duration: float = 10.0, accuracy: AccuracyLike = "fine", sample_period: float = 0.02, stations: int = 101
) -> list[Correction]:
    """Simulate the falling gait with each reading of `READINGS`, the library's own first; runs in the paper's axes.

    duration, sample_period: [s]. accuracy, stations: as in `simulate`.
    """
    runs = {
        label: simulate(
            falling(),
            duration,
            scene=Scene(**reading),
            accuracy=accuracy,
            sample_period=sample_period,
            stations=stations,
        ).in_axes("paper")
        for label, reading in READINGS.items()
    }
    end = runs[OWN].position[-1]
    return [Correction(label, run, float(np.linalg.norm(run.position[-1] - end))) for label, run in runs.items()]


def table_of(rows: list[Correction]) -> str:
    """The readings as a Markdown table."""
    cells = []
    for row in rows:
        x, y, z = row.run.position[-1]
        torque, place, time = row.run.greatest_torque()
        peak = f"{torque:.3f} at X = {place:.2f} m, t = {time:.2f} s"
        figures = f"{row.apart:.3f}", f"{row.mean_speed:.3f}", peak, f"{row.later_torque:.3f}"
        cells.append((row.label, f"({x:+.3f}, {y:+.3f}, {z:+.3f})", *figures))
    return table(COLUMNS, cells)
