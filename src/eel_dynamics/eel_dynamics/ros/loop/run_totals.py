# SPDX-License-Identifier: Apache-2.0
"""Totals and extreme values of a run for /diagnostics: energy ledger, closure of the wrench, torque and force."""

import math

import numpy as np

from eel_dynamics.simulation.stopping import SimulationStopped

CHECKED = (
    *("position", "orientation", "twist", "backbone", "section_orientation", "curvature", "curvature_rate"),
    *("torque", "force", "fluid_force", "resistive_force", "tail_force", "nose_force", "wake_momentum_rate"),
)


class RunTotals:
    """Accumulates the figures of successive snapshots."""

    def __init__(self):
        self.energy_residual = None  # J, latest
        self.energy_residual_worst = None  # J, greatest magnitude
        self.actuator_work = None  # J, since the start
        self.closure_torque = None  # N m, greatest so far
        self.closure_force = None  # N
        self.greatest_torque = 0.0  # N m, over all stations and times
        self.greatest_force = 0.0  # N

    def add(self, snapshot):
        """Add a snapshot's figures; `SimulationStopped` if one of its values is not finite."""
        if not math.isfinite(np.add.reduce(snapshot.whole)):
            for name in CHECKED:
                values = getattr(snapshot, name)
                if values is not None and not np.isfinite(values).all():
                    raise _not_finite(snapshot, name, values)
        if snapshot.energy is not None:
            residual = float(snapshot.energy.residual)
            if not math.isfinite(residual):
                raise _not_finite(snapshot, "energy residual", residual)
            self.energy_residual = residual
            self.energy_residual_worst = max(self.energy_residual_worst or 0.0, abs(residual))
            self.actuator_work = float(snapshot.actuator_work)
        if snapshot.closure_torque is not None:
            self.closure_torque = max(self.closure_torque or 0.0, float(snapshot.closure_torque))
            self.closure_force = max(self.closure_force or 0.0, float(snapshot.closure_force))
            self.greatest_torque = max(self.greatest_torque, _greatest(snapshot.torque))
            self.greatest_force = max(self.greatest_force, _greatest(snapshot.force))

    def values(self) -> dict[str, float]:
        """The figures that this run computes, by name."""
        named = {
            "energy_residual": self.energy_residual,
            "energy_residual_worst": self.energy_residual_worst,
            "actuator_work": self.actuator_work,
            "closure_force": self.closure_force,
            "closure_torque": self.closure_torque,
            "closure_force_relative": _ratio(self.closure_force, self.greatest_force),
            "closure_torque_relative": _ratio(self.closure_torque, self.greatest_torque),
        }
        return {name: value for name, value in named.items() if value is not None}


def _greatest(values: np.ndarray) -> float:
    return float(np.maximum.reduce(np.abs(values), axis=None))


def _ratio(value, scale):
    return value / scale if value is not None and scale > 0.0 else None


def _not_finite(snapshot, name, values):
    first = float(np.ravel(values)[~np.isfinite(np.ravel(values))][0])
    return SimulationStopped(snapshot.time, name, first, "take a gentler law")
