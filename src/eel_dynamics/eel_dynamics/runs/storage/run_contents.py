# SPDX-License-Identifier: Apache-2.0
"""Takes a run, or a batch, apart into `Contents`, and puts their fields together again."""

import numpy as np
from eel_base.wording import shown

from eel_dynamics.runs.storage import plain
from eel_dynamics.runs.storage.variables import ENERGY, LEDGER, VARIABLES, Contents
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import Observations, empty_observations

COUNTS = ("steps", "evaluations", "nodes")
OWN = tuple(name for name in VARIABLES if not name.startswith(ENERGY))  # arrays of a run, the ledger's apart
OBSERVED = tuple(name for name in OWN if name in Observations._fields)


def contents_of_run(run) -> Contents:
    """The contents of a `Run`. `ValueError` for one without samples."""
    if not len(run.time):
        raise ValueError("a run without samples holds no data")
    values = {
        "law": plain.plain_law(run.law),
        "body": plain.plain_body(run.body),
        "scene": plain.plain_scene(run.scene),
        "accuracy": plain.plain_accuracy(run.accuracy),
        "error_estimate": plain.plain_error_estimate(run.error_estimate),
        "warnings": list(run.warnings),
        **{name: int(getattr(run, name)) for name in COUNTS},
    }
    arrays = {name: getattr(run, name) for name in OWN if getattr(run, name) is not None}
    return Contents("run", values, arrays | _of_ledger(run.energy))


def fields_of_run(contents: Contents) -> dict:
    """The fields of the `Run` of these contents."""
    values, arrays = contents.values, contents.arrays
    energy = None
    if ENERGY + "residual" in arrays:
        energy = EnergyLedger(**{name: arrays[ENERGY + name] for name in LEDGER})
    return {
        "law": plain.law_of(values["law"]),
        "body": plain.body_of(values["body"]),
        "scene": plain.scene_of(values["scene"]),
        "accuracy": plain.accuracy_of(values["accuracy"]),
        "error_estimate": plain.error_estimate_of(values["error_estimate"]),
        "energy": energy,
        **{name: arrays.get(name) for name in OWN},
        **{name: _count(name, values[name]) for name in COUNTS},
    }


def contents_of_batch(batch, out: Observations, works: np.ndarray, energy_at_start: np.ndarray) -> Contents:
    """The contents of a `Batch`, with all that was observed of its swimmers; without their warnings."""
    values = {
        "laws": plain.told_once(batch.laws, plain.plain_law),
        "bodies": plain.told_once(batch.bodies, plain.plain_body),
        "scenes": plain.told_once(batch.scenes, plain.plain_scene),
        "accuracies": plain.told_once(batch.accuracies, plain.plain_accuracy),
        "error_estimates": [plain.plain_error_estimate(each) for each in batch.error_estimates],
        "errors": [plain.plain_stop(each) for each in batch.error],
        "stations": batch.backbone is not None,
    }
    arrays = {"time": batch.time, "x": batch.x, "samples": batch.samples, "energy_at_start": energy_at_start}
    arrays |= {name: getattr(batch, name) for name in COUNTS}
    arrays |= {name: getattr(out, name) for name in OBSERVED}
    arrays |= {"closure_torque": out.closure[..., 0], "closure_force": out.closure[..., 1]}
    arrays |= _of_ledger(EnergyLedger.of(out.energies, out.powers, works, energy_at_start[:, None]))
    return Contents("batch", values, {name: each for name, each in arrays.items() if each.size})


def with_warnings(batch, contents: Contents) -> Contents:
    """The `contents` of a `Batch`, and for each swimmer its warnings."""
    told = [list(batch[index].warnings) if samples else [] for index, samples in enumerate(batch.samples)]
    return contents._replace(values=contents.values | {"warnings": told})


def observed_of_batch(contents: Contents) -> tuple[Observations, np.ndarray]:
    """The observations of a batch, and its works (B, T, 4) [J]."""
    arrays = contents.arrays
    count, samples, stations = arrays["backbone"].shape[:3]
    out = empty_observations(samples, stations, "torque" in arrays, "fluid_force" in arrays, (count,))
    for name in OBSERVED:
        if name in arrays:
            getattr(out, name)[...] = arrays[name]
    if out.closure.size:
        out.closure[..., 0], out.closure[..., 1] = arrays["closure_torque"], arrays["closure_force"]
    ledger = {name: arrays[ENERGY + name] for name in LEDGER}
    energies = ("kinetic_body", "kinetic_fluid", "potential")
    out.energies[...] = np.stack([ledger[name] for name in energies], axis=-1)
    parts = ("actuator", "wake", "nose", "drag")
    out.powers[...] = np.stack([ledger[f"{part}_power"] for part in parts], axis=-1)
    return out, np.stack([ledger[f"{part}_work"] for part in parts], axis=-1)


def _count(name: str, value) -> int:
    if not isinstance(value, int) or value < 0:
        raise ValueError(f"{name} must be a whole number >= 0, got {shown(value)}")
    return value


def _of_ledger(energy: EnergyLedger | None) -> dict[str, np.ndarray]:
    return {} if energy is None else {ENERGY + name: energy[name] for name in LEDGER}
