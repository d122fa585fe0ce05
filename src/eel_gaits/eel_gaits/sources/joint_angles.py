# SPDX-License-Identifier: Apache-2.0
"""Joint angles as a law. Joint j of n stands for the segment (j - 1) l/n to j l/n, as in `Run.actuators`.

Its angle is the integral of the curvature over its segment. So the angles of the joints up to a place add up to the
integral of the curvature up to there. The curvature is the derivative of the spline through these sums.
"""

import re
from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np
from eel_base.wording import shown

from eel_gaits.sources.frames import Frames, check_rising, law_of_frames
from eel_gaits.sources.sampled_law import SampledLaw
from eel_gaits.sources.tables import Table

COLUMN = re.compile(r"(pitch|yaw)_([1-9][0-9]*)")
FEWEST_JOINTS = 3  # in an axis


def joint_columns(names: Iterable[str]) -> dict[str, list[str]]:
    """The columns of joints among `names`, of each axis in their order."""
    found: dict[str, dict[int, str]] = {}
    for name in names:
        if match := COLUMN.fullmatch(name):
            found.setdefault(match[1], {})[int(match[2])] = name
    return {axis: [places[place] for place in sorted(places)] for axis, places in found.items()}


def law_of_joints(table: Table, length: float, name: str, smooth: bool = True) -> SampledLaw:
    """The law of the joint angles [rad] in the columns yaw_1, yaw_2, ... and pitch_1, ... of `table`, over time [s].

    length [m]: of the body. The angles are smoothed in time by generalised cross-validation, if `smooth`. `ValueError`
    names columns and rows that do not fit.
    """
    axes = joint_columns(table.columns)
    for axis, names in axes.items():
        numbers = [int(each.rpartition("_")[2]) for each in names]
        if numbers != list(range(1, len(names) + 1)) or len(names) < FEWEST_JOINTS:
            raise table.error(
                f"joints of {axis} must be {axis}_1 to {axis}_{max(FEWEST_JOINTS, len(names))} without gaps, "
                f"got {shown(names)}"
            )
    columns = [name for names in axes.values() for name in names]
    table.check_finite(("time", *columns))
    time = table.columns["time"]
    check_rising(table, time, np.arange(len(time)))
    angles = {axis: np.stack([table.columns[each] for each in names]) for axis, names in axes.items()}
    splines = {axis: _sums(each, length) for axis, each in angles.items()}
    frames = Frames(table, time - time[0], None, time[:, None, None])

    def curvature(x: np.ndarray) -> np.ndarray:
        flat = np.zeros((len(time), len(x)))
        return np.stack([splines[axis](x, 1).T if axis in splines else flat for axis in ("pitch", "yaw")], axis=1)

    raw = partial(law_of_joints, table, length, name, smooth=False) if smooth else None
    return law_of_frames(frames, curvature, length, name=name, kind=f"angles of {len(columns)} joints", raw=raw)


def _sums(angles: np.ndarray, length: float) -> Any:
    """The spline along X through the sums of `angles` (n, N) from the nose on, at the ends of the segments."""
    from scipy.interpolate import make_interp_spline

    count = len(angles)
    sums = np.concatenate((np.zeros((1, angles.shape[1])), np.cumsum(angles, axis=0)))
    return make_interp_spline(np.linspace(0.0, length, count + 1), sums, k=5 if count >= 5 else 3)
