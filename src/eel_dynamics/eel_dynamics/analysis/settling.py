# SPDX-License-Identifier: Apache-2.0
"""Whether the mean over a period of the gait has settled: its recent change, and its change still to come."""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

SETTLED = 0.01  # relative: most change of a settled mean within the window, and most change still to come
STEADY = 1e-4  # relative: the error of the means themselves, for three periods
FEWEST = 3  # periods needed to extrapolate the changes


class Unsettled(UserWarning):
    """A mean was taken over a gait that has not settled."""


def tell_unsettled(settled: ArrayLike, what: str, stacklevel: int = 3) -> None:
    """Give an `Unsettled` warning with the number of zeros in `settled` (n,), not of 1 or NaN. `what`: their name."""
    array = np.asarray(settled, dtype=float)
    if many := int(np.sum(array == 0.0)):
        warnings.warn(f"{many} of {array.size} {what} have not settled", Unsettled, stacklevel=stacklevel)


@dataclass(frozen=True)
class Settling:
    """The change of a mean over a period, relative to the last one: whether it has settled, and the reason as text.

    It has settled if both changes are at most `SETTLED`. So a slow change does not count as none.
    """

    periods: int  # number of periods
    within: float  # from the least of their means to the greatest
    left: float  # change still to come; infinite without a bound

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
    """The changes of the `means` (n,) over successive periods.

    The change still to come follows from the last two changes d1, d2: d2^2 / (d1 - d2) if they fall geometrically; d2
    if they alternate; without bound if they have one sign and do not fall, unless both together are within the means'
    own error (`STEADY`). Infinite for fewer than three means, and if the last is 0.
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
    """A change as text, with enough digits to show on which side of `SETTLED` it is."""
    if change < STEADY:
        return f"less than {STEADY:.2%}"
    texts = (f"{change:.{digits}%}" for digits in range(2, 18))
    return next(each for each in texts if (float(each[:-1]) <= 100.0 * SETTLED) == (change <= SETTLED))
