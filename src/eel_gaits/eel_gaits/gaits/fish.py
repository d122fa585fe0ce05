# SPDX-License-Identifier: Apache-2.0
"""Fish. By midline: the lateral displacement h(X, t) measured on fish, converted to a curvature (`laws.midline`).

    h(X, t) = a(X) sin(2 pi (waves X / L - t / T)),   X: arc length from the nose, L: body length

carangiform: a / L = a0 + a1 X / L + a2 (X / L)^2, of a mackerel, after Videler and Hess (1984); coefficients as in Dong
and Lu, Phys. Fluids 19 (2007), 057107, the wave as in Borazjani and Sotiropoulos, J. Exp. Biol. 211 (2008), 1541-1558,
doi:10.1242/jeb.015644.
anguilliform: a / L = a_tail exp(growth (X / L - 1)), of a lamprey; Borazjani and Sotiropoulos, J. Exp. Biol. 212
(2009), 576-592, doi:10.1242/jeb.025007, after Hultmark, Leftwich and Smits (2007).

By curvature: kern_fast and kern_efficient evolved in 3-D computations of a self-propelled eel (Kern and Koumoutsakos,
J. Exp. Biol. 209 (2006), 4841-4857, doi:10.1242/jeb.02526).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from eel_common.quantity import quantity

from eel_gaits.gaits.numbers import PeriodicBody, waves_quantity
from eel_gaits.gaits.registry import register
from eel_gaits.laws.midline import lateral_wave
from eel_gaits.laws.term import Term


def _lateral(default: float, description: str) -> float:
    return quantity(default, "L", description, -1.0, 1.0)


@dataclass(frozen=True, kw_only=True)
class Fish(PeriodicBody):
    """A wave of the midline, in body lengths."""

    waves: float = waves_quantity(1.0)

    def terms(self, amplitude: Callable[[np.ndarray], tuple[np.ndarray, ...]]) -> tuple[Term, ...]:
        """The terms of a midline. amplitude: function of X / L that returns a / L and its first two derivatives."""

        def scaled(x: np.ndarray) -> tuple[np.ndarray, ...]:
            a, slope, bend = amplitude(x / self.length)
            return a * self.length, slope, bend / self.length

        return lateral_wave(
            scaled,
            length=self.length,
            wavelength=self.length / self.waves,
            period=self.period,
            envelope=self.start,
        )


@dataclass(frozen=True, kw_only=True)
class Carangiform(Fish):
    waves: float = waves_quantity(1.0 / 0.95)
    lateral_0: float = _lateral(0.02, "lateral amplitude at the nose, a0")
    lateral_1: float = _lateral(-0.0825, "growth of the lateral amplitude with X / L, a1")
    lateral_2: float = _lateral(0.1625, "growth of the lateral amplitude with (X / L)^2, a2")


@dataclass(frozen=True, kw_only=True)
class Anguilliform(Fish):
    waves: float = waves_quantity(1.0 / 0.642)
    lateral_tail: float = _lateral(0.089, "lateral amplitude at the tail, a_tail")
    growth: float = quantity(1.0, "", "growth of the lateral amplitude, growth", -10.0, 10.0)


def _scaled_bend(default: float, place: str) -> float:
    return quantity(default, "rad", f"curvature times body length, K L, at {place}", -1e3, 1e3)


@dataclass(frozen=True, kw_only=True)
class Kern(PeriodicBody):
    """A wave whose amplitude is a natural cubic spline through four values of K L, at X = 0, L/3, 2L/3 and L."""

    waves: float = quantity(1.44, "", "waves on the body, tau", 0.0, 100.0)
    bend_nose: float = _scaled_bend(1.51, "the nose")
    bend_third: float = _scaled_bend(0.48, "one third of the body")
    bend_two_thirds: float = _scaled_bend(5.74, "two thirds of the body")
    bend_tail: float = _scaled_bend(2.73, "the tail")

    def term(self) -> Term:
        """The wave K(s) sin 2 pi (t/T - tau s/L), written as K(s) sin(2 pi (X/wavelength - t/T) + pi) with s = X."""
        length, scaled = self.length, (self.bend_nose, self.bend_third, self.bend_two_thirds, self.bend_tail)
        return Term(
            axis="yaw",
            amplitude=tuple(value / length for value in scaled),
            knots=(0.0, length / 3.0, 2.0 * length / 3.0, length),
            wavelength=length / self.waves if self.waves else 0.0,
            period=self.period,
            phase=math.pi,
            envelope=self.start,
        )


@dataclass(frozen=True, kw_only=True)
class EfficientKern(Kern):
    waves: float = quantity(1.72, "", "waves on the body, tau", 0.0, 100.0)
    bend_nose: float = _scaled_bend(3.34, "the nose")
    bend_third: float = _scaled_bend(1.67, "one third of the body")
    bend_two_thirds: float = _scaled_bend(2.0 * math.pi, "two thirds of the body")
    bend_tail: float = _scaled_bend(2.0 * math.pi, "the tail")


@register(Carangiform)
def carangiform(numbers: Carangiform) -> tuple[Term, ...]:
    """A mackerel: the lateral amplitude is small in front and grows towards the tail."""
    a = np.polynomial.Polynomial((numbers.lateral_0, numbers.lateral_1, numbers.lateral_2))
    return numbers.terms(lambda x: (a(x), a.deriv(1)(x), a.deriv(2)(x)))


@register(Anguilliform)
def anguilliform(numbers: Anguilliform) -> tuple[Term, ...]:
    """A lamprey or an eel: the whole body moves sideways, increasingly towards the tail."""

    def amplitude(x: np.ndarray) -> tuple[np.ndarray, ...]:
        a = numbers.lateral_tail * np.exp(numbers.growth * (x - 1.0))
        return a, numbers.growth * a, numbers.growth**2 * a

    return numbers.terms(amplitude)


@register(Kern)
def kern_fast(numbers: Kern) -> tuple[Term, ...]:
    """The gait that evolved for speed in 3-D computations of a self-propelled eel."""
    return (numbers.term(),)


@register(EfficientKern)
def kern_efficient(numbers: EfficientKern) -> tuple[Term, ...]:
    """The gait that evolved for efficiency in 3-D computations of a self-propelled eel."""
    return (numbers.term(),)
