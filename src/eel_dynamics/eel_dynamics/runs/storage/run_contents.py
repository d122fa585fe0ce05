# SPDX-License-Identifier: Apache-2.0
"""Takes a run, or a batch, apart into `Contents`, and puts their fields together again."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from eel_base.wording import shown
from eel_model.axes import REP103, turn_vector, turned
from eel_model.fins.fins import Fin, RollHold
from eel_model.flow.plain import flow_of, plain_of_flow
from eel_model.scene import Scene

from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.runs.storage import plain
from eel_dynamics.runs.storage.variables import COUNTS, ENERGY, LEDGER, OWN, Contents
from eel_dynamics.simulation.bending.joint_motion import JOINT_ARRAYS, OF_LEDGER, Motion
from eel_dynamics.simulation.energy import WORKS, EnergyLedger
from eel_dynamics.simulation.observations import OBSERVED, Observations


def contents_of_run(run: Any) -> Contents:
    """The contents of a `Run`. `ValueError` for one without samples."""
    if not len(run.time):
        raise ValueError("a run without samples holds no data")
    values = {
        **{name: plain.plain_of(getattr(run, name)) for name in ("law", "body", "scene", "accuracy", "error_estimate")},
        "flow": plain_of_flow(run.flow),
        "fins": [asdict(fin) for fin in run.fins],
        "robot": plain.plain_robot(run.robot, run.body),
        "warnings": list(run.warnings),
        **{name: int(getattr(run, name)) for name in COUNTS},
    }
    arrays = {name: getattr(run, name) for name in OWN if getattr(run, name) is not None}
    arrays = {name: each for name, each in arrays.items() if each.size or name not in JOINT_ARRAYS}  # of no joints
    return Contents("run", values, arrays | _of_ledger(run.energy), run.axes)


def fields_of_run(contents: Contents) -> dict[str, Any]:
    """The fields of the `Run` of these contents."""
    values, arrays = contents.values, contents.arrays
    if values.get("robot"):
        none = np.zeros((len(arrays["time"]), 0))
        arrays = dict.fromkeys(JOINT_ARRAYS, none) | arrays
    energy = None
    if ENERGY + "residual" in arrays:
        energy = EnergyLedger(**_ledger_of(arrays))
    return {
        "law": plain.law_of(values["law"]),
        "body": plain.body_of(values["body"]),
        "scene": Scene(**values["scene"]),
        "accuracy": plain.accuracy_of(values["accuracy"]),
        "error_estimate": values["error_estimate"] and ErrorEstimate(**values["error_estimate"]),
        "energy": energy,
        "flow": flow_of(values.get("flow")),
        "fins": fins_of(values.get("fins", ())),
        "robot": plain.robot_of(values.get("robot"), plain.body_of(values["body"])),
        "axes": contents.axes,
        **{name: arrays.get(name) for name in OWN},
        **{name: _count(name, values[name]) for name in COUNTS},
    }


def fins_of(plain: Sequence[dict[str, Any]]) -> tuple[Fin, ...]:
    """The fins that have become plain values."""
    with_hold = (
        each | {"angle": RollHold(**each["angle"])} if isinstance(each["angle"], dict) else each for each in plain
    )
    return tuple(Fin(**each) for each in with_hold)


def in_rep103_axes(contents: Contents) -> Contents:
    """The contents, fresh from a file, with world and head in the library's axes."""
    if contents.axes == REP103:
        return contents
    values = contents.values
    for scene in [values["scene"]] if contents.kind == "run" else values["scenes"]["values"]:
        scene["current"] = turn_vector(scene["current"]).tolist()
    return contents._replace(arrays=contents.arrays | turned(contents.arrays), axes=REP103)


