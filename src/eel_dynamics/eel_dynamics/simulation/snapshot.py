# SPDX-License-Identifier: Apache-2.0
"""The quantities of one instant of a simulation. Each is a view of what was observed, made when it is asked for."""

from typing import Any

import numpy as np

from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import Places


class Observed:
    """A quantity of a snapshot, an array; None where the snapshot was taken without it."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, snapshot: "Snapshot | None", owner: type | None = None) -> Any:
        if snapshot is None:
            return self
        where, shape = snapshot.places[self._name]
        return None if shape is None else snapshot.whole[where].reshape(shape)


class Snapshot:
    """One instant, in library axes and SI units, at M stations. Its arrays are views: copy what is to be kept.

    time: [s]. x (M,): [m]. whole: all that was computed, one after another. places: of the quantities in it.
    works (4,) [J]: of actuators, wake, nose and drag since the start; None without a ledger. energy_at_start: [J].
    """

    __slots__ = ("_energy", "_energy_at_start", "_works", "places", "time", "whole", "x")

    position = Observed()  #: (3,) m, head, world
    orientation = Observed()  #: (4,) x y z w, world from head
    twist = Observed()  #: (6,) (Omega, V) rad/s, m/s, head's axes
    head_acceleration = Observed()  #: (6,) rad/s^2, m/s^2, true acceleration of the head in its axes
    center_of_mass = Observed()  #: (3,) m, world
    backbone = Observed()  #: (M, 3) m, world
    section_orientation = Observed()  #: (M, 4) x y z w, world from section
    curvature = Observed()  #: (M, 3) rad/m
    curvature_rate = Observed()  #: (M, 3) rad/m/s
    torque = Observed()  #: (M, 3) N m, section axes; None without the wrench
    force = Observed()  #: (M, 3) N, section axes; None without the wrench
    fluid_force = Observed()  #: (M, 3) N/m, section axes; None without the load
    resistive_force = Observed()  #: (M, 3) N/m, section axes; None without the load
    tail_force = Observed()  #: (3,) N, section axes at the tail; None without the load
    nose_force = Observed()  #: (3,) N, section axes at the nose; None without the load
    wake_momentum_rate = Observed()  #: (3,) N, given to the wake per time, section axes at the tail; as the load
    energies = Observed()  #: (3,) J, kinetic of body and of water, potential
    powers = Observed()  #: (4,) W, of actuators, wake, nose and drag
    closure = Observed()  #: (2,) N m, N: what is left at the nose of the internal wrench

    def __init__(
        self,
        time: float,
        x: np.ndarray,
        whole: np.ndarray,
        places: Places,
        works: np.ndarray | None,
        energy_at_start: float,
    ):
        self.time, self.x, self.whole, self.places = time, x, whole, places
        self._works, self._energy_at_start = works, energy_at_start
        self._energy: EnergyLedger | None = None

    @property
    def energy(self) -> EnergyLedger | None:
        """One float per field; None without a ledger."""
        if self._energy is None and self._works is not None:
            self._energy = EnergyLedger.of(self.energies, self.powers, self._works, self._energy_at_start)
        return self._energy

    @property
    def actuator_work(self) -> float | None:
        """[J] since the start; None without a ledger."""
        return None if self._works is None else float(self._works[0])

    @property
    def closure_torque(self) -> float | None:
        """[N m], what is left of the internal torque at the nose; None without the wrench."""
        return None if self.torque is None else float(self.closure[0])

    @property
    def closure_force(self) -> float | None:
        """[N], what is left of the internal force there, less the load on the nose; None without the wrench."""
        return None if self.torque is None else float(self.closure[1])
