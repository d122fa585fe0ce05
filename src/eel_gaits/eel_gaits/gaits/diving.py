# SPDX-License-Identifier: Apache-2.0
"""Motions out of the horizontal plane.

Dives and climbs: the forward wave with bends in pitch. Source: Boyer, Porez and Leroyer, J. Nonlinear Sci. 20 (2010),
section 7.2.2, doi:10.1007/s00332-009-9050-5.
Rolls: equal bends in pitch and yaw, a quarter of a period apart, so that the bend turns about the backbone.
"""

import math
from dataclasses import dataclass
from typing import Any

from eel_common.quantity import quantity

from eel_gaits.gaits.numbers import (
    Periodic,
    bend_quantity,
    constant_bend,
    duration_quantity,
    instant_quantity,
    left_quantity,
    left_turn,
    wavelength_quantity,
)
from eel_gaits.gaits.registry import register
from eel_gaits.gaits.swimming import Wave
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term


@dataclass(frozen=True, kw_only=True)
class Dive(Wave):
    """The forward wave with a bend in pitch, first one way and later the other: gamma(t) of eq. (66)."""

    pitch_bend: float = bend_quantity(0.5, "pitch curvature of the dive, K_c2")
    bend_start: float = instant_quantity(1.0, "the bend begins, t1")
    bend_full: float = instant_quantity(2.0, "the bend is complete, t2", "bend_start")
    bend_end: float = instant_quantity(3.0, "the body is straight in pitch again, t3", "bend_full")
    counter_start: float = instant_quantity(6.0, "the opposite bend begins, t4")
    counter_full: float = instant_quantity(7.0, "the opposite bend is complete, t5", "counter_start")
    counter_end: float = instant_quantity(8.0, "the body is straight in pitch for good, t6", "counter_full")

    def terms(self, direction: float) -> tuple[Term, ...]:
        """The wave, and the pitch term, which first bends the tail down (direction 1) or up (-1)."""
        ramps = (
            Ramp(self.bend_start, self.bend_full, 1.0),
            Ramp(self.bend_full, self.bend_end, -1.0),
            Ramp(self.counter_start, self.counter_full, -1.0),
            Ramp(self.counter_full, self.counter_end, 1.0),
        )
        return (self.term(), *constant_bend("pitch", direction * self.pitch_bend, ramps))


@dataclass(frozen=True, kw_only=True)
class Slope(Wave):
    pitch_bend: float = bend_quantity(0.4, "pitch curvature of the dive; positive: down, negative: up")
    bend_start: float = instant_quantity(1.0, "the bend begins")
    bend_full: float = instant_quantity(2.5, "the bend is complete", "bend_start")
    unbend_start: float = instant_quantity(3.0, "the body begins to straighten in pitch")
    bend_end: float = instant_quantity(4.5, "the body is straight in pitch again", "unbend_start")


@dataclass(frozen=True, kw_only=True)
class Spiral(Wave):
    """The forward wave with lasting bends in yaw and pitch, after a first bend in pitch that lowers the head."""

    left_bend: float = left_quantity(-2.0, "yaw curvature of the spiral")
    pitch_bend: float = bend_quantity(0.5, "pitch curvature of the spiral; positive: down, negative: up")
    first_pitch_bend: float = bend_quantity(0.2, "pitch curvature of the entry; positive: down, negative: up")
    entry_start: float = instant_quantity(1.0, "the entry begins; it lasts two entry times")
    entry_time: float = duration_quantity(1.0, "duration of each of the entry's ramps")


@dataclass(frozen=True, kw_only=True)
class Roll(Periodic):
    pitch_amplitude: float = bend_quantity(1.0, "amplitude in pitch")
    yaw_amplitude: float = bend_quantity(1.0, "amplitude in yaw")


@dataclass(frozen=True, kw_only=True)
class Helix(Periodic):
    wavelength: float = wavelength_quantity(1.0, "wavelength of the helix")
    pitch_amplitude: float = bend_quantity(1.5, "amplitude in pitch")
    yaw_amplitude: float = bend_quantity(1.5, "amplitude in yaw")


@dataclass(frozen=True, kw_only=True)
class RollOver(Periodic):
    bend: float = bend_quantity(0.3, "amplitude of the bend; positive: the left side goes up, negative: the right side")
    start_periods: float = quantity(3.0, "periods", "length of the start and of the end", 0.01, 1e3)
    hold_periods: float = quantity(1.1, "periods", "time between start and end", 0.0, 1e3)


@register(Dive)
def falling(numbers: Dive) -> tuple[Term, ...]:
    """The gait of section 7.2.2, eqs. (62) to (66): forward swimming and a dive to a greater depth."""
    return numbers.terms(1.0)


@register(Dive)
def rising(numbers: Dive) -> tuple[Term, ...]:
    """The falling gait upside down: forward swimming and a climb."""
    return numbers.terms(-1.0)


@register(Slope)
def diving(numbers: Slope) -> tuple[Term, ...]:
    """Forward swimming and one bend in pitch: the body then swims straight on down a slope."""
    ramps = Ramp(numbers.bend_start, numbers.bend_full, 1.0), Ramp(numbers.unbend_start, numbers.bend_end, -1.0)
    return (numbers.term(), *constant_bend("pitch", numbers.pitch_bend, ramps))


@register(Spiral)
def spiral(numbers: Spiral) -> tuple[Term, ...]:
    """A descent on a helix. Constant bends turn the body by the same screw motion in each period."""
    start, time = numbers.entry_start, numbers.entry_time
    middle, end = start + time, start + 2.0 * time
    lasting = (Ramp(middle, end, 1.0),)
    return (
        numbers.term().scaled(math.copysign(1.0, 0.0 - numbers.left_bend)),  # left and right are mirror images
        *constant_bend("pitch", numbers.first_pitch_bend, (Ramp(start, middle, 1.0), Ramp(middle, end, -1.0))),
        *left_turn(numbers.left_bend, lasting),
        *constant_bend("pitch", numbers.pitch_bend, lasting),
    )


@register(Roll)
def rolling(numbers: Roll) -> tuple[Term, ...]:
    """A body bent into an arc whose direction turns about the backbone.

    With amplitudes of one sign the left side goes down, with opposite signs the right side.
    """
    return _pair(numbers, wavelength=0.0)


@register(RollOver)
def roll_over(numbers: RollOver) -> tuple[Term, ...]:
    """Half a turn about the backbone: while a bend rotates about it, body and water rotate the other way."""
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
