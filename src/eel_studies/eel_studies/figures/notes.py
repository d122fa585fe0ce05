# SPDX-License-Identifier: Apache-2.0
"""The numbers of the page beside the figures, docs/figures/README.md. Each is computed from the runs in the figures."""

import numpy as np
from eel_dynamics.runs.run import Run
from eel_model.section_data import CRITICAL_REYNOLDS

from eel_studies.figures import corrections, kern_comparison
from eel_studies.figures.corrections import Correction
from eel_studies.figures.kern_comparison import Comparison
from eel_studies.figures.orders import ConvergenceErrors, Errors
from eel_studies.figures.paper_drawings import INSTANT, PLACE, wrench_of

FINE = 4  # index of the number of points from which on the order along the body is fitted


def parts_of(readings: list[Correction], comparison: Comparison) -> dict[str, str]:
    """The tables of the page, by the names of its parts."""
    return {"corrections": corrections.table_of(readings), "kern": kern_comparison.table_of(comparison)}


def values_of(
    readings: list[Correction],
    control: Run,
    comparison: Comparison,
    errors: Errors,
) -> dict[str, str]:
    """The numbers within the sentences of the page, by name.

    readings: of `corrections.swim`. control: run of the same wave without the bends in pitch. comparison: of
    `kern_comparison.compare`. errors: of `orders`, by rule and drag.
    """
    runs = {row.label: row.run for row in readings}
    run, printed = runs[corrections.OWN], runs[corrections.PRINTED]
    x, y, z = run.position[-1]
    above = comparison.fast.stride / kern_comparison.PUBLISHED_SPEEDS[1] - 1.0
    return {
        "mass": f"{run.body_mass:.4f}",
        "duration": f"{run.time[-1]:g}",
        "end": f"({x:+.2f}, {y:+.2f}, {z:+.2f})",
        "end_y": f"{y:+.2f}",
        "control_y": f"{control.position[-1, 1]:+.2f}",
        "printed_z": f"{printed.position[-1, 2]:+.2f}",
        **_along(run),
        **_in_time(run),
        "speed": f"{run.twist[-1, 3]:.2f}",
        "roll": f"{_greatest(run.twist[:, 0]):.1f}",
        "mean_speed": f"{run.analysis().mean_speed:.3f}",
        **_ledger(run),
        **_orders(errors["in_space"], errors["in_time"]),
        **_corrections(readings),
        "kern_above": f"{above:.0%}",
    }


def _along(run: Run) -> dict[str, str]:
    """The greatest force and torques along the body at `INSTANT`, and where the friction jumps."""
    k = int(np.argmin(np.abs(run.time - INSTANT)))
    force, torque = (field[k] for field in wrench_of(run))
    found = {"jump": f"{CRITICAL_REYNOLDS * run.scene.viscosity / abs(run.twist[k, 3]):.2f}"}
    for name, values in (("axial", force[:, 0]), ("pitch", torque[:, 1]), ("yaw", torque[:, 2])):
        place = np.argmax(np.abs(values))
        found |= {name: f"{values[place]:+.3f}", f"{name}_at": f"{run.x[place]:.2f}"}
    return found


def _in_time(run: Run) -> dict[str, str]:
    """The extremes of force and torque at `PLACE`, and the greatest torque of all."""
    station = int(np.argmin(np.abs(run.x - PLACE)))
    yaw = wrench_of(run)[1][:, station, 2]
    torque, place, time = run.greatest_torque()
    return {
        "yaw_least": f"{yaw.min():.2f}",
        "yaw_most": f"{yaw.max():.2f}",
        "yaw_late": f"{_greatest(yaw[run.time >= 0.5 * run.time[-1]]):.2f}",
        "peak": f"{torque:.3f}",
        "peak_at": f"{place:.2f}",
        "peak_time": f"{time:.2f}",
    }


def _ledger(run: Run) -> dict[str, str]:
    energy = run.energy
    assert energy is not None
    work = energy.actuator_work[-1]
    parts = {name: f"{-energy[f'{name}_work'][-1] / work:.0%}" for name in ("drag", "wake", "nose")}
    return {"work": f"{work:.2f}", **parts, "residual": f"{_greatest(energy.residual) / work:.0e}"}


def _orders(space: dict[bool, ConvergenceErrors], time: dict[bool, ConvergenceErrors]) -> dict[str, str]:
    found = {}
    for drag, prefix in ((False, ""), (True, "drag_")):
        found[f"{prefix}motion_by_points"] = f"{space[drag].order('motion', slice(FINE, None)):.1f}"
        found[f"{prefix}motion_by_step"] = f"{time[drag].order('motion'):.1f}"
    return found


def _corrections(readings: list[Correction]) -> dict[str, str]:
    own, perimeter, _, laminar, mass, _ = readings
    return {
        "exchanged_share": f"{mass.run.greatest_torque()[0] / own.run.greatest_torque()[0]:.0%}",
        "perimeter_speed": f"{perimeter.mean_speed / own.mean_speed - 1.0:+.0%}",
        "laminar_speed": f"{laminar.mean_speed / own.mean_speed - 1.0:+.0%}",
    }


def _greatest(values: np.ndarray) -> float:
    return float(np.max(np.abs(values)))
