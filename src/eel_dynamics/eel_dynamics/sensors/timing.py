# SPDX-License-Identifier: Apache-2.0
"""When a sensor reads: at the first sample of the run at or after each multiple of its period."""

import numpy as np

ROUNDING = 1e-6  # of a period: a sample may lie that far before a multiple


class Timing:
    """Picks the samples at which a sensor of this `rate` [Hz] reads, as time goes on."""

    def __init__(self, rate: float):
        self._rate, self._count, self._last = rate, -1.0, np.nan  # count: periods up to the last sample

    def due(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Which of the next samples at `times` (T,) [s] are read: indices (N,), and gaps (N,) [s] since the reading
        before each, 0 of the first."""
        count = np.floor(times * self._rate + ROUNDING)
        rows = np.flatnonzero(count > np.concatenate(([self._count], count[:-1])))
        self._count = count[-1] if len(count) else self._count
        read = times[rows]
        gaps = read - np.concatenate(([self._last], read[:-1]))[: len(read)]
        self._last = read[-1] if len(read) else self._last
        return rows, np.where(np.isnan(gaps), 0.0, gaps)


def check_rate(name: str, rate: float, samples: float) -> None:
    """`ValueError` for a sensor's `rate` [Hz] above that of the `samples` of its run [Hz]."""
    if rate > samples * (1.0 + ROUNDING):
        raise ValueError(f"{name} must be at most the {samples:g} Hz of the run, got {rate:g} Hz")
