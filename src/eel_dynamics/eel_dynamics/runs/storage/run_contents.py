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
from eel_dynamics.runs.storage.variables import COUNTS, ENERGY, LEDGER, OWN, Contents, fields_of_arrays
from eel_dynamics.simulation.bending.joint_motion import JOINT_ARRAYS


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
    return Contents("run", values, arrays_of_run(run), run.axes)


def arrays_of_run(run: Any) -> dict[str, np.ndarray]:
    """The arrays of a `Run` by their names in `VARIABLES`; those that it has not are left out."""
    arrays = {name: getattr(run, name) for name in OWN if getattr(run, name) is not None}
    arrays = {name: each for name, each in arrays.items() if each.size or name not in JOINT_ARRAYS}  # of no joints
    return arrays | ({} if run.energy is None else {ENERGY + name: run.energy[name] for name in LEDGER})


def fields_of_run(contents: Contents) -> dict[str, Any]:
    """The fields of the `Run` of these contents."""
    values, body = contents.values, plain.body_of(contents.values["body"])
    robot = plain.robot_of(values.get("robot"), body)
    return {
        "law": plain.law_of(values["law"]),
        "body": body,
        "scene": Scene(**values["scene"]),
        "accuracy": plain.accuracy_of(values["accuracy"]),
        "error_estimate": values["error_estimate"] and ErrorEstimate(**values["error_estimate"]),
        "flow": flow_of(values.get("flow")),
        "fins": fins_of(values.get("fins", ())),
        "robot": robot,
        "axes": contents.axes,
        **fields_of_arrays(contents.arrays, robot),
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


def contents_of_batch(batch: Any, arrays: dict[str, np.ndarray], energy_at_start: np.ndarray) -> Contents:
    """The contents of a `Batch` with all `arrays` of its swimmers; without their robots and warnings."""
    values = {
        **{name: plain.each_once(getattr(batch, name)) for name in ("laws", "bodies", "scenes", "accuracies")},
        "error_estimates": [plain.plain_of(each) for each in batch.error_estimates],
        "errors": [plain.plain_of(each) for each in batch.error],
        "flows": [plain_of_flow(each) for each in batch.flows],
        "fins": [[asdict(fin) for fin in each] for each in batch.fins],
        "stations": batch.backbone is not None,
    }
    own = {name: getattr(batch, name) for name in ("time", "x", "samples", *COUNTS)}
    return Contents("batch", values, own | {"energy_at_start": energy_at_start} | arrays)


def with_warnings(batch: Any, contents: Contents) -> Contents:
    """The `contents` of a `Batch`, and for each swimmer its robot and its warnings."""
    lines = [list(batch[index].warnings) if samples else [] for index, samples in enumerate(batch.samples)]
    robots = [plain.plain_robot(*each) for each in zip(batch.robots, batch.bodies, strict=True)]
    return contents._replace(values=contents.values | {"robots": robots, "warnings": lines})


def _count(name: str, value: Any) -> int:
    if not isinstance(value, int) or value < 0:
        raise ValueError(f"{name} must be a whole number >= 0, got {shown(value)}")
    return value
