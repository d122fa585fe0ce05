# SPDX-License-Identifier: Apache-2.0
"""The water's wrench on the body for a prescribed motion of the head: eq. (61) with the resistive and nose loads."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_common.quantity import checked_instance, checked_row, is_finite
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from numpy.typing import ArrayLike

import eel_core
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.section_data import core_swimmer, nose_of
from eel_dynamics.simulation.simulation import Simulation

FINE = Accuracy(name="prescribed", resolution=100.0)


@dataclass(frozen=True)
class HydrodynamicWrench:
    """Wrenches (torque, force) (6,) [N m, N] of the water on the body, about the head, in the head's axes.

    `numpy.asarray` gives the sum of the parts.
    """

    inertia: np.ndarray  #: (6,) - d/dt of the water's momentum along the body
    wake: np.ndarray  #: (6,) momentum and pressure through the plane of the tail
    resistive: np.ndarray  #: (6,) drag along the body, of its base and its appendages
    nose: np.ndarray  #: (6,) added mass and drag of the nose

    @property
    def total(self) -> np.ndarray:
        """(6,) sum of the parts."""
        return np.asarray(self.inertia + self.wake + self.resistive + self.nose)

    @property
    def torque(self) -> np.ndarray:
        """(3,) N m, of the sum."""
        return self.total[:3]

    @property
    def force(self) -> np.ndarray:
        """(3,) N, of the sum."""
        return self.total[3:]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.total, dtype=dtype)


def hydrodynamic_wrench(
    body: Body, law: Law, time: float, twist: ArrayLike, twist_rate: ArrayLike, scene: Scene | None = None
) -> HydrodynamicWrench:
    """The water's wrench on `body`, bent by `law` at `time` [s] (eq. 61 with the resistive and nose loads).

    The head moves with `twist` (6,) = (Omega, V) [rad/s, m/s] and `twist_rate` (6,) = (Omegadot, Vdot) [rad/s^2,
    m/s^2], the rates of these components in the head's axes. Head and world coincide, so a current of the scene is
    along the head's axes. `ValueError` names a bad argument.
    """
    twist, twist_rate = checked_row("twist", twist, 6), checked_row("twist_rate", twist_rate, 6)
    checked_instance("law", law, Law)
    if not is_finite(time):
        raise ValueError(f"time must be finite, got {shown(time)} s")
    simulation = Simulation(body=body, scene=scene, accuracy=FINE, stations=2, law=law)
    scene, here, time = simulation.scene, simulation.discretisation, float(time)
    relative, acceleration = twist.copy(), twist_rate.copy()
    relative[3:] -= scene.current
    acceleration[3:] += np.cross(twist[:3], twist[3:])
    arguments = scene, here.grid, here.sections.of_water(), simulation.x, simulation.accuracy.kinks
    water = eel_core.Instant(core_swimmer(simulation.body, *arguments))
    inertia = np.array(water.momentum_rate(simulation.law_on_grid, time, relative, acceleration))
    wake, resistive = np.array(eel_core.Instant(here.swimmer).loads(simulation.law_on_grid, time, relative))
    nose_mass, nose_drag = nose_of(simulation.body, scene)
    nose = np.zeros(6)
    nose[3] = -nose_mass * acceleration[3] - nose_drag * relative[3] * abs(relative[3])
    return HydrodynamicWrench(inertia=-inertia, wake=wake, resistive=resistive, nose=nose)