def contents_of_batch(
    batch: Any, out: Observations, works: np.ndarray, energy_at_start: np.ndarray, robots: np.ndarray | None
) -> Contents:
    """The contents of a `Batch`, with all that was observed of its swimmers; without their robots and warnings."""
    values = {
        **{name: plain.each_once(getattr(batch, name)) for name in ("laws", "bodies", "scenes", "accuracies")},
        "error_estimates": [plain.plain_of(each) for each in batch.error_estimates],
        "errors": [plain.plain_of(each) for each in batch.error],
        "flows": [plain_of_flow(each) for each in batch.flows],
        "fins": [[asdict(fin) for fin in each] for each in batch.fins],
        "stations": batch.backbone is not None,
    }
    arrays = {"time": batch.time, "x": batch.x, "samples": batch.samples, "energy_at_start": energy_at_start}
    arrays |= {name: getattr(batch, name) for name in COUNTS}
    arrays |= {name: array for name, array in out.arrays().items() if name in OWN}
    arrays |= {"closure_torque": out.closure[..., 0], "closure_force": out.closure[..., 1]}
    arrays |= {name: getattr(batch, name) for name in JOINT_ARRAYS if getattr(batch, name) is not None}
    arrays |= _of_ledger(EnergyLedger.of(out.energies, out.powers, works, energy_at_start[:, None], robots))
    return Contents("batch", values, {name: each for name, each in arrays.items() if each.size})


def with_warnings(batch: Any, contents: Contents) -> Contents:
    """The `contents` of a `Batch`, and for each swimmer its robot and its warnings."""
    lines = [list(batch[index].warnings) if samples else [] for index, samples in enumerate(batch.samples)]
    robots = [plain.plain_robot(*each) for each in zip(batch.robots, batch.bodies, strict=True)]
    return contents._replace(values=contents.values | {"robots": robots, "warnings": lines})


def motion_of_batch(contents: Contents) -> Motion:
    """The motion of the robots of a batch."""
    none, ledger = np.zeros((*contents.arrays["position"].shape[:2], 0)), _ledger_of(contents.arrays)
    arrays = {name: contents.arrays.get(name, none) for name in JOINT_ARRAYS}
    return Motion(arrays, np.stack([ledger[name] for name in OF_LEDGER], axis=-1))


def observed_of_batch(contents: Contents) -> tuple[Observations, np.ndarray]:
    """The observations of a batch, and its works (B, T, 6) [J]."""
    arrays = contents.arrays
    count, samples, stations = arrays["backbone"].shape[:3]
    fins = arrays["fin_angle"].shape[-1] if "fin_angle" in arrays else 0
    out = Observations.empty(samples, stations, "torque" in arrays, "fluid_force" in arrays, (count,), fins)
    for name in OBSERVED.keys() & arrays.keys():
        getattr(out, name)[...] = arrays[name]
    if out.closure.size:
        out.closure[..., 0], out.closure[..., 1] = arrays["closure_torque"], arrays["closure_force"]
    ledger = _ledger_of(arrays)
    energies = ("kinetic_body", "kinetic_fluid", "potential")
    out.energies[...] = np.stack([ledger[name] for name in energies], axis=-1)
    out.powers[...] = np.stack([ledger[f"{part}_power"] for part in WORKS], axis=-1)
    return out, np.stack([ledger[f"{part}_work"] for part in WORKS], axis=-1)


def _ledger_of(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays of the ledger; files of still water or imposed bending need not have theirs."""
    none = np.zeros_like(arrays[ENERGY + "residual"])
    later = "flow_power", "flow_work", "fins_power", "fins_work", *OF_LEDGER
    absent = {name: none for name in later if ENERGY + name not in arrays}
    return absent | {name: arrays[ENERGY + name] for name in LEDGER if name not in absent}


def _count(name: str, value: Any) -> int:
    if not isinstance(value, int) or value < 0:
        raise ValueError(f"{name} must be a whole number >= 0, got {shown(value)}")
    return value


def _of_ledger(energy: EnergyLedger | None) -> dict[str, np.ndarray]:
    return {} if energy is None else {ENERGY + name: energy[name] for name in LEDGER}
