# SPDX-License-Identifier: Apache-2.0
"""A controller's samples and their queue. A sample is the curvature along the body at one instant."""

import math
from bisect import bisect_left, bisect_right
from functools import lru_cache
from itertools import repeat
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np
from eel_common.quantity import checked_row, is_finite
from eel_common.wording import shown
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.law_waves import MOST_WAVES, waves_of_rows

POINTS_PER_WAVE = 8
MOST_POINTS = int(POINTS_PER_WAVE * MOST_WAVES) + 1  # of one sample of a controller
MOST_AHEAD, MOST_POINTS_AHEAD = 10_000, 1_000_000  # samples and points ahead of the simulation: 50 MB
SAMPLES_OF_A_GRID = 100  # samples ahead for which a grid is chosen, so that it does not change with each one
MOST_TURNS = MOST_WAVES, 1e3 * MOST_WAVES, 1e6 * MOST_WAVES  # turns, per s, s^2: a start within 1 ms
GENTLE = 1e5  # bound of the sum of squares [1/m, per s and s^2] over the length: no value exceeds it
QUANTITIES = "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel"
TIME_OF = attrgetter("time")


def check_points(count: int) -> None:
    """`ValueError` for a sample with more points along the body than any grid can resolve."""
    if count > MOST_POINTS:
        raise ValueError(f"curvature samples x must have at most {MOST_POINTS} points, got {count}")


class LateSample(ValueError):
    """A sample whose motion has already begun when it comes."""


class CurvatureSample(NamedTuple):
    """The curvature at `time` [s] at the points x (n,) [m].

    values (2, 3, n): pitch and yaw, each with value [rad/m], rate [rad/m/s] and acceleration [rad/m/s^2].
    waves: the number of waves on the body that a grid must resolve.
    """

    time: float
    x: np.ndarray
    values: np.ndarray
    waves: float

    @staticmethod
    def checked(
        time: Any, x: Any, rows: Any, *, waves: float | None, length: float, planar: bool, now: float, begun: bool
    ) -> "CurvatureSample":
        """A sample from its arguments. `ValueError` names a bad one; `LateSample` for its time.

        time [s]; x (n,) [m]; rows (6, n): as in `QUANTITIES`. waves: on the body; None: as many as the points resolve.
        length [m]: of the body. planar: of the scene. now [s]: the present time. begun: whether the march has begun;
        before that, a sample may be at the present time.
        """
        if not (type(x) is np.ndarray and x.dtype == float and x.ndim == 1):
            x = checked_row("curvature samples x", x, None)
        x = _checked_x(x.tobytes(), length)
        values = _checked_values(rows, len(x), length)
        if planar and values[0].any():
            raise ValueError("curvature samples pitch must be 0 in a planar scene")
        if not is_finite(time):
            raise ValueError(f"curvature samples time must be finite, got {shown(time)} s")
        if time < now or (time == now and begun):
            raise LateSample(f"curvature samples time must lie ahead of the simulation ({now:.9g} s), got {time:.9g} s")
        if waves is None:  # a power of 2, for few different grids
            waves = 2.0 ** math.ceil(math.log2(max(1.0, (len(x) - 1) / POINTS_PER_WAVE)))
        elif not (is_finite(waves) and 0.0 < waves <= MOST_WAVES):
            raise ValueError(f"curvature samples waves must be > 0 and at most {MOST_WAVES:g}, got {shown(waves)}")
        return CurvatureSample(float(time), x, values, float(waves))


@lru_cache(maxsize=64)
def _checked_x(content: bytes, length: float) -> np.ndarray:
    """The points (n,) [m] of a sample, from their bytes. Equal points share one constant array."""
    x = checked_row("curvature samples x", np.frombuffer(content), None)
    if len(x) < 2:
        raise ValueError(f"curvature samples x must have 2 points or more, got {len(x)}")
    falls = np.flatnonzero(np.diff(x) <= 0.0)
    if len(falls):
        index = falls[0] + 1
        raise ValueError(f"curvature samples x must rise, got {x[index]:g} after {x[index - 1]:g} at index {index}")
    if x[0] < -1e-9 * length or x[-1] > length * (1.0 + 1e-9):
        raise ValueError(f"curvature samples x must lie within 0 to {length} m, got {x[0]} to {x[-1]}")
    return x


