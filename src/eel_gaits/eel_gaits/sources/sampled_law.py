# SPDX-License-Identifier: Apache-2.0
"""A curvature law as rows: the curvature at instants and at points along the body.

Along the body each row is a natural cubic spline. Between two instants the curvature is the quintic that meets value,
rate and acceleration at both, as between the samples of a controller. So it is C2 in time and in X.
"""

from bisect import bisect_right
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from eel_common.quantity import number, numbers
from eel_common.wording import shown

from eel_gaits.laws.law import checked_name
from eel_gaits.laws.spline import natural_spline
from eel_gaits.laws.term import LAW_ROW, Term
from eel_gaits.sources.period import first_harmonics

FEWEST_ROWS = 2
LEAST_POINTS = 2
POINTS = 17, 25, 33, 49, 65, 97, 129, 193, 257, 385, 513, 769, 1025  # along the body: the least that suffices
IN_MESSAGES = 1.0 / 300.0  # part of the greatest curvature: error of the points in messages against the rows


class SampledLaw:
    """A curvature law as rows. It never changes. Two are equal if name, transition and rows are.

    `ValueError` names a bad attribute. raw(): makes the law without smoothing.

    Attributes:
        time: (N,) s, the law's own time: rising from 0.
        x: (n,) m, points along the body, from 0 at the nose to the tail.
        values: (N, 2, 3, n): for pitch and yaw, curvature [rad/m], rate [rad/m/s] and acceleration [rad/m/s^2].
        name: as in `Law`.
        transition: as in `Law`.
        about: the origin of the rows, in one line; may be empty.
    """

    def __init__(
        self,
        time: Any,
        x: Any,
        values: Any,
        *,
        name: str = "sampled",
        transition: float = 0.0,
        about: str = "",
        raw: Callable[..., Any] | None = None,
    ) -> None:
        self.time, self.x, self.values = (numbers(*each) for each in (("time", time), ("x", x), ("values", values)))
        self.name, self.transition = checked_name(name), number("transition", transition, "s", minimum=0.0)
        self.about, self._raw = about, raw
        for field, least in (("time", FEWEST_ROWS), ("x", LEAST_POINTS)):
            row = getattr(self, field)
            if row.ndim != 1 or len(row) < least or not np.all(np.diff(row) > 0.0) or row[0] != 0.0:
                raise ValueError(f"{field} must rise from 0 over {least} numbers or more, got {shown(row.tolist())}")
        shape = len(self.time), 2, 3, len(self.x)
        if self.values.shape != shape:
            raise ValueError(f"values must have the shape {shape}, got {self.values.shape}")
        if not np.all(np.isfinite(self.values)):
            row, axis, _, point = np.argwhere(~np.isfinite(self.values))[0]
            where = f"{list(LAW_ROW)[axis]} at t = {self.time[row]:g} s, X = {self.x[point]:g} m"
            raise ValueError(f"values must be finite, got none of {where}")
        for array in (self.time, self.x, self.values):
            array.flags.writeable = False

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SampledLaw) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def __repr__(self) -> str:
        return f"SampledLaw({shown(self.name)}, {len(self.time)} rows of {len(self.x)} points, {self.duration:g} s)"

    def __deepcopy__(self, memo: dict[str, Any]) -> "SampledLaw":
        return self

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        arrays = (each.tobytes() for each in (self.time, self.x, self.values))
        return (self.name, self.transition, *arrays)

    @property
    def smooth(self) -> bool:
        """Whether measured data were smoothed."""
        return self._raw is not None

    @cached_property
    def unsmoothed(self) -> "SampledLaw | None":
        """The same motion without smoothing, made on first access; None if nothing was smoothed."""
        return None if self._raw is None else self._raw()

    @property
    def duration(self) -> float:
        """Time [s] of the last row, where the known motion ends."""
        return float(self.time[-1])

    @property
    def length(self) -> float:
        """Length [m] of the rows' body."""
        return float(self.x[-1])

    @cached_property
    def in_plane(self) -> bool:
        """Whether the body bends only in yaw."""
        return not np.any(self.values[:, LAW_ROW["pitch"]])

    @cached_property
    def waves(self) -> tuple[Term, ...]:
        """The first harmonic in yaw and in pitch of the later half of the rows; none if these do not repeat."""
        return first_harmonics(self.time, self.x, {axis: self.values[:, place, 0] for axis, place in LAW_ROW.items()})

    def with_fewer_points(self) -> "SampledLaw":
        """The law at the fewest points that represent its rows to 1/300 of the greatest curvature: for messages."""
        rows = self.values[:, :, 0]
        x = points_for(lambda x: rows @ natural_spline(self.x, np.eye(len(self.x)), x), self.length, IN_MESSAGES)
        if len(x) >= len(self.x):
            return self
        values = natural_spline(self.x, self.values, x)
        return SampledLaw(self.time, x, values, name=self.name, transition=self.transition, about=self.about)

    def coarser(self) -> "SampledLaw":
        """The law from every second row and point. Its difference from this law shows the error of sampling."""
        rows, points = (np.unique(np.r_[0:size:2, size - 1]) for size in (len(self.time), len(self.x)))
        values = self.values[rows][..., points]
        return SampledLaw(self.time[rows], self.x[points], values, name=self.name, transition=self.transition)

    def curvature(self, time: float, x: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Curvature, its rate and its acceleration at `time` [s] and `x` (M,) [m]: three arrays (M, 3), as from
        `Law.curvature`. At rest after the last row."""
        x, time = np.atleast_1d(numbers("x", x)), number("time", time)
        inside = min(max(time, 0.0), self.duration)
        row = min(bisect_right(self.time, inside) - 1, len(self.time) - 2)
        step = self.time[row + 1] - self.time[row]
        start, end = self.values[row], self.values[row + 1]
        found = np.zeros((3, len(x), 3))
        for axis in LAW_ROW.values():
            rows = quintic(start[axis], end[axis], step, (inside - self.time[row]) / step)
            found[:, :, 1 + axis] = natural_spline(self.x, rows, x)
        if inside != time:
            found[1:] = 0.0
        return found[0], found[1], found[2]


def quintic(start: np.ndarray, end: np.ndarray, step: float | np.ndarray, s: float | np.ndarray) -> np.ndarray:
    """Value, rate and acceleration (3, ...) at the fraction `s` of an interval of `step` [s], from those at its ends.

    start, end (3, ...): value, rate and acceleration there. step, s: one number, or (N, 1 ...) for (3, N, ...).
    """
    powers = np.power.outer(np.asarray(step), np.arange(3.0))
    scale = np.moveaxis(powers, -1, 0).reshape(3, *(np.shape(step) or (1,) * (np.ndim(start) - 1)))
    a, b = start * scale, end * scale
    change = b[0] - a[0] - a[1] - 0.5 * a[2]
    slope, bend = b[1] - a[1] - a[2], b[2] - a[2]
    c3 = 10.0 * change - 4.0 * slope + 0.5 * bend
    c4 = -15.0 * change + 7.0 * slope - bend
    c5 = 6.0 * change - 3.0 * slope + 0.5 * bend
    value = a[0] + s * (a[1] + s * (0.5 * a[2] + s * (c3 + s * (c4 + s * c5))))
    rate = a[1] + s * (a[2] + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))
    acceleration = a[2] + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))
    return np.asarray(np.stack((value, rate, acceleration)) / scale)


def crowded(count: int, length: float) -> np.ndarray:
    """X (count,) [m] from nose to tail, closer together at the ends: there a natural spline's second derivative is 0,
    but the curvature's is not."""
    return 0.5 * length * (1.0 - np.cos(np.linspace(0.0, np.pi, count)))


def points_for(
    value_at: Callable[[np.ndarray], np.ndarray], length: float, tolerance: float, others: np.ndarray | tuple[()] = ()
) -> np.ndarray:
    """X (n,) [m] such that natural splines through them represent value_at(X) (..., n) [rad/m] to a part `tolerance`.

    It is checked at even distances, and at `others` [m]. `ValueError` if no number of points suffices.
    """
    check = np.union1d(np.linspace(0.0, length, 4 * POINTS[-1] // 3), others)
    wanted = value_at(check)
    scale = np.max(np.abs(wanted))
    for count in POINTS:
        x = crowded(count, length)
        apart = value_at(x) @ natural_spline(x, np.eye(count), check)  # for many rows a product is far faster
        apart -= wanted
        np.abs(apart, out=apart)
        if not np.max(apart) > tolerance * scale:
            return x
    place = check[np.unravel_index(np.argmax(apart), apart.shape)[-1]]
    raise ValueError(
        f"the curvature must be smooth along the body: {POINTS[-1]} points miss it by {np.max(apart) / scale:.2g} of "
        f"its greatest value at X = {place:g} m"
    )
