# SPDX-License-Identifier: Apache-2.0
"""The arrays of a run: dimensions, unit and meaning of each. Files, labelled arrays and tables take them from here."""

from typing import NamedTuple

import numpy as np

LABELS = {  # of the dimensions that are neither time, station nor swimmer
    "world": ("x", "y", "z"),
    "section": ("1", "2", "3"),
    "quaternion": ("x", "y", "z", "w"),
    "component": ("omega_1", "omega_2", "omega_3", "v_1", "v_2", "v_3"),
}


class Variable(NamedTuple):
    """An array of a run, or of a batch, whose first dimension is then `swimmer`."""

    dimensions: tuple[str, ...]
    unit: str
    description: str


def _variable(dimensions: str, unit: str, description: str) -> Variable:
    return Variable(tuple(dimensions.split()), unit, description)


VARIABLES = {
    "time": _variable("time", "s", "time"),
    "position": _variable("time world", "m", "head, world"),
    "orientation": _variable("time quaternion", "1", "world from head, x y z w"),
    "twist": _variable("time component", "rad/s, m/s", "(Omega, V) of the head, its axes"),
    "head_acceleration": _variable(
        "time component", "rad/s^2, m/s^2", "angular and true acceleration of the head, its axes"
    ),
    "center_of_mass": _variable("time world", "m", "centre of mass, world"),
    "x": _variable("station", "m", "stations of the profiles, from the nose"),
    "backbone": _variable("time station world", "m", "backbone, world"),
    "section_orientation": _variable("time station quaternion", "1", "world from section, x y z w"),
    "curvature": _variable("time station section", "rad/m", "curvature of the backbone, section axes"),
    "curvature_rate": _variable("time station section", "rad/m/s", "rate of the curvature, section axes"),
    "torque": _variable(
        "time station section", "N m", "internal torque of the part behind a section on the part ahead, section axes"
    ),
    "force": _variable("time station section", "N", "internal force likewise; along axis 1 tension is positive"),
    "fluid_force": _variable("time station section", "N/m", "force of the water on the body, section axes"),
    "resistive_force": _variable("time station section", "N/m", "resistive part of fluid_force"),
    "tail_force": _variable("time section", "N", "force of the water on the tail, section axes"),
    "nose_force": _variable("time section", "N", "force of the water on the nose, section axes"),
    "wake_momentum_rate": _variable(
        "time section", "N", "momentum given to the wake per time, section axes at the tail"
    ),
    "closure_torque": _variable("time", "N m", "magnitude of the internal torque left over at the nose"),
    "closure_force": _variable("time", "N", "magnitude of the internal force left over at the nose, less its load"),
}
ENERGY = "energy_"  # begins the names of the ledger's arrays
LEDGER = {
    "kinetic_body": ("J", "kinetic energy of the body"),
    "kinetic_fluid": ("J", "kinetic energy of the water, without the nose's added mass"),
    "potential": ("J", "potential energy of weight and buoyancy"),
    "actuator_power": ("W", "power of the actuators"),
    "wake_power": ("W", "power of the wake"),
    "nose_power": ("W", "power of the load on the nose"),
    "drag_power": ("W", "power of the drag along the body"),
    "residual": ("J", "change of all energy since the start less the works"),
    "actuator_work": ("J", "work of the actuators since the start"),
    "wake_work": ("J", "work of the wake since the start"),
    "nose_work": ("J", "work of the load on the nose since the start"),
    "drag_work": ("J", "work of the drag along the body since the start"),
}
VARIABLES |= {ENERGY + name: Variable(("time",), unit, description) for name, (unit, description) in LEDGER.items()}
OF_SWIMMERS = {  # of a batch alone
    "samples": _variable("", "1", "number of valid samples"),
    "steps": _variable("", "1", "accepted steps in time"),
    "evaluations": _variable("", "1", "evaluations of the head's dynamics"),
    "nodes": _variable("", "1", "nodes along the body"),
    "energy_at_start": _variable("", "J", "kinetic and potential energy at the start"),
}


class Contents(NamedTuple):
    """A run or a batch, taken apart.

    kind: "run" or "batch". values: what JSON can hold. arrays: by the names of `VARIABLES` and `OF_SWIMMERS`.
    """

    kind: str
    values: dict
    arrays: dict[str, np.ndarray]

    def variable(self, name: str) -> Variable:
        """Dimensions, unit and meaning of an array of these contents."""
        if self.kind == "run" or name == "time":
            return VARIABLES[name]
        found = (VARIABLES | OF_SWIMMERS)[name]
        return found._replace(dimensions=("swimmer", *found.dimensions))
