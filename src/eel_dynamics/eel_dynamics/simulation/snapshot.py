# SPDX-License-Identifier: Apache-2.0
"""The quantities of one instant of a simulation."""

from dataclasses import dataclass

import numpy as np

from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import Observations


@dataclass(frozen=True)
class Snapshot:
    """One instant, in library axes and SI units, at M stations. Its arrays are views: copy what is to be kept."""

    time: float  #: s
    position: np.ndarray  #: (3,) m, head, world
    orientation: np.ndarray  #: (4,) x y z w, world from head
    twist: np.ndarray  #: (6,) (Omega, V) rad/s, m/s, head's axes
    head_acceleration: np.ndarray  #: (6,) rad/s^2, m/s^2, true acceleration of the head in its axes
    center_of_mass: np.ndarray  #: (3,) m, world
    x: np.ndarray  #: (M,) m
    backbone: np.ndarray  #: (M, 3) m, world
    section_orientation: np.ndarray  #: (M, 4) x y z w, world from section
    curvature: np.ndarray  #: (M, 3) rad/m
    curvature_rate: np.ndarray  #: (M, 3) rad/m/s
    torque: np.ndarray | None  #: (M, 3) N m, section axes
    force: np.ndarray | None  #: (M, 3) N, section axes
    fluid_force: np.ndarray | None  #: (M, 3) N/m, section axes
    resistive_force: np.ndarray | None  #: (M, 3) N/m, section axes
    tail_force: np.ndarray | None  #: (3,) N, section axes at the tail
    nose_force: np.ndarray | None  #: (3,) N, section axes at the nose
    wake_momentum_rate: np.ndarray | None  #: (3,) N, momentum given to the wake per time, section axes at the tail
    energy: EnergyLedger | None  #: one float per field
    closure_torque: float | None  #: N m, what is left of the internal torque at the nose
    closure_force: float | None  #: N, what is left of the internal force there, less the load on the nose
    actuator_work: float | None  #: J since the start
    whole: np.ndarray  #: all that was computed, one after another, whatever it is

    @staticmethod
    def of(
        out: Observations, time: float, x: np.ndarray, works: np.ndarray | None, energy_at_start: float
    ) -> "Snapshot":
        """A snapshot from `out`, observed once at `time` [s] at the stations x (M,) [m].

        works (4,) [J]: of actuators, wake, nose and drag since the start; None without a ledger. energy_at_start [J].
        """
        wrench, load, ledger = len(out.torque) > 0, len(out.fluid_force) > 0, works is not None
        return Snapshot(
            time=time,
            position=out.position[0],
            orientation=out.orientation[0],
            twist=out.twist[0],
            head_acceleration=out.head_acceleration[0],
            center_of_mass=out.center_of_mass[0],
            x=x,
            backbone=out.backbone[0],
            section_orientation=out.section_orientation[0],
            curvature=out.curvature[0],
            curvature_rate=out.curvature_rate[0],
            torque=out.torque[0] if wrench else None,
            force=out.force[0] if wrench else None,
            fluid_force=out.fluid_force[0] if load else None,
            resistive_force=out.resistive_force[0] if load else None,
            tail_force=out.tail_force[0] if load else None,
            nose_force=out.nose_force[0] if load else None,
            wake_momentum_rate=out.wake_momentum_rate[0] if load else None,
            energy=EnergyLedger.of(out.energies[0], out.powers[0], works, energy_at_start) if ledger else None,
            closure_torque=float(out.closure[0, 0]) if wrench else None,
            closure_force=float(out.closure[0, 1]) if wrench else None,
            actuator_work=float(works[0]) if works is not None else None,
            whole=out.whole,
        )
