# SPDX-License-Identifier: Apache-2.0
"""The C2 ramp of eq. (64) of Boyer, Porez and Leroyer (2010), doi:10.1007/s00332-009-9050-5."""

import math
from dataclasses import dataclass

import numpy as np

from eel_gaits.input_output.quantity import number


@dataclass(frozen=True)
class Ramp:
    """`delta` times the C2 ramp f_r(t; start, end) of eq. (64), which is 0 before `start` and 1 after `end`, in s.

    `ValueError` where `end` does not lie after `start`, or where a rate would not be finite.
    """

    start: float
    end: float
    delta: float

    def __post_init__(self):
        for field in ("start", "end", "delta"):
            object.__setattr__(self, field, number(field, getattr(self, field)))
        if not self.end > self.start:
            raise ValueError(f"end must be > start ({self.start} s), got {self.end}")
        duration = self.end - self.start
        if not math.isfinite(duration) or not math.isfinite(10.0 * self.delta / duration / duration):
            raise ValueError(f"end must lie so after start ({self.start} s) that rates are finite, got {self.end}")

    def value(self, t):
        """The ramp and its first and second time derivatives at `t` [s]: three arrays of the shape of `t`."""
        duration = self.end - self.start
        s = np.clip((np.asarray(t, dtype=float) - self.start) / duration, 0.0, 1.0)
        moving = (s > 0.0) & (s < 1.0)  # the derivatives are exactly zero outside
        angle = 2.0 * math.pi * s
        value = self.delta * (s - np.sin(angle) / (2.0 * math.pi))
        rate = np.where(moving, self.delta * (1.0 - np.cos(angle)) / duration, 0.0)
        acceleration = np.where(moving, self.delta * 2.0 * math.pi * np.sin(angle) / duration / duration, 0.0)
        return value, rate, acceleration
