"""Samples of two runs at the same times: for each of this run's the other's, linear between its two neighbours in time.

Where the stamps are equal nothing is interpolated. Whichever run is ahead waits for the other, `KEPT` samples at most.
"""

from collections import deque

import numpy as np

from eel_viz.stations import same

KEPT = 1024  # samples of either run that wait; the oldest are given up


class Pairs:
    """Of one kind of sample: an array at a stamp [ns], (n,) or, with abscissae `x`, (M, n)."""

    def __init__(self) -> None:
        self._these: deque[tuple] = deque(maxlen=KEPT)
        self._others: deque[tuple] = deque(maxlen=KEPT)

    def this(self, stamp: int, values: np.ndarray, x: np.ndarray | None = None) -> list[tuple]:
        """This run's sample; returns the pairs that are complete: (stamp, x, this run's values, the other's)."""
        self._these.append((stamp, x, values))
        return self._complete()

    def other(self, stamp: int, values: np.ndarray, x: np.ndarray | None = None) -> list[tuple]:
        """The other run's sample; returns as `this`."""
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
    """`values` at the abscissae `x` instead of their `own`."""
    if x is None or same(x, own):
        return values
    return np.stack([np.interp(x, own, column) for column in values.T], axis=1)
