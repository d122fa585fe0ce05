# SPDX-License-Identifier: Apache-2.0
"""When a sensor reads: at the first sample of the run at or after each multiple of its period; and its latency."""

import heapq
import math
from collections.abc import Iterator
from itertools import count
from typing import Any

import numpy as np

ROUNDING = 1e-6  # part of a period by which a sample may lie before a multiple


def readings_among(times: np.ndarray, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """The samples at which a sensor with this `rate` [Hz] reads: indices (N,) of `times` (T,) [s], and the time (N,)
    [s] since the previous reading, 0 for the first."""
    count = np.floor(times * rate + ROUNDING)
    rows = np.flatnonzero(np.diff(count, prepend=-1.0) > 0.0)
    return rows, np.diff(times[rows], prepend=times[rows][:1])


class Timing:
    """The same as `readings_among`, sample by sample."""

    def __init__(self, rate: float):
        self._rate, self._count, self._last = rate, -1, math.nan  # count: periods up to the last sample

    def gap(self, time: float) -> float | None:
        """Time [s] from the previous reading to one at the next sample, at `time` [s]; None if none is due there."""
        before, self._count = self._count, math.floor(time * self._rate + ROUNDING)
        if self._count <= before:
            return None
        last, self._last = self._last, time
        return 0.0 if before < 0 else time - last


class Delay:
    """Holds what is not due yet, such as readings until their latency is over."""

    def __init__(self) -> None:
        self._heap: list[tuple[int, int, Any]] = []  # when due [ns], count, what
        self._count = count()

    def put(self, due: int, what: Any) -> None:
        """Hold `what` until the time `due` [ns]."""
        heapq.heappush(self._heap, (due, next(self._count), what))

    def take(self, now: int) -> Iterator[Any]:
        """What is due at the time `now` [ns]: the earliest first, and as it was put where the times are equal."""
        while self._heap and self._heap[0][0] <= now:
            yield heapq.heappop(self._heap)[2]


def check_rate(name: str, rate: float, samples: float) -> None:
    """`ValueError` for a sensor's `rate` [Hz] above that of the `samples` of its run [Hz]."""
    if rate > samples * (1.0 + ROUNDING):
        raise ValueError(f"{name} must be at most the {samples:g} Hz of the run, got {rate:g} Hz")
