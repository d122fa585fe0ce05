# SPDX-License-Identifier: Apache-2.0
"""Makes the fields of a run from what a simulation observed."""

import numpy as np

from eel_dynamics.model.scene import Scene
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import Observations


def fields_of_observations(
    out: Observations,
    *,
    times: np.ndarray,
    works: np.ndarray,
    energy_at_start: float,
    scene: Scene,
    wrench: bool,
    load: bool,
) -> dict:
    """The fields of a `Run` that `out` and the `works` (T, 4) [J] hold, cut to the `times` [s] that were reached.

    energy_at_start [J]. wrench, load: whether the internal wrench and the water's load were observed. Fields of what
    was not are None.
    """
    if len(times) < len(out.position):
        out = Observations(*(*(array[: len(times)] for array in out[:-1]), out.whole))
    energy = EnergyLedger.of(out.energies, out.powers, works, energy_at_start) if scene.ledger else None
    return {
        "time": times,
        "position": out.position,
        "orientation": out.orientation,
        "twist": out.twist,
        "head_acceleration": out.head_acceleration,
        "center_of_mass": out.center_of_mass,
        "backbone": out.backbone,
        "section_orientation": out.section_orientation,
        "curvature": out.curvature,
        "curvature_rate": out.curvature_rate,
        "torque": out.torque if wrench else None,
        "force": out.force if wrench else None,
        "fluid_force": out.fluid_force if load else None,
        "resistive_force": out.resistive_force if load else None,
        "tail_force": out.tail_force if load else None,
        "nose_force": out.nose_force if load else None,
        "wake_momentum_rate": out.wake_momentum_rate if load else None,
        "energy": energy,
        "closure_torque": out.closure[:, 0] if wrench else None,
        "closure_force": out.closure[:, 1] if wrench else None,
    }
