"""What one instant of a simulation shows."""

from dataclasses import dataclass

import numpy as np

from .energy import EnergyLedger


@dataclass(frozen=True)
class Snapshot:
    """One instant, library axes, SI units; M stations. Its arrays are views of work space: copy what is to be kept."""

    time: float
    position: np.ndarray  # (3,) m, head, world
    orientation: np.ndarray  # (4,) x y z w, world from head
    twist: np.ndarray  # (6,) (Omega, V) rad/s, m/s, head's axes
    head_acceleration: np.ndarray  # (6,) rad/s^2, m/s^2, true acceleration of the head in its axes
    center_of_mass: np.ndarray  # (3,) m, world
    x: np.ndarray  # (M,) m
    backbone: np.ndarray  # (M, 3) m, world
    section_orientation: np.ndarray  # (M, 4) x y z w, world from section
    curvature: np.ndarray  # (M, 3) rad/m
    curvature_rate: np.ndarray  # (M, 3) rad/m/s
    torque: np.ndarray | None  # (M, 3) N m, section axes
    force: np.ndarray | None  # (M, 3) N, section axes
    fluid_force: np.ndarray | None  # (M, 3) N/m, section axes
    resistive_force: np.ndarray | None  # (M, 3) N/m, section axes
    tail_force: np.ndarray | None  # (3,) N, section axes at the tail
    nose_force: np.ndarray | None  # (3,) N, section axes at the nose
    energy: EnergyLedger | None
    closure_torque: float | None  # N m, what is left of the internal torque at the nose
    closure_force: float | None  # N, what is left of the internal force there, less the load on the nose
    actuator_work: float | None  # J since the start
    whole: np.ndarray  # all that was computed, one after another, whatever it is
