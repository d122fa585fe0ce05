# SPDX-License-Identifier: Apache-2.0
"""Bends whose direction turns about the backbone: equal motions in pitch and yaw, a quarter of a period apart."""

import math
from dataclasses import dataclass

from eel_gaits.gaits.numbers import (
    bend_quantity,
    period_quantity,
    start_periods_quantity,
    start_ramp,
    wavelength_quantity,
)
from eel_gaits.gaits.registry import register
from eel_gaits.input_output.quantity import Quantities
from eel_gaits.laws.term import Term


@dataclass(frozen=True, kw_only=True)
class Roll(Quantities):
    """A bend of the whole body whose direction turns about the backbone."""

    period: float = period_quantity(1.0)
    pitch_amplitude: float = bend_quantity(1.0, "amplitude in pitch")
    yaw_amplitude: float = bend_quantity(1.0, "amplitude in yaw")
    start_periods: float = start_periods_quantity()


@dataclass(frozen=True, kw_only=True)
class Helix(Quantities):
    """Equal waves in pitch and yaw, a quarter of a period apart: a corkscrew that runs to the tail."""

    period: float = period_quantity(1.0)
    wavelength: float = wavelength_quantity(1.0, "wavelength of the helix")
    pitch_amplitude: float = bend_quantity(1.5, "amplitude in pitch")
    yaw_amplitude: float = bend_quantity(1.5, "amplitude in yaw")
    start_periods: float = start_periods_quantity()


@register(Roll)
def rolling(numbers):
    """A body bent into an arc whose direction turns about the backbone."""
    return _pair(numbers, wavelength=0.0)


@register(Helix)
def helix(numbers):
    """A corkscrew: equal waves in pitch and yaw, a quarter of a period apart."""
    return _pair(numbers, wavelength=numbers.wavelength)


def _pair(numbers, *, wavelength):
    shared = {"wavelength": wavelength, "period": numbers.period, "envelope": start_ramp(numbers)}
    return (
        Term(axis="pitch", amplitude=(numbers.pitch_amplitude,), phase=math.pi / 2.0, **shared),
        Term(axis="yaw", amplitude=(numbers.yaw_amplitude,), **shared),
    )
