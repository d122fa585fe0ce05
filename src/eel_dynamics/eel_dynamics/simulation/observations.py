# SPDX-License-Identifier: Apache-2.0
"""What is observed of a swimmer: poses, velocities, energies, and profiles along the body at the stations.

`Observations` is the one description of these quantities, with dimensions, unit and meaning. Runs, files, labelled
arrays and tables take it from `OBSERVED`.
"""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

import eel_core
from eel_dynamics.model.equality import same
from eel_dynamics.simulation.energy import EnergyLedger


class Variable(NamedTuple):
    """An array of a run: names of its dimensions, unit and meaning."""

    dimensions: tuple[str, ...]
    unit: str
    description: str


class Observed:
    """A quantity of `Observations`: a view of their numbers, made on request."""

    def __init__(self, dimensions: str, unit: str, description: str):
        self.variable = Variable(tuple(dimensions.split()), unit, description)

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, samples: "Observations | None", owner: type | None = None) -> Any:
        if samples is None:
            return self
        where, shape = samples.places[self._name]
        return None if shape is None else samples.whole[where].reshape(shape)


Places = dict[str, tuple[slice, tuple[int, ...] | None]]  # of each quantity: where, and its shape


class Observations:
    """Samples of a swimmer: T instants ("time"), M stations ("station"). World and head in REP-103 axes, SI units.

    Section axes are the paper's; those of a sensor are its section's, turned as the head's (x forward). All quantities
    are views of `whole` (n,), at their `places`, one after the other. A quantity that was not requested has no
    instants.
    """

    __slots__ = ("places", "whole")

    position = Observed("time world", "m", "head, world")
    orientation = Observed("time quaternion", "1", "world from head, x y z w")
    twist = Observed("time component", "rad/s, m/s", "(Omega, V) of the head, its axes")
    head_acceleration = Observed(
        "time component", "rad/s^2, m/s^2", "angular and true acceleration of the head, its axes"
    )
    center_of_mass = Observed("time world", "m", "centre of mass, world")
    energies = Observed("time energy", "J", "kinetic of body and of water, potential")
    powers = Observed(
        "time power", "W", "of actuators, wake, nose, drag, flow, fins, appendages and wrenches from outside"
    )
    closure = Observed("time closure", "N m, N", "what is left at the nose of the internal torque and force")
    backbone = Observed("time station world", "m", "backbone, world")
    section_orientation = Observed("time station quaternion", "1", "world from section, x y z w")
    curvature = Observed("time station section", "rad/m", "curvature of the backbone, section axes")
    curvature_rate = Observed("time station section", "rad/m/s", "rate of the curvature, section axes")
    torque = Observed(
        "time station section", "N m", "internal torque of the part behind a section on the part ahead, section axes"
    )
    force = Observed("time station section", "N", "internal force likewise; along axis 1 tension is positive")
    fluid_force = Observed("time station section", "N/m", "force of the water on the body, section axes")
    resistive_force = Observed("time station section", "N/m", "resistive part of fluid_force")
    tail_force = Observed("time section", "N", "force of the water on the tail, section axes")
    nose_force = Observed("time section", "N", "force of the water on the nose, section axes")
    wake_momentum_rate = Observed(
        "time section", "N", "momentum given to the wake per time, T_f E1 - V1 M_f V of eq. (60), section axes"
    )
    fin_angle = Observed("time fin", "rad", "angles of the fins")
    fin_force = Observed("time fin section", "N", "force of the water on each fin, axes of its section")
    sensor_position = Observed("time sensor world", "m", "sensors, world")
    sensor_orientation = Observed("time sensor quaternion", "1", "world from sensor, x y z w")
    sensor_twist = Observed("time sensor component", "rad/s, m/s", "(Omega, V) of each sensor over ground, its axes")
    sensor_acceleration = Observed(
        "time sensor component", "rad/s^2, m/s^2", "angular and true acceleration of each sensor, its axes"
    )
    sensor_water = Observed("time sensor world", "m/s", "velocity of the water there over ground, the sensor's axes")

    def __init__(
        self,
        samples: int | None,
        stations: int,
        wrench: bool = True,
        load: bool = True,
        fins: int = 0,
        sensors: int = 0,
    ):
        """Space for `samples` instants at `stations` stations, and if wanted for the internal wrench and the water's
        load. samples: None for one instant."""
        self.places, size = places_of(samples, stations, bool(wrench), bool(load), fins, sensors)
        self.whole = np.zeros(size)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Observations) or type(self) is not type(other):
            return False
        return self.places == other.places and same(self.whole, other.whole)

    __hash__ = object.__hash__

    def arrays(self) -> dict[str, np.ndarray]:
        """All quantities by name, of a `Snapshot` only the requested ones."""
        places = self.places.items()
        return {name: self.whole[where].reshape(shape) for name, (where, shape) in places if shape is not None}


