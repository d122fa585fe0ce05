# SPDX-License-Identifier: Apache-2.0
"""Bends whose direction turns about the backbone: equal motions in pitch and yaw, a quarter of a period apart."""

import math
from dataclasses import dataclass
from typing import Any

from eel_base.quantity import quantity

from eel_gaits.gaits.numbers import Periodic, bend_quantity, wavelength_quantity
from eel_gaits.gaits.registry import register
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term


@dataclass(frozen=True, kw_only=True)
class Roll(Periodic):
    """A bend of the whole body whose direction turns about the backbone."""

    pitch_amplitude: float = bend_quantity(1.0, "amplitude in pitch")
    yaw_amplitude: float = bend_quantity(1.0, "amplitude in yaw")


@dataclass(frozen=True, kw_only=True)
class Helix(Periodic):
    """Equal waves in pitch and yaw, a quarter of a period apart: a corkscrew that runs to the tail."""

    wavelength: float = wavelength_quantity(1.0, "wavelength of the helix")
    pitch_amplitude: float = bend_quantity(1.5, "amplitude in pitch")
    yaw_amplitude: float = bend_quantity(1.5, "amplitude in yaw")


@dataclass(frozen=True, kw_only=True)
class RollOver(Periodic):
    """A bend whose direction turns about the backbone for some periods."""

    bend: float = bend_quantity(0.3, "amplitude of the bend; positive: the left side goes up, negative: the right side")
    start_periods: float = quantity(3.0, "periods", "length of the start and of the end", 0.01, 1e3)
    hold_periods: float = quantity(1.1, "periods", "time between start and end", 0.0, 1e3)


@register(Roll)
def rolling(numbers: Roll) -> tuple[Term, ...]:
    """A body bent into an arc whose direction turns about the backbone.

    With amplitudes of one sign the left side goes down, with opposite signs the right side.
    """
    return _pair(numbers, wavelength=0.0)


@register(RollOver)
def roll_over(numbers: RollOver) -> tuple[Term, ...]:
    """Half a turn about the backbone: while a bend turns about it, body and water turn the other way."""
    start, end = numbers.start_periods * numbers.period, numbers.hold_periods * numbers.period
    end += start
    envelope = (Ramp(0.0, start, 1.0), Ramp(end, end + start, -1.0))
    shared: dict[str, Any] = {"period": numbers.period, "envelope": envelope}
    return (
        Term(axis="pitch", amplitude=(-numbers.bend,), phase=math.pi / 2.0, **shared),
        Term(axis="yaw", amplitude=(abs(numbers.bend),), **shared),
    )


@register(Helix)
def helix(numbers: Helix) -> tuple[Term, ...]:
    """A corkscrew: equal waves in pitch and yaw, a quarter of a period apart.

    With amplitudes of one sign the left side goes down, with opposite signs the right side.
    """
    return _pair(numbers, wavelength=numbers.wavelength)


def _pair(numbers: Roll | Helix, *, wavelength: float) -> tuple[Term, ...]:
    shared: dict[str, Any] = {"wavelength": wavelength, "period": numbers.period, "envelope": numbers.start}
    return (
        Term(axis="pitch", amplitude=(numbers.pitch_amplitude,), phase=math.pi / 2.0, **shared),
        Term(axis="yaw", amplitude=(numbers.yaw_amplitude,), **shared),
    )
