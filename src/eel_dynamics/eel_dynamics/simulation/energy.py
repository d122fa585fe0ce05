"""The energy ledger: where the work of the actuators goes (eq. 60 times the head's twist).

    d/dt (kinetic_body + kinetic_fluid) = actuator_power + wake_power + nose_power + drag_power

Powers are into body and water. The wake's is V1(l) T_f(l): it feeds energy in where the tail leads, a limit of the
theory. The nose's holds its added mass, so 1/2 m_o V1^2 is not part of kinetic_fluid; the drag's is without the nose.
"""

from dataclasses import dataclass, fields

import numpy as np


@dataclass(frozen=True)
class EnergyLedger:
    """One instant (floats) or a run ((T,) arrays). Relative to the water where there is a current."""

    kinetic_body: np.ndarray  # J
    kinetic_fluid: np.ndarray  # J
    actuator_power: np.ndarray  # W
    wake_power: np.ndarray  # W
    nose_power: np.ndarray  # W
    drag_power: np.ndarray  # W
    residual: np.ndarray  # J, change of the kinetic energy since the start less the integral of the powers
    actuator_work: np.ndarray  # J, integrals of the powers since the start
    wake_work: np.ndarray  # J
    nose_work: np.ndarray  # J
    drag_work: np.ndarray  # J

    def __getitem__(self, name: str):
        if name not in self.keys():
            raise KeyError(name)
        return getattr(self, name)

    @staticmethod
    def keys() -> list[str]:
        """Names of the fields."""
        return [item.name for item in fields(EnergyLedger)]

    @staticmethod
    def of(kinetic: np.ndarray, powers: np.ndarray, works: np.ndarray, start: float) -> "EnergyLedger":
        """From kinetic energies (..., 2), powers (..., 4), works (..., 4), and the kinetic energy at the start [J]."""
        if kinetic.ndim == 1:  # an instant, for a node at real time
            kinetic, powers, works = kinetic.tolist(), powers.tolist(), works.tolist()
            return EnergyLedger(*kinetic, *powers, sum(kinetic) - start - sum(works), *works)
        residual = kinetic.sum(axis=-1) - start - works.sum(axis=-1)
        return EnergyLedger(
            kinetic[..., 0], kinetic[..., 1], *np.moveaxis(powers, -1, 0), residual, *np.moveaxis(works, -1, 0)
        )
