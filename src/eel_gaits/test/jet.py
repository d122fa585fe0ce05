# SPDX-License-Identifier: Apache-2.0
"""Second-order automatic differentiation: a value with its first and second time derivative, exact to round-off."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Jet:
    __array_ufunc__ = None  # so that array * jet is a jet

    value: object
    rate: object = 0.0
    acceleration: object = 0.0

    @staticmethod
    def of(thing):
        return thing if isinstance(thing, Jet) else Jet(thing)

    def __add__(self, other):
        other = Jet.of(other)
        return Jet(self.value + other.value, self.rate + other.rate, self.acceleration + other.acceleration)

    def __mul__(self, other):
        other = Jet.of(other)
        return Jet(
            self.value * other.value,
            self.rate * other.value + self.value * other.rate,
            self.acceleration * other.value + 2.0 * self.rate * other.rate + self.value * other.acceleration,
        )

    __radd__ = __add__
    __rmul__ = __mul__

    def __sub__(self, other):
        return self + Jet.of(other) * -1.0

    def __rsub__(self, other):
        return Jet.of(other) + self * -1.0

    def sin(self):
        sine, cosine = np.sin(self.value), np.cos(self.value)
        return Jet(sine, cosine * self.rate, cosine * self.acceleration - sine * self.rate**2)
