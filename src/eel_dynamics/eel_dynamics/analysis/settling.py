# SPDX-License-Identifier: Apache-2.0
"""Whether the mean over a period of the gait has settled: what it has changed by lately, and is still to change by."""

import math
import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

SETTLED = 0.01  # relative: the most that a settled mean changes within the window, and the most that it goes on to
STEADY = 1e-4  # relative: a mean that changes by less within the window is as steady as its own error
FEWEST = 3  # periods, that tell how the changes fall


class Unsettled(UserWarning):
    """A mean was read of a run whose gait has not settled."""


def tell_unsettled(settled: ArrayLike, what: str, stacklevel: int = 3) -> None:
    """An `Unsettled` warning with how many of `settled` (n,) are 0, not 1 or NaN; `what` they are."""
    array = np.asarray(settled, dtype=float)
    if many := int(np.sum(array == 0.0)):
        warnings.warn(f"{many} of {array.size} {what} have not settled", Unsettled, stacklevel=stacklevel)


def change_of(means: Sequence[float] | np.ndarray) -> float:
    """The change of the `means` (n,) over successive periods, relative to the last of them.

    The greater of two: from the first mean to the last, and what is left to come. The latter follows from the last two
    changes d1, d2. Where they fall geometrically it is d2^2 / (d1 - d2); where they alternate it is d2; where they
    have one sign and do not fall it has no bound. So a slow change is not taken for none. Infinite for fewer than three
    means, and where the last is 0.
    """
    if len(means) < FEWEST:
        return math.inf
    values = [float(each) for each in means]
    scale = abs(values[-1])
    if not scale > 0.0:
        return math.inf
    spread = (max(values) - min(values)) / scale
    before, last = (values[-2] - values[-3]) / scale, (values[-1] - values[-2]) / scale
    if spread <= STEADY:
        return spread
    if before * last <= 0.0:
        return max(spread, abs(last))
    return max(spread, last * last / (abs(before) - abs(last))) if abs(last) < abs(before) else math.inf
