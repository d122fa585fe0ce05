"""The water's wrench on the body for a prescribed motion of the head: eq. (61) with the resistive and nose loads."""

from dataclasses import dataclass

import numpy as np
from eel_gaits.law import Law
from eel_gaits.quantity import is_finite
from eel_gaits.wording import shown

from .accuracy import Accuracy
from .arguments import checked_row
from .body import Body
from .drive import combine, factors
from .kernel import add_head_twist, configure, find_loads
from .scene import Scene
from .simulation import Simulation
from .wrench import add_head_acceleration, gather, section_densities, shape_accelerations

FINE = Accuracy(name="prescribed", resolution=100.0)


@dataclass(frozen=True)
class HydrodynamicWrench:
    """Wrenches (torque, force) (6,) [N m, N] of the water on the body, about the head, in its axes. `numpy.asarray`
    gives the sum of the parts."""

    inertia: np.ndarray  # (6,) - d/dt of the water's momentum along the body
    wake: np.ndarray  # (6,) momentum and pressure through the plane of the tail
    resistive: np.ndarray  # (6,) drag along the body
    nose: np.ndarray  # (6,) added mass and drag of the nose

    @property
    def total(self) -> np.ndarray:
        """(6,) sum of the parts."""
        return self.inertia + self.wake + self.resistive + self.nose

    @property
    def torque(self) -> np.ndarray:
        """(3,) N m, of the sum."""
        return self.total[:3]

    @property
    def force(self) -> np.ndarray:
        """(3,) N, of the sum."""
        return self.total[3:]

    def __array__(self, dtype=None, copy=None):
        return np.array(self.total, dtype=dtype)


def hydrodynamic_wrench(
    body: Body, law: Law, time: float, twist, twist_rate, scene: Scene | None = None
) -> HydrodynamicWrench:
    """The water's wrench on `body` bent by `law` at `time` [s], its head moving with `twist` (6,) = (Omega, V) [rad/s,
    m/s] and `twist_rate` (6,) = (Omegadot, Vdot), the rates of these components in the head's axes.

    A current of the scene is taken along the head's axes (head and world coincide). `ValueError` names what does not
    fit.
    """
    twist, twist_rate = checked_row("twist", twist, 6), checked_row("twist_rate", twist_rate, 6)
    if not is_finite(time):
        raise ValueError(f"time must be finite, got {shown(time)} s")
    swimmer = Simulation(body=body, scene=scene, accuracy=FINE, stations=2)
    swimmer.adopt(law)
    drive, fields, balance, water = swimmer.drive, swimmer.fields, swimmer.balance, swimmer.swimmer
    factors(drive, float(time), fields.factor)
    combine(drive.axis, drive.node, fields.factor[2], water.blocks, fields.accel)
    configure(water, drive, fields)
    relative = twist.copy()
    relative[3:] -= swimmer.scene.current
    add_head_twist(water, fields, relative)
    shape_accelerations(water, fields, balance)
    balance.head[:3] = twist_rate[:3]
    balance.head[3:] = twist_rate[3:] + np.cross(twist[:3], twist[3:])
    add_head_acceleration(water, fields, balance)
    none = np.zeros_like(water.mass)
    alone = water._replace(mass=none, inertia1=water.added_roll, inertia2=none, inertia3=none)
    inertia, nose = np.zeros(6), np.zeros(6)
    section_densities(alone, fields, balance)
    gather(alone, balance.density, inertia)
    find_loads(water, fields, relative)
    nose[3] = -water.nose_mass * balance.head[3] - water.nose_drag * relative[3] * abs(relative[3])
    return HydrodynamicWrench(inertia=-inertia, wake=fields.tail.copy(), resistive=fields.drag.copy(), nose=nose)
