# SPDX-License-Identifier: Apache-2.0
"""Errors of readings: white noise, a constant bias, and a bias that walks at random.

    error = bias + noise * n_k + walk * sum of sqrt(t_i - t_(i-1)) * m_i up to k

n and m are independent standard normal numbers. They depend on the seed and on the number k of the reading alone, so a
sensor gives the same readings to the last bit however many are asked for at once. The Allan deviation over the time tau
is noise * sqrt(period / tau) of the white noise, and walk * sqrt(tau / 3) of the walk.
"""

from typing import NamedTuple

import numpy as np


class Spread(NamedTuple):
    """Of each number (n,) of a reading: standard deviation of its noise, its bias, and the walk by sqrt(s)."""

    noise: np.ndarray
    bias: np.ndarray
    walk: np.ndarray

    @staticmethod
    def of(*groups: tuple[float, float | tuple[float, ...], float, int]) -> "Spread":
        """From groups of so many numbers each: (noise, bias, walk, how many)."""
        rows = [(np.full(n, noise), np.zeros(n) + bias, np.full(n, walk)) for noise, bias, walk, n in groups]
        return Spread(*(np.concatenate(row) for row in zip(*rows, strict=True)))


class Errors:
    """Draws the errors of one sensor, reading by reading. seed: numbers that no other sensor has."""

    def __init__(self, spread: Spread, seed: tuple[int, ...]):
        self._spread, self._random = spread, np.random.default_rng(seed)
        self._walked = np.zeros((1, len(spread.noise)))

    def draw(self, gaps: np.ndarray) -> np.ndarray:
        """The errors (N, n) of the next readings; `gaps` (N,) [s]: from the reading before each, 0 of the first."""
        normal = self._random.standard_normal((len(gaps), 2, len(self._spread.noise)))
        steps = np.sqrt(gaps)[:, None] * self._spread.walk * normal[:, 1]
        walked = np.cumsum(np.concatenate((self._walked, steps)), axis=0)
        self._walked = walked[-1:]
        return np.asarray(self._spread.bias + walked[1:] + self._spread.noise * normal[:, 0])
