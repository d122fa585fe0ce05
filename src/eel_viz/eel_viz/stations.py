"""The stations of a swimmer's profiles: rows of abscissae X [m] that hardly ever change."""

import numpy as np


def same(x: np.ndarray, other: np.ndarray) -> bool:
    """Whether two rows of stations are equal; quickly where they are one."""
    return x is other or np.array_equal(x, other)
