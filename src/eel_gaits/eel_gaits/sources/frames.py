# SPDX-License-Identifier: Apache-2.0
"""Measured frames: fields at n points along the body at N instants, read from a table, and the law made of them.

Each frame is smoothed along the body, then its curvature in time. In this order the noise in each step is uncorrelated
along the smoothed direction, as cross-validation assumes. In the other order, the noise that the first step left would
count as motion, and would spoil the accelerations.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from eel_common.files.table import Table
from eel_common.files.times import time_of
from eel_common.wording import shown

from eel_gaits.sources.period import long_gap
from eel_gaits.sources.sampled_law import SampledLaw, points_for
from eel_gaits.sources.smoothing import FEWEST, interpolated, smoothed, smoothed_in_time

FEWEST_FRAMES = 16
STEPS = 9e-5, 0.4  # s: range of steps in films and logs; otherwise time is not in s
TOLERANCE = 5e-5  # part of the greatest curvature: error of the rows against the splines along the body
MATERIAL = 0.02  # part of the length: variation of a point's arc length between frames


class Frames(NamedTuple):
    """Fields at n points and N instants. Frame i has the rows i n to (i + 1) n of the `table`."""

    table: Table
    time: np.ndarray  # (N,) s, from 0
    fields: np.ndarray  # (N, n, fields)

    def error(self, text: str, first: int, last: int | None = None) -> ValueError:
        """An error about the frames `first` to `last`."""
        last, count = first if last is None else last, self.fields.shape[1]
        return self.table.error(text, first * count, (last + 1) * count - 1)


def frames_of(
    table: Table, names: tuple[str, ...], unit: str, scale: float = 1.0, time: str = ""
) -> tuple[Frames, np.ndarray | None]:
    """The frames of a table, from its times, the columns `names` and, if present, `arc_length`; and the arc lengths
    (n,) of the points.

    Rows of one time are a frame, from nose to tail. unit: SI unit of the columns. scale: metres per unit of length in
    the file, instead of the units in names. time: the column of times. `ValueError` names the rows at fault.
    """
    si, length = (unit, "m") if scale == 1.0 else ("", "")
    if length:
        table.check_units([place for name in names for place in table.places(name)])
    fields = np.stack([table.column(name, si) for name in names], axis=-1)
    arc = scale * table.column("arc_length", length) if "arc_length" in table else None
    seconds = time_of(table, time)
    starts = frame_starts(table, seconds)
    instants, count = seconds[starts], len(table) // len(starts)
    check_steps(table, instants)
    if count < FEWEST:
        raise table.error(f"a frame must have {FEWEST} points or more, got {count}", 0, count - 1)
    found = Frames(table, instants - instants[0], fields.reshape(len(starts), count, -1))
    return found, None if arc is None else _material(found, arc.reshape(len(starts), -1))


def frame_starts(table: Table, time: np.ndarray) -> np.ndarray:
    """The first row of each frame, which has the rows of one `time` (rows,) [s]. `ValueError` if frames differ in
    size, or time falls."""
    starts = np.concatenate(([0], np.flatnonzero(np.diff(time)) + 1))
    check_rising(table, time, starts)
    sizes = np.diff(np.append(starts, len(time)))
    if len(other := np.flatnonzero(sizes != sizes[0])):
        first, size = starts[other[0]], sizes[other[0]]
        raise table.error(f"a frame of {size} points, the first frame has {sizes[0]}", first, first + size - 1)
    return starts


def check_rising(table: Table, time: np.ndarray, rows: np.ndarray) -> None:
    """`ValueError` if the `time` (rows,) [s] of these `rows` does not rise."""
    if len(back := np.flatnonzero(np.diff(time[rows]) <= 0.0)):
        before, after = rows[back[0]], rows[back[0] + 1]
        got = f"got {time[after]:g} s after {time[before]:g} s"
        raise table.error(f"time must rise, {got}: two swimmers in one file?", after)


def check_steps(table: Table, instants: np.ndarray, fewest: int = FEWEST_FRAMES) -> None:
    """`ValueError` if the `instants` (N,) [s] are too few for a motion, or too far apart or close for a swimmer."""
    if len(instants) < fewest:
        raise table.error(f"there must be {fewest} instants or more, got {len(instants)}")
    if not STEPS[0] <= (step := float(np.median(np.diff(instants)))) <= STEPS[1]:
        raise table.error(f"its instants are {step:.3g} s apart: is its time in s? Name the unit, such as time_ms")


def _material(frames: Frames, arc: np.ndarray) -> np.ndarray:
    """Arc lengths (n,) of the points, which must rise along the body and stay the same in all frames."""
    falls = np.argwhere(np.diff(arc, axis=1) <= 0.0)
    if len(falls):
        frame, point = falls[0]
        row = frame * arc.shape[1] + point + 1
        raise frames.table.error(f"arc_length must rise along a frame, got {arc[frame, point + 1]:g}", row)
    mean: np.ndarray = arc.mean(axis=0)
    apart = np.abs(arc - mean)
    frame, point = np.unravel_index(np.argmax(apart), apart.shape)
    if apart[frame, point] > MATERIAL * (mean[-1] - mean[0]):
        row = frame * arc.shape[1] + point
        raise frames.table.error(
            f"arc_length of point {point + 1} must stay the same, got {arc[frame, point]:g}, on average "
            f"{mean[point]:g}: resample the midlines at fixed arc lengths",
            row,
        )
    return mean


class SmoothedFrames:
    """Splines along the body through each of the `frames`, whose points have the arc lengths `arc` (n,).

    about: the effect of smoothing, in words. unit: of the fields, in `about`. factor: those units per unit of the
    frames.
    """

    def __init__(self, frames: Frames, arc: np.ndarray, smooth: bool, unit: str, factor: float = 1.0) -> None:
        count, points, _ = frames.fields.shape
        found = (smoothed if smooth else interpolated)(arc, frames.fields.swapaxes(0, 1).reshape(points, -1))
        self._spline, self._count = found.spline, count
        residual = factor * float(np.sqrt(np.mean((self.at(arc) - frames.fields) ** 2)))
        self.about = f"{residual:.3g} {unit} along the body ({found.degrees:.1f} of {points} degrees of freedom left)"

    def at(self, arc: np.ndarray, order: int = 0) -> np.ndarray:
        """Fields (N, m, fields) at the arc lengths `arc` (m,), or their derivatives of this `order` along the body."""
        return np.asarray(self._spline(arc, order)).reshape(len(arc), self._count, -1).swapaxes(0, 1)


def law_of_frames(
    frames: Frames,
    curvature: Callable[[np.ndarray], np.ndarray],
    length: float,
    *,
    name: str,
    kind: str,
    along: str = "",
    raw: Callable[..., Any] | None = None,
) -> SampledLaw:
    """The law from curvature(X) (N, 2, m) [rad/m], pitch and yaw, at the instants of the `frames`.

    length: [m], of the body. kind: of the data, in words. along: effect of smoothing along the body. raw(): makes the
    law without smoothing; without it, nothing is smoothed in time. `ValueError` for a gap in time.
    """
    x = points_for(curvature, length, TOLERANCE)
    rows, time = curvature(x), frames.time
    values, degrees = np.zeros((*rows.shape[:2], 3, len(x))), []
    for axis in np.flatnonzero(np.any(rows, axis=(0, 2))):
        found = (interpolated if raw is None else smoothed_in_time)(time, rows[:, axis])
        values[:, axis] = np.stack([found.spline(time, order) for order in range(3)], axis=1)
        degrees.append(found.degrees)
    smoothing = "not smoothed"
    if raw is not None:
        if gap := long_gap(time, values[:, :, 0].reshape(len(rows), -1)):
            raise frames.error(gap[1], gap[0], gap[0] + 1)
        residual = np.sqrt(np.mean((values[:, :, 0] - rows) ** 2))
        left = f"{np.mean(degrees):.0f} of {len(time)}" if degrees else "none"
        smoothing = (
            "smoothed by quintic splines with generalised cross-validation; residual (RMS) "
            f"{along}{', ' if along else ''}{residual:.3g} rad/m in time ({left} degrees of freedom left)"
        )
    read = f"; read with {', '.join(frames.table.notes)}" if frames.table.notes else ""
    about = f"{kind} of {shown(frames.table.path.name)}, {len(time)} instants, {smoothing}{read}"
    return SampledLaw(time, x, values, name=name, about=about, raw=raw)
