# SPDX-License-Identifier: Apache-2.0
"""The arrays of a run: dimensions, unit and meaning of each.

They are those of `Observations` and `EnergyLedger`, and a few more. Files, labelled arrays, tables and the
documentation of `Run` and `Batch` use this list.
"""

from collections.abc import Callable
from dataclasses import fields
from typing import Any, NamedTuple, TypeVar, get_type_hints

import numpy as np

from eel_dynamics.model.axes import REP103
from eel_dynamics.simulation.bending.joint_motion import JOINT_ARRAYS, OF_LEDGER, JointMotion
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import FINS, LOAD, OBSERVED, SENSORS, WRENCH, Observations, Variable

Kind = TypeVar("Kind", bound=type)

LABELS = {  # of the dimensions that are neither time, station nor swimmer
    "world": ("x", "y", "z"),
    "section": ("1", "2", "3"),
    "quaternion": ("x", "y", "z", "w"),
    "component": ("omega_x", "omega_y", "omega_z", "v_x", "v_y", "v_z"),
}
SIZES = {"time": "T", "station": "M", "swimmer": "B", "fin": "F", "joint": "J", "mode": "N"}  # of other dimensions
OWN = {  # of a run itself
    "time": Variable(("time",), "s", "time"),
    "x": Variable(("station",), "m", "stations of the profiles, from the nose"),
    **{name: each for name, each in OBSERVED.items() if name not in ("energies", "powers", "closure", *SENSORS)},
    "closure_torque": Variable(("time",), "N m", "magnitude of the internal torque left over at the nose"),
    "closure_force": Variable(("time",), "N", "magnitude of the internal force left over at the nose, less its load"),
    **JOINT_ARRAYS,
}
ENERGY = "energy_"  # prefix of the ledger's arrays in a file
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


PARTS = {  # arrays that not every run has
    "wrench": WRENCH,
    "load": LOAD,
    "fins": FINS,
    "robot": tuple(JOINT_ARRAYS),
    "ledger": tuple(ENERGY + name for name in LEDGER),
}


def names_with(**there: Any) -> list[str]:
    """Names of the arrays of runs, except time and x, with these `PARTS`."""
    absent = {"time", "x"}.union(*(PARTS[part] for part, present in there.items() if not present))
    return [name for name in VARIABLES if name not in absent]


def shape_of(name: str, sizes: dict[str, int]) -> tuple[int, ...]:
    """The shape of an array of a run. sizes: of the dimensions without labels; 0 if one is absent."""
    return tuple(len(LABELS[each]) if each in LABELS else sizes.get(each, 0) for each in VARIABLES[name].dimensions)


def variable_of(kind: str, name: str) -> Variable:
    """Dimensions, unit and meaning of an array of a `kind`, "run" or "batch"."""
    found = (VARIABLES | OF_SWIMMERS)[name]
    if kind == "run" or name == "time":
        return found
    return found._replace(dimensions=("swimmer", *found.dimensions))


def arrays_of(
    out: Observations, works: np.ndarray, start: float, joints: JointMotion | None, done: int, ledger: bool
) -> dict[str, np.ndarray]:
    """The arrays of a run by their names in `VARIABLES`, except time and x, without those that were not requested.

    out, works (T, 8) [J], start [J]: the observations, the works since the start and the energy there. joints: the
    motion of a robot's joints. done: number of valid instants.
    """
    arrays = {name: array[:done] for name, array in out.arrays().items() if name not in SENSORS}
    energies, powers, closure = (arrays.pop(name) for name in ("energies", "powers", "closure"))
    arrays |= {"closure_torque": closure[:, 0], "closure_force": closure[:, 1]}
    for first, *others in (WRENCH, LOAD, FINS):
        if not all(out.places[first][1] or ()):
            for name in (first, *others):
                del arrays[name]
    if joints is not None:
        arrays |= {name: each[:done] for name, each in joints.arrays.items()}
    if ledger:
        energy = EnergyLedger.of(energies, powers, works[:done], start, joints and joints.ledger[:done])
        arrays |= {ENERGY + name: getattr(energy, name) for name in LEDGER}
    return arrays


def fields_of_arrays(arrays: dict[str, np.ndarray], robot: Any) -> dict[str, Any]:
    """The fields of a `Run` from `arrays`, by their names in `VARIABLES`; None for a missing one.

    robot: of the run; one with tails only may have no arrays of joints. Files of still water or imposed bending may
    lack their powers in the ledger.
    """
    energy: EnergyLedger | None = None
    if ENERGY + "residual" in arrays:
        none = np.zeros_like(arrays[ENERGY + "residual"])
        later = (
            *(f"{part}_{what}" for part in ("flow", "fins", "appendages", "external") for what in ("power", "work")),
            *OF_LEDGER,
        )
        absent = {name: none for name in later if ENERGY + name not in arrays}
        energy = EnergyLedger(**absent | {name: arrays[ENERGY + name] for name in LEDGER if name not in absent})
    if robot is not None:
        arrays = dict.fromkeys(JOINT_ARRAYS, np.zeros((len(arrays["time"]), 0))) | arrays
    return {name: arrays.get(name) for name in OWN} | {"energy": energy}


def documented_arrays(kind: str) -> Callable[[Kind], Kind]:
    """Decorator of the dataclass of a `kind`: appends shape, unit and meaning of its arrays to its docstring."""

    def documented(owner: Kind) -> Kind:
        lines = []
        names = {item.name for item in fields(owner)}
        for name in (name for name in OWN | OF_SWIMMERS if name in names):
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
