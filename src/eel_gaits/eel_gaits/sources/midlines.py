# SPDX-License-Identifier: Apache-2.0
"""Measured midlines as a law: positions of points along the body give the curvature along it.

The positions are smoothed along the body. Their derivatives along the body are the tangent t and the curvature vector
t'. Curvature does not contain the rigid motion, so that is lost: the head's motion is a result of the simulation. In
the plane K3 = t' . t2. In space t2 and t3 are transported along the body without rotation about the tangent (Bishop,
Am. Math. Mon. 82 (1975)), like the model's sections, and K2 = -t' . t3. A midline does not show the head's roll: its
axis 3 is taken as upright as the tangent allows.
"""

from functools import partial

import numpy as np
from eel_common.files.table import Table

from eel_gaits.sources.frames import Frames, SmoothedFrames, frames_of, law_of_frames
from eel_gaits.sources.order import check_order
from eel_gaits.sources.sampled_law import SampledLaw

FITTING = 0.05  # largest difference in length from the body, as a part; midlines are scaled to fit
UPRIGHT = 0.995  # greatest upward component of the head's tangent


class Midlines:
    """Midlines of a `table` with the columns time [s], x, y and perhaps z, for a body of `length` [m].

    A column `arc_length` gives the points' places. Without it they follow from their mean distances. scale: metres per
    unit of length in the file. time: the column of times, if its name is not recognised. x, y, z are right-handed, z is
    up. `ValueError` names the rows at fault, and points out of order along the body.
    """

    def __init__(self, table: Table, length: float, scale: float = 1.0, time: str = "") -> None:
        names = ("x", "y", "z") if "z" in table else ("x", "y")
        frames, arc = frames_of(table, names, "m", scale, time)
        self.frames, self.length = frames._replace(fields=scale * frames.fields), float(length)
        places = range(frames.fields.shape[1])
        check_order(frames.fields, [str(place + 1) for place in places], places)
        self.arc = _mean_arc(self.frames) if arc is None else arc - arc[0]

    @property
    def time(self) -> np.ndarray:
        """(N,) s, of the frames, from 0."""
        return self.frames.time

    @property
    def position(self) -> np.ndarray:
        """(N, n, 2 or 3) m, as measured."""
        return self.frames.fields

    def law(self, name: str, smooth: bool = True) -> SampledLaw:
        """The law of the midlines, smoothed by generalised cross-validation; without `smooth` through all points."""
        fitted = SmoothedFrames(self.frames, self.arc, smooth, "mm", 1e3)
        part = self._fitting(fitted) / self.length
        if self.position.shape[2] == 3:
            tangent = fitted.at(self.arc[:1], 1)[:, 0]
            upward = np.abs(tangent[:, 2]) / np.linalg.norm(tangent, axis=1)
            if np.max(upward) > UPRIGHT:
                text = "the head must not point straight up or down: its roll is not known then"
                raise self.frames.error(text, int(np.argmax(upward)))

        def curvature(x: np.ndarray) -> np.ndarray:
            place = x / self.length * self.arc[-1]
            return part * curvature_of(fitted.at(place, 1), fitted.at(place, 2))

        raw = partial(self.law, name, smooth=False) if smooth else None
        kind = f"midlines of {len(self.arc)} points"
        return law_of_frames(self.frames, curvature, self.length, name=name, kind=kind, along=fitted.about, raw=raw)

    def _fitting(self, fitted: SmoothedFrames) -> float:
        """The midlines' length [m], from nose to tail. `ValueError` if it differs too much from the body's."""
        fine = np.linspace(0.0, self.arc[-1], 8 * len(self.arc))
        speed = np.linalg.norm(fitted.at(fine, 1), axis=-1)
        lengths = np.sum(0.5 * (speed[:, 1:] + speed[:, :-1]) * np.diff(fine), axis=1)
        mean, worst = float(np.mean(lengths)), int(np.argmax(np.abs(lengths - np.mean(lengths))))
        if abs(mean - self.length) > FITTING * self.length:
            rule = f"midlines must be as long as the body, {self.length:g} m, got {mean:.4g} m on average"
            hint = f"give a scale of {self.length / mean:.4g}, or another body"
            raise self.frames.error(f"{rule}: {hint}", 0, len(self.time) - 1)
        if abs(lengths[worst] - mean) > 2.0 * FITTING * mean:
            raise self.frames.error(f"a midline of {lengths[worst]:.4g} m, the others have {mean:.4g} m", worst)
        return mean


def curvature_of(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Pitch and yaw curvature (N, 2, m) [1/m] from the derivatives (N, m, 2 or 3) of positions along the body."""
    if first.shape[2] == 2:
        first, second = (np.concatenate((each, np.zeros_like(each[..., :1])), axis=2) for each in (first, second))
    stretch = np.linalg.norm(first, axis=2, keepdims=True)
    tangent = first / stretch
    bend = (second - tangent * np.sum(tangent * second, axis=2, keepdims=True)) / stretch**2
    side, up = _carried(tangent)
    return np.stack((-np.sum(bend * up, axis=2), np.sum(bend * side, axis=2)), axis=1)


def _carried(tangent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Section axes 2 and 3 (N, m, 3) along the `tangent` (N, m, 3), transported from the nose without twist.

    Between two points they turn by the smallest rotation from one tangent to the next.
    """
    up = np.zeros_like(tangent)
    first = np.array([0.0, 0.0, 1.0]) - tangent[:, 0] * tangent[:, 0, 2:]
    up[:, 0] = first / np.linalg.norm(first, axis=1, keepdims=True)
    for point in range(1, tangent.shape[1]):
        before, after, axis = tangent[:, point - 1], tangent[:, point], up[:, point - 1]
        both = before + after
        axis = axis - both * (np.sum(axis * after, axis=1) / (1.0 + np.sum(before * after, axis=1)))[:, None]
        up[:, point] = axis / np.linalg.norm(axis, axis=1, keepdims=True)
    return np.cross(up, tangent), up


def _mean_arc(frames: Frames) -> np.ndarray:
    """Arc lengths (n,) [m] of the points, from the distances between their positions smoothed in time."""
    even = np.arange(frames.fields.shape[1], dtype=float)
    rows = SmoothedFrames(frames, even, True, "m").at(even)
    steps = np.linalg.norm(np.diff(rows, axis=1), axis=2).mean(axis=0)
    if not np.all(steps > 0.0):
        raise frames.error(f"points {np.argmin(steps) + 1} and {np.argmin(steps) + 2} coincide", 0)
    return np.concatenate(([0.0], np.cumsum(steps)))
