# SPDX-License-Identifier: Apache-2.0
"""The heading averaged over the last control steps: the head swings with the gait."""

from typing import Any

import numpy as np
from eel_gaits.pilot.head_motion import wrapped


class MeanHeading:
    """The mean of the last `count` headings [rad], also across the turn from pi to -pi; of one swimmer or, side by
    side, of the `swimmers` (N,)."""

    def __init__(self, count: int, swimmers: tuple[int, ...] = ()):
        self._headings = np.zeros((count, *swimmers))  # rad, each within half a turn of the one before; 0 where none is
        self._place = 0  # of the last one
        self._last: Any = np.zeros(swimmers) if swimmers else 0.0
        self._sum: Any = self._last
        self._known: Any = np.zeros(swimmers, dtype=int) if swimmers else 0

    def clear(self) -> None:
        """Forget all headings."""
        self.__init__(len(self._headings), self._headings.shape[1:])  # type: ignore[misc]

    def add(self, heading: Any) -> Any:
        """The mean [rad], from -pi to pi, with this `heading` [rad]."""
        self._place = (self._place + 1) % len(self._headings)
        self._last = self._last + wrapped(heading - self._last)
        self._sum = self._sum + self._last - self._headings[self._place]
        self._headings[self._place] = self._last
        self._known = self._known + (self._known < len(self._headings))
        return wrapped(self._sum / self._known)

    def begin_one(self, swimmer: int, heading: float) -> Any:
        """The mean [rad] of one of N swimmers that has this `heading` alone."""
        self._headings[:, swimmer] = 0.0
        self._headings[self._place, swimmer] = self._last[swimmer] = self._sum[swimmer] = wrapped(heading)
        self._known[swimmer] = 1
        return wrapped(heading)