def _checked_values(rows: Any, points: int, length: float) -> np.ndarray:
    """The six rows of a sample as an array (2, 3, points) of floats, bounded for a body of this `length` [m].

    Rows of floats are checked together.
    """
    if all(type(row) is np.ndarray and row.dtype == float and row.shape == (points,) for row in rows):
        values = np.concatenate(rows)
        with np.errstate(over="ignore"):
            if values.dot(values) * length**2 < GENTLE:
                return values.reshape(2, 3, points)
    named = zip(QUANTITIES, rows, strict=True)
    values = np.array([checked_row(f"curvature samples {name}", row, points) for name, row in named])
    for name, row, turns in zip(QUANTITIES, values, (*MOST_TURNS, *MOST_TURNS), strict=True):
        if (most := float(np.abs(row).max())) > 2.0 * math.pi * turns / length:
            limit = 2.0 * math.pi * turns / length
            raise ValueError(f"curvature samples {name} must be at most {limit:.3g} in size, got {most:.3g}")
    return values.reshape(2, 3, points)


class SampleQueue:
    """Samples ordered by time. While they drive the shape, the first two bracket the present.

    samples: the first ones, ordered. law_name: of a law whose rows they are; no other sample can join them.
    """

    def __init__(self, samples: list[CurvatureSample] | None = None, law_name: str | None = None):
        self._samples = [] if samples is None else samples
        self._points = sum(len(sample.x) for sample in self._samples)
        self._law_name = law_name

    @staticmethod
    def of_law(law: SampledLaw, origin: float) -> "SampleQueue":
        """The rows of a `law` whose own t = 0 is at `origin` [s]."""
        rows = zip((origin + law.time).tolist(), repeat(law.x), law.values, repeat(waves_of_rows(law)), strict=False)
        return SampleQueue([CurvatureSample(*row) for row in rows], law.name)

    def __copy__(self) -> "SampleQueue":
        return SampleQueue(self._samples.copy(), self._law_name)

    def __len__(self) -> int:
        return len(self._samples)

    def check_space(self, points: int) -> None:
        """`ValueError` if the queue has no space for a sample with this number of `points`."""
        if len(self._samples) >= MOST_AHEAD or self._points + points > MOST_POINTS_AHEAD:
            raise ValueError(
                f"curvature samples ahead of the simulation must be at most {MOST_AHEAD}, of {MOST_POINTS_AHEAD} "
                f"points, got {len(self._samples) + 1} of {self._points + points}"
            )

    def add(self, sample: CurvatureSample, driving: bool) -> None:
        """Add a sample. Adding the same one again changes nothing.

        `LateSample` for one that comes too late while the samples are `driving`, `ValueError` for a different one of
        the same time.
        """
        if self._law_name is not None:
            raise ValueError(f"curvature samples cannot join the rows of law {shown(self._law_name)}")
        time, place = sample.time, bisect_left(self._samples, sample.time, key=TIME_OF)
        known = next((each for each in self._samples[place : place + 1] if each.time == time), None)
        if known and np.array_equal(known.x, sample.x) and np.array_equal(known.values, sample.values):
            return
        if driving and place < 2:
            ahead = f"the instant being approached ({self._samples[1].time:.6f} s)"
            raise LateSample(f"curvature samples time must come after {ahead}, got {time:.6f} s")
        if known:
            raise ValueError(f"curvature samples time must be new, got {time:.6f} s twice")
        self._samples.insert(place, sample)
        self._points += len(sample.x)

    def drop_first(self) -> None:
        """Remove the first sample."""
        self._points -= len(self._samples.pop(0).x)

    def drop_until(self, now: float) -> None:
        """Remove all samples before the last one that is at or before `now` [s]."""
        while len(self._samples) > 1 and self._samples[1].time <= now:
            self.drop_first()

    def begun(self, now: float) -> bool:
        """Whether two samples bracket `now` [s]. Call `drop_until` first."""
        return len(self._samples) > 1 and self._samples[0].time <= now

    @property
    def first_two(self) -> list[CurvatureSample]:
        """The samples that bracket the present."""
        return self._samples[:2]

    @property
    def waves(self) -> float:
        """The greatest number of waves on the body in the samples for which a grid is chosen."""
        return max(sample.waves for sample in self._samples[:SAMPLES_OF_A_GRID])

    @property
    def end(self) -> float | None:
        """Time [s] of the last sample; None without one."""
        return self._samples[-1].time if self._samples else None

    def next_bracket(self, now: float) -> float:
        """Time [s] after `now` from which two samples bracket the present; inf without such a time."""
        later = bisect_right(self._samples, now, key=TIME_OF)
        return self._samples[later].time if later + 1 < len(self._samples) else np.inf
