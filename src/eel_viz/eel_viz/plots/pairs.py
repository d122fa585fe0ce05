# SPDX-License-Identifier: Apache-2.0
"""Pairs the samples of two runs: this run's sample with the other run's, interpolated linearly to the same stamp.

Samples with equal stamps are not interpolated. Samples of the run that is ahead wait for the other run.
"""

from collections import deque

import numpy as np

from eel_viz.stations import same

MAXIMUM_WAITING = 1024  # samples of either run; older ones are dropped


class Pairs:
    """Pairs of one kind of sample: an array (n,) at a stamp [ns], or (M, n) at stations `x` (M,) [m] and a stamp."""

    def __init__(self) -> None:
        self._these: deque[tuple] = deque(maxlen=MAXIMUM_WAITING)
        self._others: deque[tuple] = deque(maxlen=MAXIMUM_WAITING)

    def add_this(self, stamp: int, values: np.ndarray, x: np.ndarray | None = None) -> list[tuple]:
        """Add a sample of this run; returns the complete pairs: (stamp, x, this run's values, the other's)."""
        self._these.append((stamp, x, values))
        return self._complete()

    def add_other(self, stamp: int, values: np.ndarray, x: np.ndarray | None = None) -> list[tuple]:
        """Add a sample of the other run; returns as `add_this`."""
        self._others.append((stamp, x, values))
        return self._complete()

    def _complete(self) -> list[tuple]:
        found, others = [], self._others
        while self._these and others and others[-1][0] >= self._these[0][0]:
            stamp, x, values = self._these.popleft()
            while len(others) > 1 and others[1][0] <= stamp:
                others.popleft()
            if others[0][0] > stamp:
                continue  # before the other's first
            found.append((stamp, x, values, self._other_at(stamp, x)))
        return found

    def _other_at(self, stamp: int, x: np.ndarray | None) -> np.ndarray:
        before, _, values = self._others[0]
        values = _on(x, *self._others[0][1:])
        if before == stamp:
            return values
        share = (stamp - before) / (self._others[1][0] - before)
        return (1.0 - share) * values + share * _on(x, *self._others[1][1:])


def _on(x: np.ndarray | None, own: np.ndarray | None, values: np.ndarray) -> np.ndarray:
    """`values` interpolated from their `own` stations to `x`."""
    if x is None or own is None or same(x, own):
        return values
    return np.stack([np.interp(x, own, column) for column in values.T], axis=1)
