# SPDX-License-Identifier: Apache-2.0
"""Measurements of a swim: the path of a point of the body, a robot's joint angles, or a steady speed.

Each has `values` (T, D) at the times (T,), with NaN where unknown.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from eel_common.quantity import checked_instance, checked_row, number, positive
from eel_common.quantity import numbers as real_numbers
from eel_common.wording import shown

FEWEST_SAMPLES = 4  # of a path: a coast may have few


@dataclass(frozen=True, eq=False)
class MeasuredPath:
    """The path of one point of the backbone.

    Attributes:
        time: [s], (T,), rising, from 0 or later, in the law's own time.
        position: [m], (T, 2) or (T, 3), in axes of the laboratory: z up, x and y in any direction.
        station: X [m] of the tracked point; 0 is the nose.
        numbers: of this swim, by the names of `studies.points`, such as {"period": 0.8, "initial.v_x": 0.2}.

    `ValueError` names a bad attribute.
    """

    time: np.ndarray
    position: np.ndarray
    station: float = 0.0
    numbers: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        time = checked_row("path time", self.time, None)
        position = real_numbers("path position", self.position)
        if position.ndim != 2 or position.shape[1] not in (2, 3) or len(position) != len(time):
            raise ValueError(
                f"path position must have 2 or 3 coordinates at each of {len(time)} times, got {position.shape}"
            )
        if not np.isfinite(position).all():
            index = int(np.argmax(~np.isfinite(position).all(axis=1)))
            raise ValueError(
                f"path position must be finite, got {shown(position[index].tolist())} at index {index}; leave such "
                "samples out, with their times"
            )
        _check_time("path", time)
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "position", position)
        object.__setattr__(self, "station", number("path station", self.station, "m", minimum=0.0))
        checked_instance("path numbers", self.numbers, dict)

    @property
    def values(self) -> np.ndarray:
        return self.position


@dataclass(frozen=True, eq=False)
class MeasuredAngles:
    """The angles of a robot's joints.

    Attributes:
        time: [s], (T,), rising from 0 or later, in the law's own time. The robot starts as in `simulate`.
        angles: [rad], (T, J), of the robot's joints in their order and sign; NaN where unknown.
        numbers: of this swim, as in `MeasuredPath`.

    `ValueError` names a bad attribute.
    """

    time: np.ndarray
    angles: np.ndarray
    numbers: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        time = checked_row("angles time", self.time, None)
        angles = real_numbers("angles", self.angles)
        if angles.ndim != 2 or len(angles) != len(time) or np.isinf(angles).any():
            raise ValueError(
                f"angles must have a row of finite angles, or NaN, at each of {len(time)} times, got "
                f"{shown(angles.shape) if not np.isinf(angles).any() else 'inf'}"
            )
        _check_time("angles", time)
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "angles", angles)
        checked_instance("angles numbers", self.numbers, dict)

    @property
    def values(self) -> np.ndarray:
        return self.angles


@dataclass(frozen=True, eq=False)
class MeasuredSpeed:
    """The speed [m/s] over the water of one steady swim, with the `numbers` of this swim as in `MeasuredPath`."""

    speed: float
    numbers: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", positive("measured speed", self.speed, "m/s"))
        checked_instance("measured speed numbers", self.numbers, dict)

    @property
    def time(self) -> np.ndarray:
        """(1,): a single dummy time."""
        return np.zeros(1)

    @property
    def values(self) -> np.ndarray:
        """The speed, (1, 1)."""
        return np.array([[self.speed]])


Measurement = MeasuredPath | MeasuredAngles | MeasuredSpeed
Measurements = list[MeasuredPath] | list[MeasuredAngles] | list[MeasuredSpeed] | list[Measurement]


def count_of(measured: Sequence[Measurement]) -> int:
    """The number of measured values."""
    return sum(int(np.isfinite(each.values).sum()) for each in measured)


def _check_time(what: str, time: np.ndarray) -> None:
    if len(time) < FEWEST_SAMPLES:
        raise ValueError(f"{what} must have {FEWEST_SAMPLES} samples or more, got {len(time)}")
    if time[0] < 0.0 or np.any(np.diff(time) <= 0.0):
        raise ValueError(f"{what} time must rise from 0 s or later, got {shown(time[:8].tolist())}")
