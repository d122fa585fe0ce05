# SPDX-License-Identifier: Apache-2.0
"""The numbers of the page beside the figures, docs/figures/README.md. Each is computed from the runs in the figures."""

import numpy as np
from eel_dynamics.analysis.analysis import Analysis
from eel_dynamics.model.section_data import CRITICAL_REYNOLDS

from eel_dynamics import Run
from paper.drawings import INSTANT, PLACE, wrench_of
from paper.readings import FASTEST, OWN, PRINTED


def values_of(runs: dict[str, Run], control: Run, fast: Analysis) -> dict[str, str]:
    """The numbers within the sentences of the page, by name.

    runs: of `swim_readings`. control: of the same wave without the bends in pitch. fast: of `swim_kern`.
    """
    run, end = runs[OWN], runs[OWN].position[-1]
    return {
        "mass": f"{run.body_mass:.4f}",
        "duration": f"{run.time[-1]:g}",
        "end": f"({end[0]:+.2f}, {end[1]:+.2f}, {end[2]:+.2f})",
        "end_y": f"{end[1]:+.2f}",
        "control_y": f"{control.position[-1, 1]:+.2f}",
        "printed_z": f"{runs[PRINTED].position[-1, 2]:+.2f}",
        **_along(run),
        **_in_time(run),
        "speed": f"{run.twist[-1, 3]:.2f}",
        "roll": f"{_greatest(run.twist[:, 0]):.1f}",
        "mean_speed": f"{run.analysis().mean_speed:.3f}",
        **_ledger(run),
        **_corrections(runs),
        "kern_above": f"{fast.stride / FASTEST - 1.0:.0%}",
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
    """The extremes of the torque at `PLACE`, and the greatest torque of all."""
    yaw = wrench_of(run)[1][:, int(np.argmin(np.abs(run.x - PLACE))), 2]
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


def _corrections(runs: dict[str, Run]) -> dict[str, str]:
    own, perimeter, _, laminar, mass, _ = runs.values()
    speed = own.analysis().mean_speed
    return {
        "exchanged_share": f"{mass.greatest_torque()[0] / own.greatest_torque()[0]:.0%}",
        "perimeter_speed": f"{perimeter.analysis().mean_speed / speed - 1.0:+.0%}",
        "laminar_speed": f"{laminar.analysis().mean_speed / speed - 1.0:+.0%}",
    }


def _greatest(values: np.ndarray) -> float:
    return float(np.max(np.abs(values)))
