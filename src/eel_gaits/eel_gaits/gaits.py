# SPDX-License-Identifier: Apache-2.0
"""Gaits by name. A gait is a function that makes a `Law` from a few numbers. Each gait starts from rest.

The numbers of a gait are the fields of a frozen dataclass. Each has a unit, a default, bounds and a description.

    falling()                         # the paper's gait
    falling(period=2.0)               # with one number changed
    gait("turning", yaw_bend=-0.5)    # by name

Sources: falling, rising, straight and turning after Boyer, Porez and Leroyer, J. Nonlinear Sci. 20 (2010), section
7.2.2, doi:10.1007/s00332-009-9050-5; kern_fast and kern_efficient after Kern and Koumoutsakos, J. Exp. Biol. 209
(2006), 4841-4857, doi:10.1242/jeb.02526.
"""

import math
from dataclasses import dataclass

from eel_gaits.law import Ramp, Term
from eel_gaits.quantity import Quantities, quantity
from eel_gaits.registry import register


def _period(default):
    return quantity(default, unit="s", description="period T of the wave", minimum=1e-3, maximum=1e4)


def _start_periods():
    description = "length of the smooth start from rest, in periods of the wave"
    return quantity(1.0, unit="periods", description=description, minimum=0.01, maximum=1e3)


def _bend(default, description):
    return quantity(default, unit="rad/m", description=description, minimum=-1e5, maximum=1e5)


def _instant(default, description):
    return quantity(default, unit="s", description=description + ", in the law's own time", minimum=0.0, maximum=1e6)


@dataclass(frozen=True, kw_only=True)
class Wave(Quantities):
    """A travelling wave of the amplitude a2 X^2 + a1 X + a0 (eq. 65). It starts smoothly over some periods (eq. 63)."""

    period: float = _period(1.0)
    wavelength: float = quantity(1.0, unit="m", description="wavelength of the wave", minimum=1e-4, maximum=1e4)
    amplitude_0: float = _bend(1.0, "amplitude of the wave at the nose, a0")
    amplitude_1: float = quantity(
        0.5, unit="rad/m^2", description="growth of the amplitude with X, a1", minimum=-1e8, maximum=1e8
    )
    amplitude_2: float = quantity(
        2.0, unit="rad/m^3", description="growth of the amplitude with X^2, a2", minimum=-1e11, maximum=1e11
    )
    start_periods: float = _start_periods()

    def term(self, direction=1.0):
        """The yaw wave. It runs to the tail (direction 1) or to the head (-1)."""
        return Term(
            axis="yaw",
            amplitude=(self.amplitude_0, self.amplitude_1, self.amplitude_2),
            wavelength=direction * self.wavelength,
            period=self.period,
            envelope=_start(self),
        )


@dataclass(frozen=True, kw_only=True)
class Dive(Wave):
    """The forward wave with a bend in pitch, first one way and later the other: gamma(t) of eq. (66)."""

    pitch_bend: float = _bend(0.5, "pitch curvature of the dive, K_c2")
    bend_start: float = _instant(1.0, "the bend begins, t1")
    bend_full: float = _instant(2.0, "the bend is complete, t2")
    bend_end: float = _instant(3.0, "the body is straight in pitch again, t3")
    counter_start: float = _instant(6.0, "the opposite bend begins, t4")
    counter_full: float = _instant(7.0, "the opposite bend is complete, t5")
    counter_end: float = _instant(8.0, "the body is straight in pitch for good, t6")

    def __post_init__(self):
        super().__post_init__()
        for earlier, later in (
            ("bend_start", "bend_full"),
            ("bend_full", "bend_end"),
            ("counter_start", "counter_full"),
            ("counter_full", "counter_end"),
        ):
            _check_order(self, earlier, later)

    def bend(self, direction):
        """The pitch term. It first bends the tail down (direction 1) or up (-1)."""
        return Term(
            axis="pitch",
            amplitude=(direction * self.pitch_bend,),
            phase=math.pi / 2.0,
            envelope=(
                Ramp(self.bend_start, self.bend_full, 1.0),
                Ramp(self.bend_full, self.bend_end, -1.0),
                Ramp(self.counter_start, self.counter_full, -1.0),
                Ramp(self.counter_full, self.counter_end, 1.0),
            ),
        )


@dataclass(frozen=True, kw_only=True)
class Turn(Wave):
    """The forward wave with a lasting bend in yaw."""

    yaw_bend: float = _bend(0.5, "yaw curvature of the turn; positive: to the right, negative: to the left")
    bend_start: float = _instant(1.0, "the turn begins")
    bend_full: float = _instant(2.0, "the bend of the turn is complete")

    def __post_init__(self):
        super().__post_init__()
        _check_order(self, "bend_start", "bend_full")


@dataclass(frozen=True, kw_only=True)
class Roll(Quantities):
    """A bend of the whole body whose direction turns about the backbone."""

    period: float = _period(1.0)
    pitch_amplitude: float = _bend(1.0, "amplitude in pitch")
    yaw_amplitude: float = _bend(1.0, "amplitude in yaw")
    start_periods: float = _start_periods()


