# SPDX-License-Identifier: Apache-2.0
"""The energy ledger: where the work of the actuators goes (eq. 60 times the head's twist).

    d/dt (kinetic_body + kinetic_fluid + potential + elastic) =
        actuator_power + wake_power + nose_power + drag_power + flow_power + fins_power + appendages_power
        + external_power + damping_power

A positive power feeds energy into body and water. The power of the wake is V1(l) T_f(l). It is positive where the tail
leads, which is a limit of the theory. The power of the nose includes that of its added mass, so kinetic_fluid does not
include 1/2 m_o V1^2. The power of the drag includes a blunt tail's base, not the nose. The potential energy is that of
the weight and the buoyancy (`Scene.weight`; of `Scene.metacentric_height` alone their moment), 0 where every section
stands upright at z = 0.

Where the water moves by itself (`flow`), U is its velocity at a section and p the momentum of the section's water that
moves through it: kinetic_fluid is the integral of T_f + p . U, and flow_power that of p . u_t + rho_f A a_u . V, the
powers of the rate of u at the fixed place and of the undisturbed pressure. It is 0 without a flow.

fins_power is that of the fins' lift, drag and added mass, whose energy is no part of kinetic_fluid; 0 without fins.
appendages_power is that of the body's appendages, external_power that of wrenches from outside (`ExternalWrench`), by
the velocities relative to the current; 0 without any.

Of a robot, the actuators are its motors, its muscles, and what imposes the curvature that no joint makes; its rotors
are part of kinetic_body. elastic is the energy of its springs, damping_power that of its dampers and of friction; both
are 0 without one.
"""

from dataclasses import dataclass, fields
from typing import Annotated, Any

import numpy as np

from eel_dynamics.model.equality import EqualByFields

# That have powers and works, as in eel_core.
WORKS = "actuator", "wake", "nose", "drag", "flow", "fins", "appendages", "external"


@dataclass(frozen=True, eq=False, repr=False)
class EnergyLedger(EqualByFields):
    """The energy ledger of one instant (floats) or of a run ((T,) arrays). Velocities are relative to the current.

    Energies, works and the residual are in J, powers in W. A power > 0 brings energy into body and water.
    """

    kinetic_body: Annotated[np.ndarray, "J", "kinetic energy of the body"]
    kinetic_fluid: Annotated[np.ndarray, "J", "kinetic energy of the water, without the nose's added mass"]
    potential: Annotated[np.ndarray, "J", "potential energy of weight and buoyancy"]
    actuator_power: Annotated[np.ndarray, "W", "power of the actuators"]
    wake_power: Annotated[np.ndarray, "W", "power of the wake"]
    nose_power: Annotated[np.ndarray, "W", "power of the load on the nose"]
    drag_power: Annotated[np.ndarray, "W", "power of the drag along the body"]
    flow_power: Annotated[np.ndarray, "W", "power of the water's own motion, 0 without a flow"]
    fins_power: Annotated[np.ndarray, "W", "power of the fins' forces, 0 without fins"]
    appendages_power: Annotated[np.ndarray, "W", "power of the appendages' drag, 0 without any"]
    external_power: Annotated[np.ndarray, "W", "power of wrenches from outside, 0 without any"]
    residual: Annotated[np.ndarray, "J", "change of all energy since the start less the works"]
    actuator_work: Annotated[np.ndarray, "J", "work of the actuators since the start"]
    wake_work: Annotated[np.ndarray, "J", "work of the wake since the start"]
    nose_work: Annotated[np.ndarray, "J", "work of the load on the nose since the start"]
    drag_work: Annotated[np.ndarray, "J", "work of the drag along the body since the start"]
    flow_work: Annotated[np.ndarray, "J", "work of the water's own motion since the start"]
    fins_work: Annotated[np.ndarray, "J", "work of the fins' forces since the start"]
    appendages_work: Annotated[np.ndarray, "J", "work of the appendages' drag since the start"]
    external_work: Annotated[np.ndarray, "J", "work of wrenches from outside since the start"]
    elastic: Annotated[np.ndarray, "J", "elastic energy of a robot's springs, 0 without a robot"]
    damping_power: Annotated[np.ndarray, "W", "power of a robot's dampers, 0 without a robot"]
    damping_work: Annotated[np.ndarray, "J", "work of a robot's dampers since the start"]

    def __repr__(self) -> str:
        shape = np.shape(self.residual)
        return f"EnergyLedger({'an instant' if not shape else ' x '.join(map(str, shape)) + ' samples'})"

    def __getitem__(self, name: str) -> Any:
        return vars(self)[name]

    @staticmethod
    def keys() -> list[str]:
        """Names of the fields."""
        return [item.name for item in fields(EnergyLedger)]

    @staticmethod
    def of(energies: Any, powers: Any, works: Any, start: Any, robot: Any = None) -> "EnergyLedger":
        """A ledger from its numbers.

        energies (T, 3) [J]: kinetic of body and of water, potential. powers (T, 8) [W] and works (T, 8) [J]: of
        `WORKS`. start [J]: the sum of the energies at the start. robot (T, 3): elastic energy [J], power [W] and work
        [J] of the dampers; None: 0. Of an instant without the dimension T.
        """
        columns: Any = np.ndarray.tolist if energies.ndim == 1 else np.ndarray.transpose
        robot = np.zeros(energies.shape) if robot is None else robot
        energies, powers, works, (elastic, damping_power, damping_work) = map(columns, (energies, powers, works, robot))
        residual = sum(energies) - start - sum(works) + elastic - damping_work
        return EnergyLedger(*(*energies, *powers, residual, *works, elastic, damping_power, damping_work))
