# SPDX-License-Identifier: Apache-2.0
"""The limit of a scale: what the user has set, or a round number that fits the last values."""

from collections import deque

import numpy as np

STEPS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)


RECENT = 3_000_000_000  # ns: what counts for a scale, so that a start or a manoeuvre does not fix it


class Limit:
    """`value` > 0 of a scale from -value to +value: a round number that fits the values of the last `RECENT`.

    least: what it does not fall below [any unit]. grows: whether greater values make it grow.
    """

    def __init__(self, least: float, *, grows: bool = True) -> None:
        self._least, self._grows = least, grows
        self._greatest: deque[tuple[int, float]] = deque()  # ns, value: each greater than those after it

    @property
    def value(self) -> float:
        """The present limit; 1 while all values have been zero."""
        greatest = self._greatest[0][1] if self._grows and self._greatest else 0.0
        return (self._least if greatest <= self._least else rounded_up(greatest)) or 1.0

    def include(self, stamp: int, value: float) -> None:
        """Take the `value` >= 0 at `stamp` [ns]."""
        recent = self._greatest
        while recent and (recent[-1][1] <= value or recent[-1][0] > stamp):
            recent.pop()
        recent.append((stamp, value))
        while recent[0][0] < stamp - RECENT:
            recent.popleft()


def rounded_up(value: float) -> float:
    """The next round number from `value` >= 0 on."""
    if value <= 0.0:
        return 0.0
    decade = 10.0 ** np.floor(np.log10(value))
    return next(float(step * decade) for step in STEPS if step * decade >= value * (1 - 1e-12))
