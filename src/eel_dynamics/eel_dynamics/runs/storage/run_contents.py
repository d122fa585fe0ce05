# SPDX-License-Identifier: Apache-2.0
"""Converts a run, or a batch, into `Contents`, and back."""

from typing import Any

import numpy as np
from eel_common.wording import shown

from eel_dynamics.model.axes import REP103, turn_vector, turned
from eel_dynamics.runs.storage import plain
from eel_dynamics.runs.storage.variables import COUNTS, ENERGY, OWN, Contents, fields_of_arrays
from eel_dynamics.simulation.bending.joint_motion import JOINT_ARRAYS

OF_EACH = {  # fields of a run: fields of a batch with a value per swimmer
    "law": "laws",
    "body": "bodies",
    "scene": "scenes",
    "flow": "flows",
    "robot": "robots",
    "fins": "fins",
    "wrenches": "wrenches",
    "accuracy": "accuracies",
    "error_estimate": "error_estimates",
}


def contents_of_run(run: Any) -> Contents:
    """The contents of a `Run`. `ValueError` for one without samples."""
    if not len(run.time):
        raise ValueError("a run without samples holds no data")
    values = {
        **{name: plain.plain_of(getattr(run, name)) for name in plain.READERS},
        "robot": plain.plain_robot(run.robot, run.body),
        "warnings": list(run.warnings),
        **{name: int(getattr(run, name)) for name in COUNTS},
    }
    return Contents("run", values, arrays_of_run(run), run.axes)


def arrays_of_run(run: Any) -> dict[str, np.ndarray]:
    """The arrays of a `Run` by their names in `VARIABLES`, without missing ones."""
    arrays = {name: getattr(run, name) for name in OWN if getattr(run, name) is not None}
    arrays = {name: each for name, each in arrays.items() if each.size or name not in JOINT_ARRAYS}  # without joints
    return arrays | ({} if run.energy is None else {ENERGY + name: each for name, each in vars(run.energy).items()})


def fields_of_run(contents: Contents) -> dict[str, Any]:
    """The fields of the `Run` of these contents."""
    values = contents.values
    own = {name: read(values.get(name)) for name, read in plain.READERS.items()}
    robot = plain.robot_of(values.get("robot"), own["body"])
    counts = {name: _count(name, values[name]) for name in COUNTS}
    return own | fields_of_arrays(contents.arrays, robot) | counts | {"robot": robot, "axes": contents.axes}


def in_rep103_axes(contents: Contents) -> Contents:
    """The contents from a file, with world and head converted to the library's axes."""
    if contents.axes == REP103:
        return contents
    values = contents.values
    for scene in [values["scene"]] if contents.kind == "run" else values["scenes"]["values"]:
        scene["current"] = turn_vector(scene["current"]).tolist()
    return contents._replace(arrays=contents.arrays | turned(contents.arrays), axes=REP103)


def contents_of_batch(batch: Any, arrays: dict[str, np.ndarray], energy_at_start: np.ndarray) -> Contents:
    """The contents of a `Batch` with all `arrays` of its swimmers."""
    values = {name: plain.plain_of(getattr(batch, name)) for name in ("error_estimates", "flows", "fins", "wrenches")}
    values |= {name: plain.each_once(getattr(batch, name)) for name in ("laws", "bodies", "scenes", "accuracies")}
    values |= {"errors": plain.plain_of(batch.error), "stations": batch.backbone is not None}
    robots = map(plain.plain_robot, batch.robots, batch.bodies)
    lines = [list(batch[index].warnings) if samples else [] for index, samples in enumerate(batch.samples)]
    values |= {"robots": list(robots), "warnings": lines}
    own = {name: getattr(batch, name) for name in ("time", "x", "samples", *COUNTS)}
    return Contents("batch", values, own | {"energy_at_start": energy_at_start} | arrays)


def own_of_batch(contents: Contents) -> dict[str, Any]:
    """The fields of a batch with a value per swimmer."""
    values, none = contents.values, len(contents.arrays["samples"]) * [None]
    several = {OF_EACH[name]: read for name, read in plain.READERS.items()}
    own: dict[str, Any] = {name: plain.row_of(values.get(name, none), read) for name, read in several.items()}
    own["robots"] = list(map(plain.robot_of, values.get("robots", none), own["bodies"]))
    own["error"] = plain.row_of(values["errors"], plain.stop_of)
    if any(len(each) != len(none) for each in own.values()):
        raise ValueError(f"there must be a law, a body, a scene and settings for each of {len(none)} swimmers")
    return own


def _count(name: str, value: Any) -> int:
    if not isinstance(value, int) or value < 0:
        raise ValueError(f"{name} must be a whole number >= 0, got {shown(value)}")
    return value
