# SPDX-License-Identifier: Apache-2.0
"""Whether the mean over a period of the gait has settled: what it has changed by lately, and is still to change by."""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

SETTLED = 0.01  # relative: the most that a settled mean changes within the window, and the most that it goes on to
STEADY = 1e-4  # relative: means of three periods that differ by less are as steady as their own error
FEWEST = 3  # periods, that tell how the changes fall


class Unsettled(UserWarning):
    """A mean was read of a run whose gait has not settled."""


def tell_unsettled(settled: ArrayLike, what: str, stacklevel: int = 3) -> None:
    """An `Unsettled` warning with how many of `settled` (n,) are 0, not 1 or NaN; `what` they are."""
    array = np.asarray(settled, dtype=float)
    if many := int(np.sum(array == 0.0)):
        warnings.warn(f"{many} of {array.size} {what} have not settled", Unsettled, stacklevel=stacklevel)


@dataclass(frozen=True)
class Settling:
    """How a mean over a period changes, relative to the last one: whether it has settled, and as text what tells so.

    It has where both changes are `SETTLED` at most. So a slow change is not taken for none.
    """

    periods: int  # that were looked at
    within: float  # from the least of their means to the greatest
    left: float  # still to come; infinite where nothing bounds it

    @property
    def change(self) -> float:
        """The greater of the two changes."""
        return max(self.within, self.left)

    @property
    def settled(self) -> bool:
        """Whether the mean has settled."""
        return self.change <= SETTLED

    def __str__(self) -> str:
        if self.periods < FEWEST:
            return f"it takes {FEWEST} periods to tell, got {self.periods}"
        left = "its changes do not fall" if math.isinf(self.left) else f"{_percent(self.left)} is left to come"
        return f"the mean speed changes by {_percent(self.within)} over {self.periods} periods, and {left}"


def settling_of(means: Sequence[float] | np.ndarray) -> Settling:
    """How the `means` (n,) over successive periods change.

    What is left to come follows from the last two changes d1, d2. Where they fall geometrically it is d2^2 / (d1 - d2);
    where they alternate it is d2; where they have one sign and do not fall it has no bound, unless both together are
    within the means' own error (`STEADY`). Infinite for fewer than three means, and where the last is 0.
    """
    values = [float(each) for each in means]
    scale = abs(values[-1]) if values else 0.0
    if len(values) < FEWEST or not scale > 0.0:
        return Settling(len(values), math.inf, math.inf)
    within = (max(values) - min(values)) / scale
    before, last = (values[-2] - values[-3]) / scale, (values[-1] - values[-2]) / scale
    if abs(before) + abs(last) <= STEADY or before * last <= 0.0:
        left = abs(last)
    else:
        left = last * last / (abs(before) - abs(last)) if abs(last) < abs(before) else math.inf
    return Settling(len(values), within, left)


def _percent(change: float) -> str:
    """A change as text, with as many digits as it takes to lie on its own side of `SETTLED`."""
    if change < STEADY:
        return f"less than {STEADY:.2%}"
    texts = (f"{change:.{digits}%}" for digits in range(2, 18))
    return next(each for each in texts if (float(each[:-1]) <= 100.0 * SETTLED) == (change <= SETTLED))
