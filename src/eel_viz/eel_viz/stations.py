# SPDX-License-Identifier: Apache-2.0
"""Comparison of stations: arrays of abscissae X [m], which rarely change during a run."""

import numpy as np


def same(x: np.ndarray, other: np.ndarray) -> bool:
    """Whether two arrays of stations, (M,) [m], are equal; fast if they are the same object."""
    return x is other or np.array_equal(x, other)
