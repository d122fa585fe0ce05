# SPDX-License-Identifier: Apache-2.0
"""Motions in files: measured midlines, curvature or joint angles in a text table or an .npz file, or rows of a law in
an .npz.

The kind is recognised by the columns; all have `time` [s]:

    x, y, perhaps z, arc_length [m]         midlines: rows of one time are a frame, from nose to tail
    arc_length [m], yaw, perhaps pitch      measured curvature [rad/m], likewise
    yaw_1, yaw_2 ..., pitch_1 ...           joint angles [rad], a row for each instant

Joint j of n stands for the segment (j - 1) l/n to j l/n, as in `Run.actuators`. Its angle is the integral of the
curvature over its segment. So the curvature is the derivative of the spline through the sums of the angles.

yaw > 0 bends the tail to the right, pitch > 0 down, as in messages. x, y, z are right-handed axes of the laboratory
with z up. The swimmer's direction in them does not matter. An .npz holds the same columns, or arrays (N, n) for N
instants and n points; or `time`, `x` and `values` of a `SampledLaw`, as `save_law` writes them.
"""

import os
import re
from collections.abc import Iterable
from functools import partial
from pathlib import Path

import numpy as np
from eel_common.files.archive import read_archive
from eel_common.files.input_file import reading
from eel_common.files.output_file import replacing
from eel_common.files.table import LARGEST_ANGLE, Table, split_name
from eel_common.files.tables import SUFFIXES, is_table, read_table
from eel_common.files.times import time_of
from eel_common.quantity import checked_path, positive
from eel_common.wording import shown

from eel_gaits.sources.frames import Frames, SmoothedFrames, check_rising, check_steps, frames_of, law_of_frames
from eel_gaits.sources.midlines import Midlines
from eel_gaits.sources.sampled_law import SampledLaw

LAW = {"time", "x", "values"}  # names of the arrays with a law's rows
ARCHIVE = ".npz"
COLUMN = re.compile(r"(pitch|yaw)_([1-9][0-9]*)")  # the name of a joint's column
FEWEST_JOINTS = 3  # per axis
FITTING = 1e-6  # largest difference in length of a law's rows from the body, as a part


def read_motion(
    path: str | os.PathLike[str],
    *,
    length: float = 1.0,
    scale: float = 1.0,
    smooth: bool = True,
    name: str | None = None,
    time: str = "",
) -> SampledLaw:
    """The law of the motion in a text table or an .npz file, for a body of `length` [m].

    scale: metres per unit of length in the file. smooth: smooth measured data by generalised cross-validation;
    otherwise the splines go through them. name: of the law; by default the file's. time: the column of times, if its
    name is not recognised. `ValueError` in one line names file, line, column and value at fault.
    """
    path = checked_path("path", path)
    length, scale = positive("length", length, "m"), positive("scale", scale)
    name = path.stem if name is None else name
    with reading(shown(str(path))):
        return _motion(path, length, scale, smooth, name, time)


def _motion(path: Path, length: float, scale: float, smooth: bool, name: str, time: str) -> SampledLaw:
    if not is_table(path, ARCHIVE):
        raise ValueError(f"a motion must be in a table ({', '.join(SUFFIXES)}) or an .npz file")
    if path.suffix.lower() == ARCHIVE and (law := _rows(path, length, name)) is not None:
        return law
    table = read_table(path)
    kind = kind_of(table)
    if kind == "joints":
        return _law_of_joints(table, length, name, time, smooth)
    if kind == "curvature":
        return _law_of_curvature(table, length, scale, name, time, smooth)
    return Midlines(table, length, scale, time).law(name, smooth)


def read_midlines(path: str | os.PathLike[str], *, length: float = 1.0, scale: float = 1.0) -> Midlines:
    """The midlines in a text table or an .npz file, as measured. `ValueError` as in `read_motion`, and for other
    motions.
    """
    with reading(shown(str(path))):
        table = read_table(path)
        if kind_of(table) != "midlines":
            raise table.error("it holds no midlines: columns time, x, y")
        return Midlines(table, length, scale)


def save_law(law: SampledLaw, path: str | os.PathLike[str]) -> None:
    """Write the rows of `law` to an .npz file for `read_motion`. `NotWritten` if that fails."""
    with replacing(path) as draft:
        np.savez_compressed(draft, time=law.time, x=law.x, values=law.values)


