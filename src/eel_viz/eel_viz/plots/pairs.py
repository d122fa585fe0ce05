# SPDX-License-Identifier: Apache-2.0
"""Pairs of samples of two runs: this run's sample, and the other run's interpolated linearly to the same stamp.

Samples with equal stamps are not interpolated. Samples of the run that is ahead wait for the other run.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from eel_viz.messages import same

MAXIMUM_WAITING = 1024  # samples of either run; older ones are dropped


class Stamped(NamedTuple):
    """Values (n,) at a stamp [ns], or (M, n) at stations `x` (M,) [m] and a stamp."""

    stamp: int
    values: np.ndarray
    x: np.ndarray | None = None


class Pair(NamedTuple):
    """The values of this run and of the other one, at this run's stamp [ns] and stations [m]."""

    stamp: int
    x: np.ndarray | None
    this: np.ndarray
    other: np.ndarray


class Pairs:
    """Pairs of one kind of sample."""

    def __init__(self) -> None:
        self._these: deque[Stamped] = deque(maxlen=MAXIMUM_WAITING)
        self._others: deque[Stamped] = deque(maxlen=MAXIMUM_WAITING)

    def add(self, sample: Stamped, *, of_other: bool) -> list[Pair]:
        """Add a sample of this run or of the other one. Returns the newly complete pairs."""
        (self._others if of_other else self._these).append(sample)
        found, others = [], self._others
        while self._these and others and others[-1].stamp >= self._these[0].stamp:
            this = self._these.popleft()
            while len(others) > 1 and others[1].stamp <= this.stamp:
                others.popleft()
            if others[0].stamp <= this.stamp:  # not before the other run's first sample
                found.append(Pair(this.stamp, this.x, this.values, self._other_at(this)))
        return found

    def _other_at(self, this: Stamped) -> np.ndarray:
        before = self._others[0]
        values = _on(this.x, before)
        if before.stamp == this.stamp:
            return values
        after = self._others[1]
        share = (this.stamp - before.stamp) / (after.stamp - before.stamp)
        return (1.0 - share) * values + share * _on(this.x, after)


def _on(x: np.ndarray | None, sample: Stamped) -> np.ndarray:
    """The values of `sample`, interpolated from its stations to `x`."""
    if x is None or sample.x is None or same(x, sample.x):
        return sample.values
    own = sample.x
    return np.stack([np.interp(x, own, column) for column in sample.values.T], axis=1)
