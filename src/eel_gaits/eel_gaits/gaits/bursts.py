# SPDX-License-Identifier: Apache-2.0
"""Manoeuvres with a beginning and an end: the C-start of a fish that escapes, and swimming in bursts.

c_start: a bend B(t) of the whole body, positive to the left, and a wave: K3 = wave(t, X) - B(t). The body bends into a
C, and the wave begins while it straightens. The form, a bend plus a wave, is that of Gazzola, van Rees and
Koumoutsakos, J. Fluid Mech. 698 (2012), 5-18, doi:10.1017/jfm.2011.558. The numbers are our own, for a robot of 1 m.

burst_and_coast: the forward wave comes and goes; between two bursts the straight body coasts (Weihs, J. Theor. Biol. 48
(1974), 215-229, doi:10.1016/0022-5193(74)90192-1).
"""

from dataclasses import dataclass, replace

from eel_base.quantity import quantity

from eel_gaits.gaits.numbers import left_quantity, left_turn
from eel_gaits.gaits.registry import register
from eel_gaits.gaits.swimming import Wave
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term


def _duration(default: float, description: str) -> float:
    return quantity(default, "s", description, 1e-3, 1e4)


@dataclass(frozen=True, kw_only=True)
class Start(Wave):
    """A strong bend of the whole body, and the forward wave that follows it."""

    left_bend: float = left_quantity(-4.0, "yaw curvature of the C")
    bend_time: float = _duration(0.5, "time in which the body bends into the C")
    return_time: float = _duration(0.4, "time in which it straightens")


@dataclass(frozen=True, kw_only=True)
class Bursts(Wave):
    """The forward wave in bursts. Each begins and ends over `start_periods`."""

    bursts: float = quantity(20.0, "", "number of bursts", 1.0, 400.0, whole=True)
    burst_periods: float = quantity(1.0, "periods", "time at full amplitude in a burst", 0.0, 1e4)
    coast_time: float = _duration(3.0, "time of the straight body between two bursts")

    @property
    def cycle(self) -> float:
        """Time [s] from the beginning of one burst to that of the next."""
        return (2.0 * self.start_periods + self.burst_periods) * self.period + self.coast_time

    def envelope(self) -> tuple[Ramp, ...]:
        """The ramps of all bursts."""
        rise, full = self.start_periods * self.period, self.burst_periods * self.period
        starts = [index * self.cycle for index in range(int(self.bursts))]
        return tuple(
            ramp
            for start in starts
            for ramp in (
                Ramp(start, start + rise, 1.0),
                Ramp(start + rise + full, start + 2.0 * rise + full, -1.0),
            )
        )


@register(Start)
def c_start(numbers: Start) -> tuple[Term, ...]:
    """An escape from rest: the body bends into a C, straightens with a stroke, and swims away to that side."""
    ramps = (
        Ramp(0.0, numbers.bend_time, 1.0),
        Ramp(numbers.bend_time, numbers.bend_time + numbers.return_time, -1.0),
    )
    return (*left_turn(numbers.left_bend, ramps), numbers.term().delayed(numbers.bend_time))


@register(Bursts)
def burst_and_coast(numbers: Bursts) -> tuple[Term, ...]:
    """Forward swimming in bursts, with a straight body that coasts in between."""
    return (replace(numbers.term(), envelope=numbers.envelope()),)
