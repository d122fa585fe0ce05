# SPDX-License-Identifier: Apache-2.0
"""When a sensor reads: at the first sample of the run at or after each multiple of its period."""

import math

import numpy as np

ROUNDING = 1e-6  # of a period: a sample may lie that far before a multiple


def readings_among(times: np.ndarray, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Which of the samples at `times` (T,) [s] a sensor of this `rate` [Hz] reads: indices (N,), and the gaps (N,) [s]
    since the reading before each, 0 of the first."""
    count = np.floor(times * rate + ROUNDING)
    rows = np.flatnonzero(np.diff(count, prepend=-1.0) > 0.0)
    return rows, np.diff(times[rows], prepend=times[rows][:1])


class Timing:
    """The same, sample by sample."""

    def __init__(self, rate: float):
        self._rate, self._count, self._last = rate, -1, math.nan  # count: periods up to the last sample

    def gap(self, time: float) -> float | None:
        """The gap [s] of a reading at the next sample, at `time` [s]; None if it is not read."""
        before, self._count = self._count, math.floor(time * self._rate + ROUNDING)
        if self._count <= before:
            return None
        last, self._last = self._last, time
        return 0.0 if before < 0 else time - last


def check_rate(name: str, rate: float, samples: float) -> None:
    """`ValueError` for a sensor's `rate` [Hz] above that of the `samples` of its run [Hz]."""
    if rate > samples * (1.0 + ROUNDING):
        raise ValueError(f"{name} must be at most the {samples:g} Hz of the run, got {rate:g} Hz")
