# SPDX-License-Identifier: Apache-2.0
"""Numbers shared by several gaits, their smooth start from rest, and bends of the whole body.

A number with a side is positive to the left.
"""

import math
from dataclasses import dataclass

from eel_common.quantity import Quantities, quantity

from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term

TO_THE_LEFT = "; positive: to the left, negative: to the right"


@dataclass(frozen=True, kw_only=True)
class Periodic(Quantities):
    """A motion with a period, which starts smoothly from rest."""

    period: float = quantity(1.0, "s", "period T of the wave", 1e-3, 1e4)
    start_periods: float = quantity(
        1.0, "periods", "length of the smooth start from rest, in periods of the wave", 0.01, 1e3
    )

    @property
    def start(self) -> tuple[Ramp, ...]:
        """The envelope of the start from rest (eq. 63)."""
        return (Ramp(0.0, self.start_periods * self.period, 1.0),)


@dataclass(frozen=True, kw_only=True)
class PeriodicBody(Periodic):
    """A motion whose numbers are parts of the body's length."""

    length: float = quantity(1.0, "m", "body length L", 1e-4, 1e3)


def wavelength_quantity(default: float, description: str = "wavelength of the wave") -> float:
    return quantity(default, "m", description, 1e-4, 1e4)


def bend_quantity(default: float, description: str) -> float:
    return quantity(default, "rad/m", description, -1e5, 1e5)


def left_quantity(default: float, description: str) -> float:
    return bend_quantity(default, description + TO_THE_LEFT)


def duration_quantity(default: float, description: str) -> float:
    return quantity(default, "s", description, 1e-3, 1e4)


def instant_quantity(default: float, description: str, after: str = "") -> float:
    """A time of the law. after: the name of a number that it must exceed."""
    return quantity(default, "s", f"{description}, in the law's own time", 0.0, 1e6, after=after)


def waves_quantity(default: float) -> float:
    return quantity(default, "", "waves on the body, L / wavelength", 1e-3, 100.0)


def constant_bend(axis: str, bend: float, envelope: tuple[Ramp, ...]) -> tuple[Term, ...]:
    """The terms of a `bend` [rad/m] of the whole body about an `axis`, with an `envelope`. None where it is 0."""
    return (Term(axis=axis, amplitude=(bend,), phase=0.5 * math.pi, envelope=envelope),) if bend else ()


def left_turn(bend: float, envelope: tuple[Ramp, ...]) -> tuple[Term, ...]:
    """The terms of a `bend` [rad/m] to the left. A curvature K3 above 0 bends the tail to the right."""
    return constant_bend("yaw", -bend, envelope)
