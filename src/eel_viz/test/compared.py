# SPDX-License-Identifier: Apache-2.0
"""Two recordings, entity by entity and number by number."""

from pathlib import Path

import numpy as np
import pyarrow as pa
from rerun.chunk import RrdReader

ALWAYS = 2**63 - 1  # ns
OWN = "/__properties"  # what a recording says of itself
TEXT = "/run/"  # what topics tell each other there depends on the order in which they come


def contents(path: Path, until: int = ALWAYS) -> dict[tuple[str, str], tuple[np.ndarray, pa.Array]]:
    """(entity, component): times [ns] in order, -1 for always, and the values at each."""
    pieces: dict[tuple[str, str], list] = {}
    for chunk in RrdReader(str(path)).stream():
        batch = chunk.to_record_batch()
        times = np.full(chunk.num_rows, -1)
        if not chunk.is_static:
            times = batch.column("sim_time").cast("int64").to_numpy()
        for name in batch.schema.names:
            if ":" in name:
                there = batch.column(name).is_valid().to_numpy(zero_copy_only=False)
                pieces.setdefault((str(chunk.entity_path), name), []).append(
                    (times[there], batch.column(name).filter(there))
                )
    found = {}
    for key, parts in pieces.items():
        times = np.concatenate([part[0] for part in parts])
        order = np.argsort(times, kind="stable")
        order = order[times[order] <= until]
        found[key] = (times[order], pa.concat_arrays([part[1] for part in parts]).take(order))
    return found


def differences(
    one: Path, other: Path, *, texts: bool = False, until: int = ALWAYS, tolerance: float = 0.0
) -> list[str]:
    """What is not the same in both, in words; the recordings' own properties apart, and `texts` only on demand.

    `until`: what comes after it [ns] is not looked at. `tolerance`: of numbers, relative to the greatest of their kind;
    with it three in a hundred of the colours, which are rounded to integers, may be the next one: nose and tail carry
    no torque, and its colour lies on an edge of the rounding.
    """
    first, second = contents(one, until), contents(other, until)
    said = [f"{key} is in one alone" for key in sorted(first.keys() ^ second.keys()) if not key[0].startswith(OWN)]
    for key in sorted(first.keys() & second.keys()):
        if key[0].startswith(OWN) or (key[0].startswith(TEXT) and not texts):
            continue
        (times, values), (other_times, other_values) = first[key], second[key]
        if not np.array_equal(times, other_times):
            said.append(f"{key}: {len(times)} and {len(other_times)} times")
        elif not values.equals(other_values) and not (tolerance and near(values, other_values, tolerance)):
            where = next(t for t, a, b in zip(times, values, other_values, strict=True) if not a.equals(b))
            said.append(f"{key}: values at {where} ns and maybe later")
    return said


def near(values: pa.Array, other: pa.Array, tolerance: float) -> bool:
    """Whether two arrays of numbers, of any nesting, are alike."""
    one, two = flat(values), flat(other)
    if one is None or one.shape != two.shape or one.dtype.kind not in "iuf":
        return False
    if one.dtype.kind != "f":
        return bool(np.mean(one != two) < 0.03)
    return bool(np.all(np.abs(one - two) <= tolerance * np.abs(one).max(initial=0.0)))


def flat(values: pa.Array) -> np.ndarray | None:
    """All numbers in lists of lists; None if they are no numbers."""
    while pa.types.is_list(values.type) or pa.types.is_fixed_size_list(values.type):
        values = values.flatten()
    return values.to_numpy(zero_copy_only=False) if pa.types.is_primitive(values.type) else None