@dataclass(frozen=True, kw_only=True)
class Helix(Quantities):
    """Equal waves in pitch and yaw, a quarter of a period apart: a corkscrew that runs to the tail."""

    period: float = _period(1.0)
    wavelength: float = quantity(1.0, unit="m", description="wavelength of the helix", minimum=1e-4, maximum=1e4)
    pitch_amplitude: float = _bend(1.5, "amplitude in pitch")
    yaw_amplitude: float = _bend(1.5, "amplitude in yaw")
    start_periods: float = _start_periods()


def _scaled_bend(default, place):
    description = f"curvature times body length, K L, at {place}"
    return quantity(default, unit="rad", description=description, minimum=-1e3, maximum=1e3)


@dataclass(frozen=True, kw_only=True)
class Kern(Quantities):
    """A wave whose amplitude is a natural cubic spline through four values of K L, at X = 0, L/3, 2L/3 and L."""

    length: float = quantity(1.0, unit="m", description="body length L", minimum=1e-4, maximum=1e3)
    period: float = _period(1.0)
    waves: float = quantity(1.44, unit="", description="waves on the body, tau", minimum=0.0, maximum=100.0)
    bend_nose: float = _scaled_bend(1.51, "the nose")
    bend_third: float = _scaled_bend(0.48, "one third of the body")
    bend_two_thirds: float = _scaled_bend(5.74, "two thirds of the body")
    bend_tail: float = _scaled_bend(2.73, "the tail")
    start_periods: float = _start_periods()


@dataclass(frozen=True, kw_only=True)
class EfficientKern(Kern):
    """The numbers of `Kern` for the gait that was optimised for efficiency."""

    waves: float = quantity(1.72, unit="", description="waves on the body, tau", minimum=0.0, maximum=100.0)
    bend_nose: float = _scaled_bend(3.34, "the nose")
    bend_third: float = _scaled_bend(1.67, "one third of the body")
    bend_two_thirds: float = _scaled_bend(2.0 * math.pi, "two thirds of the body")
    bend_tail: float = _scaled_bend(2.0 * math.pi, "the tail")


@register(Quantities)
def still(numbers):
    """The straight body, whose shape does not move. Use it to coast, or to push the body."""
    return ()


@register(Wave)
def straight(numbers):
    """Forward swimming: the yaw wave of eqs. (63) and (65), from head to tail."""
    return (numbers.term(),)


@register(Wave)
def backward(numbers):
    """Backward swimming: the same wave, from tail to head."""
    return (numbers.term(direction=-1.0),)


@register(Turn)
def turning(numbers):
    """Forward swimming with a lasting bend in yaw."""
    ramp = Ramp(numbers.bend_start, numbers.bend_full, 1.0)
    bend = Term(axis="yaw", amplitude=(numbers.yaw_bend,), phase=math.pi / 2.0, envelope=(ramp,))
    return (numbers.term(), bend)


@register(Dive)
def falling(numbers):
    """The gait of section 7.2.2, eqs. (62) to (66): forward swimming and a dive to a greater depth."""
    return (numbers.term(), numbers.bend(1.0))


@register(Dive)
def rising(numbers):
    """The falling gait upside down: forward swimming and a climb."""
    return (numbers.term(), numbers.bend(-1.0))


@register(Roll)
def rolling(numbers):
    """A body bent into an arc whose direction turns about the backbone."""
    return _pair(numbers, wavelength=0.0)


@register(Helix)
def helix(numbers):
    """A corkscrew: equal waves in pitch and yaw, a quarter of a period apart."""
    return _pair(numbers, wavelength=numbers.wavelength)


@register(Kern)
def kern_fast(numbers):
    """The gait that evolved for speed in 3-D computations of a self-propelled eel."""
    return (_kern_term(numbers),)


@register(EfficientKern)
def kern_efficient(numbers):
    """The gait that evolved for efficiency in 3-D computations of a self-propelled eel."""
    return (_kern_term(numbers),)


def _start(numbers):
    return (Ramp(0.0, numbers.start_periods * numbers.period, 1.0),)


def _check_order(numbers, earlier, later):
    before, after = getattr(numbers, earlier), getattr(numbers, later)
    if not after > before:
        raise ValueError(f"{later} must be > {earlier} ({before:g} s), got {after}")


def _pair(numbers, *, wavelength):
    shared = {"wavelength": wavelength, "period": numbers.period, "envelope": _start(numbers)}
    return (
        Term(axis="pitch", amplitude=(numbers.pitch_amplitude,), phase=math.pi / 2.0, **shared),
        Term(axis="yaw", amplitude=(numbers.yaw_amplitude,), **shared),
    )


def _kern_term(numbers):
    """The wave K(s) sin 2 pi (t/T - tau s/L), written as K(s) sin(2 pi (X/wavelength - t/T) + pi) with s = X."""
    length = numbers.length
    scaled = (numbers.bend_nose, numbers.bend_third, numbers.bend_two_thirds, numbers.bend_tail)
    return Term(
        axis="yaw",
        amplitude=tuple(value / length for value in scaled),
        knots=(0.0, length / 3.0, 2.0 * length / 3.0, length),
        wavelength=length / numbers.waves if numbers.waves else 0.0,
        period=numbers.period,
        phase=math.pi,
        envelope=_start(numbers),
    )