OBSERVED = {name: each.variable for name, each in vars(Observations).items() if isinstance(each, Observed)}
WRENCH = ("torque", "force", "closure_torque", "closure_force")  # of the internal wrench, as a run has it
LOAD = ("fluid_force", "resistive_force", "tail_force", "nose_force", "wake_momentum_rate")  # of the water's load
FINS = ("fin_angle", "fin_force")
SENSORS = tuple(name for name in OBSERVED if name.startswith("sensor_"))


class Snapshot(Observations):
    """One instant: the quantities have no dimension "time", and are None if they were not requested.

    The arrays are views: copy them to keep them. ledger: the works (8,) [J] since the start, and the energy [J] there.
    joints: the `JointMotion` of the instant. sensors: their number.

    Attributes:
        time: [s].
        x: (M,) [m], the stations.
    """

    __slots__ = ("_energy", "_joints", "_ledger", "time", "x")

    def __init__(
        self,
        time: float,
        x: np.ndarray,
        wrench: bool,
        load: bool,
        fins: int = 0,
        ledger: tuple[np.ndarray, float] | None = None,
        joints: Any = None,
        sensors: int = 0,
    ):
        super().__init__(None, len(x), wrench, load, fins, sensors)
        self.time, self.x, self._joints = time, x, joints
        self._ledger = ledger
        self._energy: EnergyLedger | None = None

    @property
    def joints(self) -> dict[str, np.ndarray]:
        """The arrays of `JOINT_ARRAYS` at the instant, without the dimension "time"; empty without a robot."""
        return {} if self._joints is None else {name: row[0] for name, row in self._joints.arrays.items()}

    @property
    def energy(self) -> EnergyLedger | None:
        """One float per field; None without a ledger."""
        if self._energy is None and self._ledger is not None:
            robot = None if self._joints is None else self._joints.ledger[0]
            self._energy = EnergyLedger.of(self.energies, self.powers, *self._ledger, robot)
        return self._energy

    @property
    def actuator_work(self) -> float | None:
        """[J] since the start; None without a ledger."""
        return None if self._ledger is None else float(self._ledger[0][0])

    @property
    def closure_torque(self) -> float | None:
        """[N m], remainder of the internal torque at the nose; None without the wrench."""
        return None if self.torque is None else float(self.closure[0])

    @property
    def closure_force(self) -> float | None:
        """[N], remainder of the internal force at the nose, minus the nose's load; None without the wrench."""
        return None if self.torque is None else float(self.closure[1])


@lru_cache(maxsize=64)
def places_of(
    samples: int | None, stations: int, wrench: bool, load: bool, fins: int = 0, sensors: int = 0
) -> tuple[Places, int]:
    """The places of all quantities, and the number of their numbers."""
    places: Places = {}
    end = 0
    for name, (begin, instants, numbers, of) in eel_core.layout(
        1 if samples is None else samples, stations, wrench, load, fins, sensors
    ).items():
        shape = (*((), (stations,), (fins,), (sensors,))[of], *(() if name == "fin_angle" else (numbers,)))
        end = begin + instants * math.prod(shape)
        places[name] = slice(begin, end), (instants, *shape) if samples is not None else shape if instants else None
    return places, end
