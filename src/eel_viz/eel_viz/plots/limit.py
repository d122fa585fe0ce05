# SPDX-License-Identifier: Apache-2.0
"""The limit of a scale: what the user has set, or what fits the values so far; it grows by round numbers."""

import numpy as np

STEPS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)


class Limit:
    """`value` > 0 of a scale from -value to +value. It begins with `start` [any unit]; 0: with the first value.

    grows: whether values above it make it grow.
    """

    def __init__(self, start: float, *, grows: bool = True) -> None:
        self._limit, self._grows = start, grows

    @property
    def value(self) -> float:
        """The present limit; 1 while all values have been zero."""
        return self._limit or 1.0

    def include(self, value: float) -> None:
        """Grow to the next round number if `value` >= 0 exceeds the limit, and the limit may grow."""
        if value > self._limit and self._grows:
            decade = 10.0 ** np.floor(np.log10(value))
            self._limit = next(float(step * decade) for step in STEPS if step * decade >= value * (1 - 1e-12))