def kind_of(table: Table) -> str:
    """The kind of motion by a table's columns: midlines, joints or curvature. `ValueError` for anything else."""
    if "x" in table and "y" in table:
        return "midlines"
    if joint_columns(table.head):
        return "joints"
    if "arc_length" in table and "yaw" in table:
        return "curvature"
    raise table.error(
        "its columns must be time and: x, y (midlines), or yaw_1, yaw_2 ... (joint angles), or arc_length, yaw "
        f"(curvature), got {shown(table.head)}"
    )


def _law_of_curvature(table: Table, length: float, scale: float, name: str, time: str, smooth: bool) -> SampledLaw:
    frames, arc = frames_of(table, ("pitch", "yaw") if "pitch" in table else ("yaw",), "rad/m", scale, time)
    assert arc is not None  # `kind_of` has found the column arc_length
    if abs(arc[0]) > 0.05 * length or abs(arc[-1] - length) > 0.05 * length:
        rule = f"arc_length must reach from 0 to the body's length, {length:g} m"
        raise table.error(f"{rule}, got {arc[0]:.4g} to {arc[-1]:.4g} m", 0, len(arc) - 1)
    frames = frames._replace(fields=frames.fields / scale)
    fitted = SmoothedFrames(frames, arc, smooth, "rad/m")

    def curvature(x: np.ndarray) -> np.ndarray:
        found = fitted.at(x).swapaxes(1, 2)
        return found if found.shape[1] == 2 else np.concatenate((np.zeros_like(found), found), axis=1)

    raw = partial(_law_of_curvature, table, length, scale, name, time, smooth=False) if smooth else None
    kind = f"curvature at {len(arc)} points"
    return law_of_frames(frames, curvature, length, name=name, kind=kind, along=fitted.about, raw=raw)


def joint_columns(names: Iterable[str]) -> dict[str, list[str]]:
    """The columns of joints among `names`: for each axis, in their order."""
    found: dict[str, dict[int, str]] = {}
    for name in names:
        if match := COLUMN.fullmatch(split_name(name)[0]):
            found.setdefault(match[1], {})[int(match[2])] = match[0]
    return {axis: [places[place] for place in sorted(places)] for axis, places in found.items()}


def _law_of_joints(table: Table, length: float, name: str, column: str, smooth: bool) -> SampledLaw:
    """The law of the joint angles in the columns yaw_1, yaw_2, ... and pitch_1, ... of `table`, over time.

    length: [m], of the body. smooth: smooth the angles in time by generalised cross-validation. `ValueError` names
    the columns and rows at fault.
    """
    from scipy.interpolate import make_interp_spline

    axes = joint_columns(table.head)
    for axis, names in axes.items():
        numbers = [int(each.rpartition("_")[2]) for each in names]
        if numbers != list(range(1, len(names) + 1)) or len(names) < FEWEST_JOINTS:
            raise table.error(
                f"joints of {axis} must be {axis}_1 to {axis}_{max(FEWEST_JOINTS, len(names))} without gaps, "
                f"got {shown(names)}"
            )
    table.check_units([place for names in axes.values() for each in names for place in table.places(each)])
    time = time_of(table, column)
    check_rising(table, time, np.arange(len(time)))
    check_steps(table, time)
    angles = {
        axis: np.stack([table.column(each, "rad", LARGEST_ANGLE) for each in names]) for axis, names in axes.items()
    }
    splines = {}
    for axis, each in angles.items():
        sums = np.concatenate((np.zeros((1, len(time))), np.cumsum(each, axis=0)))  # at the ends of the segments
        ends = np.linspace(0.0, length, len(sums))
        splines[axis] = make_interp_spline(ends, sums, k=5 if len(each) >= 5 else 3)
    frames = Frames(table, time - time[0], time[:, None, None])

    def curvature(x: np.ndarray) -> np.ndarray:
        flat = np.zeros((len(time), len(x)))
        return np.stack([splines[axis](x, 1).T if axis in splines else flat for axis in ("pitch", "yaw")], axis=1)

    raw = partial(_law_of_joints, table, length, name, column, smooth=False) if smooth else None
    return law_of_frames(
        frames, curvature, length, name=name, kind=f"angles of {sum(map(len, axes.values()))} joints", raw=raw
    )


def _rows(path: Path, length: float, name: str) -> SampledLaw | None:
    """The law whose rows an .npz file holds; None if it holds something else."""
    arrays = read_archive(path)
    if not set(arrays) >= LAW:
        return None
    law = SampledLaw(*(arrays[each] for each in ("time", "x", "values")), name=name, about=f"rows of {path.name}")
    if abs(law.length - length) > FITTING * length:
        raise ValueError(f"x must reach to the body's length, {length:g} m, got {law.length:g} m")
    return law
