# SPDX-License-Identifier: Apache-2.0
"""Swimming in the horizontal plane: straight on, backward, in a turn, coasting, in bursts, and away from rest.

The wave: Boyer, Porez and Leroyer, J. Nonlinear Sci. 20 (2010), section 7.2.2, doi:10.1007/s00332-009-9050-5.

c_start: a bend B(t) of the whole body, positive to the left, and a wave: K3 = wave(t, X) - B(t). The body bends into a
C, and the wave begins while it straightens. A bend plus a wave is the form of Gazzola, van Rees and Koumoutsakos,
J. Fluid Mech. 698 (2012), 5-18, doi:10.1017/jfm.2011.558. The numbers are our own, for a robot of 1 m.

burst_and_coast: the forward wave starts and stops; between bursts the straight body coasts (Weihs, J. Theor. Biol. 48
(1974), 215-229, doi:10.1016/0022-5193(74)90192-1).
"""

from dataclasses import dataclass, replace

from eel_common.quantity import Quantities, quantity

from eel_gaits.gaits.numbers import (
    Periodic,
    bend_quantity,
    duration_quantity,
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
    """A travelling wave of amplitude a2 X^2 + a1 X + a0 (eq. 65). It starts smoothly over some periods (eq. 63)."""

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
    left_bend: float = left_quantity(-0.5, "yaw curvature of the turn")
    bend_start: float = instant_quantity(1.0, "the turn begins")
    bend_full: float = instant_quantity(2.0, "the bend of the turn is complete", after="bend_start")


@dataclass(frozen=True, kw_only=True)
class Start(Wave):
    left_bend: float = left_quantity(-4.0, "yaw curvature of the C")
    bend_time: float = duration_quantity(0.5, "time in which the body bends into the C")
    return_time: float = duration_quantity(0.4, "time in which it straightens")


@dataclass(frozen=True, kw_only=True)
class Bursts(Wave):
    """The forward wave in bursts. Each begins and ends over `start_periods`."""

    bursts: float = quantity(20.0, "", "number of bursts", 1.0, 400.0, whole=True)
    burst_periods: float = quantity(1.0, "periods", "time at full amplitude in a burst", 0.0, 1e4)
    coast_time: float = duration_quantity(3.0, "time of the straight body between two bursts")

    def envelope(self) -> tuple[Ramp, ...]:
        """The ramps of all bursts."""
        rise, full = self.start_periods * self.period, self.burst_periods * self.period
        cycle, ramps = (2.0 * self.start_periods + self.burst_periods) * self.period + self.coast_time, []
        for start in (index * cycle for index in range(int(self.bursts))):
            ramps.append(Ramp(start, start + rise, 1.0))
            ramps.append(Ramp(start + rise + full, start + 2.0 * rise + full, -1.0))
        return tuple(ramps)


@register(Quantities)
def still(numbers: Quantities) -> tuple[Term, ...]:
    """The straight body at rest in its shape. Use it to coast, or to push the body."""
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


@register(Start)
def c_start(numbers: Start) -> tuple[Term, ...]:
    """An escape from rest: the body bends into a C, straightens with a stroke, and swims away to that side."""
    time = numbers.bend_time
    ramps = Ramp(0.0, time, 1.0), Ramp(time, time + numbers.return_time, -1.0)
    return (*left_turn(numbers.left_bend, ramps), numbers.term().delayed(time))


@register(Bursts)
def burst_and_coast(numbers: Bursts) -> tuple[Term, ...]:
    """Forward swimming in bursts. In between, the body is straight and coasts."""
    return (replace(numbers.term(), envelope=numbers.envelope()),)
