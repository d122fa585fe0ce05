# SPDX-License-Identifier: Apache-2.0
"""The limit of a scale: what the user has set, or what fits the values so far, or the last of them; a round number."""

from collections import deque

import numpy as np

STEPS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)


class Limit:
    """`value` > 0 of a scale from -value to +value. It begins with `start` [any unit]; 0: with the first value.

    It grows by the values that are included.
    """

    def __init__(self, start: float) -> None:
        self._limit = start

    @property
    def value(self) -> float:
        """The present limit; 1 while all values have been zero."""
        return self._limit or 1.0

    def include(self, value: float) -> None:
        """Grow to the next round number if `value` >= 0 exceeds the limit."""
        if value > self._limit:
            self._limit = rounded_up(value)


class RecentLimit:
    """A limit that fits the values of the last `WINDOW`: so a start or a manoeuvre does not fix it. fixed: 0, or it."""

    WINDOW = 3_000_000_000  # ns

    def __init__(self, fixed: float) -> None:
        self._fixed = fixed
        self._greatest: deque[tuple[int, float]] = deque()  # ns, value: each greater than those after it

    @property
    def value(self) -> float:
        """The present limit; 1 while all values have been zero."""
        return self._fixed or (self._greatest and rounded_up(self._greatest[0][1])) or 1.0

    def include(self, stamp: int, value: float) -> None:
        """Take the `value` >= 0 at `stamp` [ns]."""
        recent = self._greatest
        while recent and (recent[-1][1] <= value or recent[-1][0] > stamp):
            recent.pop()
        recent.append((stamp, value))
        while recent[0][0] < stamp - self.WINDOW:
            recent.popleft()


def rounded_up(value: float) -> float:
    """The next round number from `value` >= 0 on."""
    if value <= 0.0:
        return 0.0
    decade = 10.0 ** np.floor(np.log10(value))
    return next(float(step * decade) for step in STEPS if step * decade >= value * (1 - 1e-12))
