# SPDX-License-Identifier: Apache-2.0
"""Envelopes of terms: products of sums of C2 ramps, with their time derivatives.

A ramp is eq. (64) of Boyer, Porez and Leroyer, J. Nonlinear Sci. 20 (2010), doi:10.1007/s00332-009-9050-5, times a
number. Ramps of one factor add up from 0, and the factors multiply. The paper's envelopes have one factor. A second
factor is needed where a term fades out while a ramp is still under way.
"""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from eel_common.quantity import number

MOST_FACTORS = 256
ALWAYS = -1e6  # s: assumed start of a term without ramps that is to end


@dataclass(frozen=True)
class Ramp:
    """`delta` times the C2 ramp f_r(t; start, end) of eq. (64), which is 0 before `start` and 1 after `end`, in s.

    `factor`, a whole number from 0 to 255: ramps of one factor of an envelope add up, and the factors multiply.
    `ValueError` if `end` is not after `start`, or if a rate would not be finite.
    """

    start: float
    end: float
    delta: float
    factor: int = 0

    def __post_init__(self) -> None:
        for field in ("start", "end", "delta"):
            object.__setattr__(self, field, number(field, getattr(self, field)))
        factor = number("factor", self.factor)
        if factor != int(factor) or not 0 <= factor < MOST_FACTORS:
            raise ValueError(f"factor must be a whole number from 0 to {MOST_FACTORS - 1}, got {self.factor}")
        object.__setattr__(self, "factor", int(factor))
        if not self.end > self.start:
            raise ValueError(f"end must be > start ({self.start} s), got {self.end}")
        duration = self.end - self.start
        if not math.isfinite(duration) or not math.isfinite(10.0 * self.delta / duration / duration):
            raise ValueError(f"end must lie so after start ({self.start} s) that rates are finite, got {self.end}")

    def value(self, t: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The ramp and its first and second time derivatives at `t` [s]: three arrays of the shape of `t`."""
        duration = self.end - self.start
        s = np.clip((np.asarray(t, dtype=float) - self.start) / duration, 0.0, 1.0)
        moving = (s > 0.0) & (s < 1.0)  # the derivatives are exactly zero outside
        angle = 2.0 * math.pi * s
        value = self.delta * (s - np.sin(angle) / (2.0 * math.pi))
        rate = np.where(moving, self.delta * (1.0 - np.cos(angle)) / duration, 0.0)
        acceleration = np.where(moving, self.delta * 2.0 * math.pi * np.sin(angle) / duration / duration, 0.0)
        return value, rate, acceleration


def envelope_at(ramps: tuple[Ramp, ...], t: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """An envelope of `ramps` and its first and second time derivatives at `t` [s]: three arrays of the shape of `t`.

    Without ramps the envelope is 1.
    """
    value, rate, acceleration = np.ones_like(np.asarray(t, dtype=float)), 0.0, 0.0
    for each in factors_of(ramps):
        v, r, a = np.sum([ramp.value(t) for ramp in each], axis=0)
        value, rate, acceleration = value * v, rate * v + value * r, acceleration * v + 2.0 * rate * r + value * a
    zero = np.zeros_like(value)
    return value, zero + rate, zero + acceleration


def factors_of(ramps: tuple[Ramp, ...]) -> list[list[Ramp]]:
    """The ramps of each factor, a list of lists."""
    numbers = dict.fromkeys(ramp.factor for ramp in ramps)
    return [[ramp for ramp in ramps if ramp.factor == number] for number in numbers]


def height_of(ramps: tuple[Ramp, ...]) -> float:
    """A bound [1] on the magnitude and the changes of an envelope of `ramps`."""
    height = 1.0
    for each in factors_of(ramps):
        level, heights = 0.0, []
        for ramp in sorted(each, key=lambda ramp: ramp.end):
            level += ramp.delta
            heights += [abs(level), abs(ramp.delta)]
        height *= max(heights)
    return height


def begun(ramps: tuple[Ramp, ...], start: float, end: float) -> tuple[Ramp, ...]:
    """The envelope of `ramps`, but 0 before `start` [s] and unchanged after `end` [s].

    It is not changed if it is 0 until `start` anyway.
    """
    if any(all(ramp.start >= start for ramp in each) for each in factors_of(ramps)):
        return ramps
    return _multiplied(ramps, (Ramp(start, end, 1.0),))


def ended(ramps: tuple[Ramp, ...], start: float, end: float) -> tuple[Ramp, ...] | None:
    """The envelope of `ramps`, but 0 after `end` [s] and unchanged before `start` [s]; None if it is always 0.

    Ramps that begin after `end` are dropped.
    """
    factors = factors_of(ramps)
    kept = tuple(ramp for ramp in ramps if ramp.start < end)
    if len(factors_of(kept)) < len(factors):
        return None
    if len(factors) == 1 and all(ramp.end <= start for ramp in kept):
        level = math.fsum(ramp.delta for ramp in kept)
        return (*kept, Ramp(start, end, -level, kept[0].factor)) if level else kept
    return _multiplied(kept, (Ramp(2.0 * ALWAYS, ALWAYS, 1.0), Ramp(start, end, -1.0)))


def _multiplied(ramps: tuple[Ramp, ...], others: tuple[Ramp, ...]) -> tuple[Ramp, ...]:
    """The product of the envelope of `ramps` and that of `others`, which have factor 0."""
    factor = 1 + max((ramp.factor for ramp in ramps), default=-1)
    return (*ramps, *(replace(ramp, factor=factor) for ramp in others))
