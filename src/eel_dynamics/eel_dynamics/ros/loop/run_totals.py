# SPDX-License-Identifier: Apache-2.0
"""Totals and extreme values of a run for /diagnostics: energy ledger, closure of the wrench, torque and force."""

import math

import numpy as np

from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.stopping import SimulationStopped


class RunTotals:
    """Accumulates the figures of successive snapshots."""

    def __init__(self) -> None:
        self._values: dict[str, float] = {}
        self._greatest = {"torque": 0.0, "force": 0.0}  # N m, N, over all stations and times

    def add(self, snapshot: Snapshot) -> None:
        """Add the figures of a snapshot that `check_finite` has accepted."""
        values = self._values
        if snapshot.energy is not None and snapshot.actuator_work is not None:
            residual = float(snapshot.energy.residual)
            values["energy_residual"] = residual
            values["energy_residual_worst"] = max(values.get("energy_residual_worst", 0.0), abs(residual))
            values["actuator_work"] = snapshot.actuator_work
        for name in self._greatest if snapshot.closure_torque is not None else ():
            key, size = f"closure_{name}", float(np.maximum.reduce(np.abs(getattr(snapshot, name)), axis=None))
            values[key] = max(values.get(key, 0.0), float(getattr(snapshot, key)))
            self._greatest[name] = max(self._greatest[name], size)

    def values(self) -> dict[str, float]:
        """This run's figures by name; the closure also relative to the greatest value."""
        relative = {
            f"closure_{name}_relative": self._values[f"closure_{name}"] / greatest
            for name, greatest in self._greatest.items()
            if greatest > 0.0
        }
        return self._values | relative


def check_finite(snapshot: Snapshot) -> None:
    """`SimulationStopped` if a value of a snapshot or its energy residual is not finite. Call it before publishing."""
    if not np.isfinite(snapshot.whole).all():
        for name, array in snapshot.arrays().items():
            _check(snapshot, name, array)
    if snapshot.energy is not None and not math.isfinite(snapshot.energy.residual):
        _check(snapshot, "energy residual", snapshot.energy.residual)


def _check(snapshot: Snapshot, name: str, values: np.ndarray | float) -> None:
    bad = np.ravel(values)[~np.isfinite(np.ravel(values))]
    if len(bad):
        raise SimulationStopped(snapshot.time, name, float(bad[0]), "take a gentler law")
