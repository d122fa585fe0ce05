# SPDX-License-Identifier: Apache-2.0
"""The greatest value of the last seconds, and the limit of a scale: set by the user, or a fitting round number."""

from collections import deque

import numpy as np

STEPS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
RECENT = 3_000_000_000  # ns: window, so that a start or a manoeuvre does not fix a scale


class RecentPeak:
    """The greatest value of the last `RECENT`, and its place [m]; both 0 before the first."""

    def __init__(self) -> None:
        self._greatest: deque[tuple[int, float, float]] = deque()  # ns, value, m: each greater than the later ones

    @property
    def value(self) -> float:
        """The greatest value."""
        return self._greatest[0][1] if self._greatest else 0.0

    @property
    def place(self) -> float:
        """Its place [m]."""
        return self._greatest[0][2] if self._greatest else 0.0

    def include(self, stamp: int, value: float, place: float = 0.0) -> None:
        """Take the `value` >= 0 at `stamp` [ns] and `place` [m]."""
        recent = self._greatest
        while recent and (recent[-1][1] <= value or recent[-1][0] > stamp):
            recent.pop()
        recent.append((stamp, value, place))
        while recent[0][0] < stamp - RECENT:
            recent.popleft()


class Limit:
    """`value` > 0 of a scale from -value to +value: a round number that fits the values of the last `RECENT`.

    least: lower bound of the limit [any unit]. grows: whether greater values increase it.

    Attribute recent: the peak, which takes the values.
    """

    def __init__(self, least: float, *, grows: bool = True) -> None:
        self._least, self._grows = least, grows
        self.recent = RecentPeak()

    @property
    def value(self) -> float:
        """The present limit; 1 while all values are zero."""
        greatest = self.recent.value if self._grows else 0.0
        return (self._least if greatest <= self._least else rounded_up(greatest)) or 1.0


def rounded_up(value: float) -> float:
    """The least round number that is not below `value` >= 0."""
    if value <= 0.0:
        return 0.0
    decade = 10.0 ** np.floor(np.log10(value))
    return next(float(step * decade) for step in STEPS if step * decade >= value * (1 - 1e-12))
