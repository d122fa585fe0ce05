# SPDX-License-Identifier: Apache-2.0
"""The gaits that evolved in 3-D computations of a self-propelled eel.

Source: Kern and Koumoutsakos, J. Exp. Biol. 209 (2006), 4841-4857, doi:10.1242/jeb.02526.
"""

import math
from dataclasses import dataclass

from eel_base.quantity import quantity

from eel_gaits.gaits.numbers import PeriodicBody
from eel_gaits.gaits.registry import register
from eel_gaits.laws.term import Term


def _scaled_bend(default: float, place: str) -> float:
    description = f"curvature times body length, K L, at {place}"
    return quantity(default, "rad", description, -1e3, 1e3)


@dataclass(frozen=True, kw_only=True)
class Kern(PeriodicBody):
    """A wave whose amplitude is a natural cubic spline through four values of K L, at X = 0, L/3, 2L/3 and L."""

    waves: float = quantity(1.44, "", "waves on the body, tau", 0.0, 100.0)
    bend_nose: float = _scaled_bend(1.51, "the nose")
    bend_third: float = _scaled_bend(0.48, "one third of the body")
    bend_two_thirds: float = _scaled_bend(5.74, "two thirds of the body")
    bend_tail: float = _scaled_bend(2.73, "the tail")


@dataclass(frozen=True, kw_only=True)
class EfficientKern(Kern):
    """The numbers of `Kern` for the gait that was optimised for efficiency."""

    waves: float = quantity(1.72, "", "waves on the body, tau", 0.0, 100.0)
    bend_nose: float = _scaled_bend(3.34, "the nose")
    bend_third: float = _scaled_bend(1.67, "one third of the body")
    bend_two_thirds: float = _scaled_bend(2.0 * math.pi, "two thirds of the body")
    bend_tail: float = _scaled_bend(2.0 * math.pi, "the tail")


@register(Kern)
def kern_fast(numbers: Kern) -> tuple[Term, ...]:
    """The gait that evolved for speed in 3-D computations of a self-propelled eel."""
    return (_kern_term(numbers),)


@register(EfficientKern)
def kern_efficient(numbers: EfficientKern) -> tuple[Term, ...]:
    """The gait that evolved for efficiency in 3-D computations of a self-propelled eel."""
    return (_kern_term(numbers),)


def _kern_term(numbers: Kern) -> Term:
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
        envelope=numbers.start,
    )
