# SPDX-License-Identifier: Apache-2.0
"""Means over the last period of the gait, whose length changes with its tempo.

The head swings with each beat. Over a whole period of the gait's own time these swings cancel, so a mean over it shows
where the swimmer heads, and the change across it how fast it turns and moves.
"""

from collections import deque
from typing import Any, NamedTuple

import numpy as np


class Means(NamedTuple):
    """Of signals over the last period."""

    mean: np.ndarray  # (n,) of each signal
    rate: np.ndarray  # (n,) per s: change over the period, by its length
    span: float  # s, length of that period
    whole: bool  # whether a whole period has passed


class PeriodMeans:
    """Collects `count` signals and gives their means over the last `period` [s] of the gait's own time."""

    def __init__(self, count: int, period: float) -> None:
        self._period = period
        self._rows: deque[Any] = deque()  # time, own time, signals and their integrals since the start
        self._empty = np.zeros(count)

    def clear(self) -> None:
        """Forget all signals."""
        self._rows.clear()

    def add(self, time: float, own_time: float, signals: Any) -> Means:
        """Add the `signals` (n,) at `time` [s], when the gait's own time is `own_time` [s]; the means since then."""
        signals = np.asarray(signals, dtype=float)
        if not self._rows:
            self._rows.append((time, own_time, signals, self._empty))
            return Means(signals, self._empty, 0.0, False)
        before, _, last, integral = self._rows[-1]
        integral = integral + 0.5 * (time - before) * (last + signals)
        self._rows.append((time, own_time, signals, integral))
        begin = own_time - self._period
        while len(self._rows) > 2 and self._rows[1][1] <= begin:
            self._rows.popleft()
        first, start = self._rows[0], self._row_at(begin)
        span = time - start[0]
        return Means((integral - start[2]) / span, (signals - start[1]) / span, span, first[1] <= begin)

    def _row_at(self, own_time: float) -> tuple[Any, ...]:
        """Time, signals and integrals at `own_time` [s], which lies in the oldest interval or before it."""
        (t0, tau0, signals0, integral0), (t1, tau1, signals1, _) = self._rows[0], self._rows[1]
        share = (own_time - tau0) / (tau1 - tau0) if own_time > tau0 else 0.0
        time, signals = t0 + share * (t1 - t0), signals0 + share * (signals1 - signals0)
        return time, signals, integral0 + 0.5 * (time - t0) * (signals0 + signals)
