# SPDX-License-Identifier: Apache-2.0
"""The arrays of a run: dimensions, unit and meaning of each.

They are those of `Observations` and `EnergyLedger`, and a few more. Files, labelled arrays, tables and the
documentation of `Run` and `Batch` take them from here.
"""

from collections.abc import Callable
from dataclasses import fields
from typing import Any, NamedTuple, TypeVar, get_type_hints

import numpy as np
from eel_model.axes import REP103

from eel_dynamics.simulation.bending.joint_motion import JOINT_ARRAYS
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import OBSERVED, Variable

Kind = TypeVar("Kind", bound=type)

LABELS = {  # of the dimensions that are neither time, station nor swimmer
    "world": ("x", "y", "z"),
    "section": ("1", "2", "3"),
    "quaternion": ("x", "y", "z", "w"),
    "component": ("omega_x", "omega_y", "omega_z", "v_x", "v_y", "v_z"),
}
SIZES = {
    "time": "T",
    "station": "M",
    "swimmer": "B",
    "fin": "F",
    "joint": "J",
    "mode": "N",
}  # of other dimensions
CLOSURES = {
    "closure_torque": Variable(("time",), "N m", "magnitude of the internal torque left over at the nose"),
    "closure_force": Variable(("time",), "N", "magnitude of the internal force left over at the nose, less its load"),
}
OWN = {  # of a run itself
    "time": Variable(("time",), "s", "time"),
    "x": Variable(("station",), "m", "stations of the profiles, from the nose"),
    **{name: each for name, each in OBSERVED.items() if name not in ("energies", "powers", "closure")},
    **CLOSURES,
    **JOINT_ARRAYS,
}
ENERGY = "energy_"  # begins the names of the ledger's arrays in a file
LEDGER = {
    name: Variable(("time",), *hint.__metadata__)
    for name, hint in get_type_hints(EnergyLedger, include_extras=True).items()
}
VARIABLES = OWN | {ENERGY + name: each for name, each in LEDGER.items()}
COUNTS = {
    "steps": Variable((), "1", "accepted steps in time"),
    "evaluations": Variable((), "1", "evaluations of the head's dynamics, for the motion alone"),
    "nodes": Variable((), "1", "nodes along the body"),
}
OF_SWIMMERS = {  # of a batch alone
    "samples": Variable((), "1", "number of valid samples"),
    **COUNTS,
    "energy_at_start": Variable((), "J", "kinetic and potential energy at the start"),
}


def variable_of(kind: str, name: str) -> Variable:
    """Dimensions, unit and meaning of an array of a `kind`, "run" or "batch"."""
    found = (VARIABLES | OF_SWIMMERS)[name]
    if kind == "run" or name == "time":
        return found
    return found._replace(dimensions=("swimmer", *found.dimensions))


def documented_arrays(kind: str) -> Callable[[Kind], Kind]:
    """Decorator of the dataclass of a `kind`: shape, unit and meaning of its arrays follow its docstring."""

    def documented(owner: Kind) -> Kind:
        lines = []
        for name in (item.name for item in fields(owner) if item.name in OWN | OF_SWIMMERS):
            dimensions, unit, description = variable_of(kind, name)
            shape = [SIZES[each] if each in SIZES else str(len(LABELS[each])) for each in dimensions]
            size = f"({', '.join(shape)}{',' if len(shape) == 1 else ''})" if shape else "a whole number"
            lines.append(f"    {name}: {size}{'' if unit == '1' else f' [{unit}]'}, {description}")
        owner.__doc__ = f"{(owner.__doc__ or '').rstrip()}\n\n" + "\n".join(lines) + "\n"
        return owner

    return documented


class Contents(NamedTuple):
    """A run or a batch, taken apart.

    kind: "run" or "batch". values: what JSON can hold. arrays: by the names of `VARIABLES` and `OF_SWIMMERS`. axes: of
    world and head, one of `model.axes.CONVENTIONS`.
    """

    kind: str
    values: dict[str, Any]
    arrays: dict[str, np.ndarray]
    axes: str = REP103

    def variable(self, name: str) -> Variable:
        """Dimensions, unit and meaning of an array of these contents."""
        return variable_of(self.kind, name)
