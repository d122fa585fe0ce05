# SPDX-License-Identifier: Apache-2.0
"""Errors of readings: white noise, a constant bias, and a bias that walks at random.

    error = bias + noise * n_k + walk * sum of sqrt(t_i - t_(i-1)) * m_i up to k

n and m are independent standard normal numbers. They depend on the seed and on the number k of the reading alone. So
a sensor gives the same readings to the last bit, however many are read at once. The Allan deviation over the time tau
is noise * sqrt(period / tau) for the white noise, and walk * sqrt(tau / 3) for the walk.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

BLOCK = 64  # readings whose normal numbers are drawn at once, if they are read one by one


class Spread(NamedTuple):
    """For each number (n,) of a reading: standard deviation of the noise, bias, and walk per sqrt(s)."""

    noise: np.ndarray
    bias: np.ndarray
    walk: np.ndarray

    @staticmethod
    def of(*groups: tuple[float, float | tuple[float, ...], float, int]) -> "Spread":
        """From groups (noise, bias, walk, how many numbers)."""
        rows = [(np.full(n, noise), np.zeros(n) + bias, np.full(n, walk)) for noise, bias, walk, n in groups]
        return Spread(*(np.concatenate(row) for row in zip(*rows, strict=True)))


class Errors:
    """Draws the errors of one sensor from its first reading on, all at once or one by one. seed: its own."""

    def __init__(self, spread: Spread, seed: tuple[int, ...]):
        self._spread, self._random = spread, np.random.default_rng(seed)
        self._each = [*zip(*(row.tolist() for row in spread), [0.0] * len(spread.noise), strict=True)]
        self._normal, self._walks = self._drawn(), bool(spread.walk.any())

    def all(self, gaps: np.ndarray) -> list[np.ndarray]:
        """The errors of all readings: n arrays (N,). gaps (N,) [s]: since the previous reading, 0 for the first."""
        noise, bias, walk = self._spread
        normal = self._random.standard_normal((len(gaps), 2, len(noise)))
        walked = np.cumsum(np.sqrt(gaps)[:, None] * walk * normal[:, 1], axis=0)
        return [*(bias + walked + noise * normal[:, 0]).T]

    def one(self, gap: float) -> list[float]:
        """The errors (n,) of the next reading, `gap` [s] after the previous one."""
        root, (white, steps) = math.sqrt(gap), next(self._normal)
        if self._walks:
            self._each = [
                (noise, bias, walk, walked + root * walk * m)
                for (noise, bias, walk, walked), m in zip(self._each, steps, strict=True)
            ]
        return [bias + walked + noise * n for (noise, bias, _, walked), n in zip(self._each, white, strict=True)]

    def _drawn(self) -> Iterator[list[list[float]]]:
        while True:
            yield from self._random.standard_normal((BLOCK, 2, len(self._each))).tolist()
