# SPDX-License-Identifier: Apache-2.0
"""Swimming in the horizontal plane: straight on, backward, in a turn, and coasting.

Source: Boyer, Porez and Leroyer, J. Nonlinear Sci. 20 (2010), section 7.2.2,
doi:10.1007/s00332-009-9050-5.
"""

from dataclasses import dataclass

from eel_base.quantity import Quantities, quantity

from eel_gaits.gaits.numbers import (
    Periodic,
    bend_quantity,
    instant_quantity,
    left_quantity,
    left_turn,
    wavelength_quantity,
)
from eel_gaits.gaits.registry import register
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term


@dataclass(frozen=True, kw_only=True)
class Wave(Periodic):
    """A travelling wave of the amplitude a2 X^2 + a1 X + a0 (eq. 65). It starts smoothly over some periods (eq. 63)."""

    wavelength: float = wavelength_quantity(1.0)
    amplitude_0: float = bend_quantity(1.0, "amplitude of the wave at the nose, a0")
    amplitude_1: float = quantity(0.5, "rad/m^2", "growth of the amplitude with X, a1", -1e8, 1e8)
    amplitude_2: float = quantity(2.0, "rad/m^3", "growth of the amplitude with X^2, a2", -1e11, 1e11)

    def term(self, direction: float = 1.0) -> Term:
        """The yaw wave. It runs to the tail (direction 1) or to the head (-1)."""
        return Term(
            axis="yaw",
            amplitude=(self.amplitude_0, self.amplitude_1, self.amplitude_2),
            wavelength=direction * self.wavelength,
            period=self.period,
            envelope=self.start,
        )


@dataclass(frozen=True, kw_only=True)
class TurningWave(Wave):
    """The forward wave with a lasting bend in yaw."""

    left_bend: float = left_quantity(-0.5, "yaw curvature of the turn")
    bend_start: float = instant_quantity(1.0, "the turn begins")
    bend_full: float = instant_quantity(2.0, "the bend of the turn is complete", after="bend_start")


@register(Quantities)
def still(numbers: Quantities) -> tuple[Term, ...]:
    """The straight body, whose shape does not move. Use it to coast, or to push the body."""
    return ()


@register(Wave)
def straight(numbers: Wave) -> tuple[Term, ...]:
    """Forward swimming: the yaw wave of eqs. (63) and (65), from head to tail."""
    return (numbers.term(),)


@register(Wave)
def backward(numbers: Wave) -> tuple[Term, ...]:
    """Backward swimming: the same wave, from tail to head."""
    return (numbers.term(direction=-1.0),)


@register(TurningWave)
def turning(numbers: TurningWave) -> tuple[Term, ...]:
    """Forward swimming with a lasting bend in yaw."""
    ramp = Ramp(numbers.bend_start, numbers.bend_full, 1.0)
    return (numbers.term(), *left_turn(numbers.left_bend, (ramp,)))
