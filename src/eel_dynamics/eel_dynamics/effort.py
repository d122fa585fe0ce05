"""How much a law has a body do: what the errors of a swim grow with.

At the same settings the error of the head's position grows with the way that the shape moves the sections by in the
whole swim (up to some body lengths: beyond, the head's path, which it is taken by, grows as well), and that of the
torque with the stroke, what it moves them by in a period: measured over laws of a tenth of the usual bends to twice
these, at a third of the usual pace to three times that, swum for 1 to 60 s. Both count in body lengths, as root mean
squares over the sections, about the body's mean place, as if it lay still.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from eel_gaits.law import Law, Ramp, amplitude_of

from .waveforms import groups_of

POINTS = 64  # along the body
STROKE, WAY = 0.37, 3.7  # body lengths, of the paper's gait in a period and in 10 s: what the table of targets is for
LONGEST = 60.0  # periods: in longer swims the error by the path no longer grows
EASIEST, HARDEST = 0.05, 1e3  # by which settings are made looser and finer
# powers that errors grow with up to the usual: of position with the way, with drag and without, in space and in the
# plane, in runs of the motion alone and with torque; and of torque with the stroke
POWERS = {(True, False): (1.0, 1.2), (True, True): (0.65, 0.9), (False, False): (0.75, 1.2), (False, True): (0.5, 1.0)}
OF_STROKE = 0.75
FURTHER, FIERCER = 0.7, 0.3  # the same of way and stroke beyond the usual
LEVELS = 12  # of difficulty, to a decade


class Effort(NamedTuple):
    """`stroke` by period and `way` in the swim [body lengths]."""

    stroke: float
    way: float

    def at_least(self, other: "Effort") -> "Effort":
        """The greater of either."""
        return Effort(max(self.stroke, other.stroke), max(self.way, other.way))

    def difficulty(self, drag: bool, torque: bool, plane: bool) -> float:
        """By what factor errors are those of the usual swim: of position or, with `torque`, of either; with `drag`, in
        a `plane`."""
        hard = _grown(self.way / WAY, POWERS[drag, plane][torque], FURTHER)
        hard = max(hard, _grown(self.stroke / STROKE, OF_STROKE, FIERCER)) if torque else hard
        return min(max(hard, EASIEST), HARDEST) if hard == hard else HARDEST

    def ease(self, drag: bool, torque: bool, plane: bool) -> float:
        """What a target is multiplied with to find its settings: one by the difficulty, rounded to what is harder."""
        return 10.0 ** (math.floor(1e-9 - LEVELS * math.log10(self.difficulty(drag, torque, plane))) / LEVELS)


def _grown(effort: float, up_to: float, beyond: float) -> float:
    """What an error is by that of an `effort` of 1, by its powers `up_to` that and `beyond`."""
    return effort ** (up_to if effort < 1.0 else beyond)


USUAL = Effort(STROKE, WAY)


class Motion(NamedTuple):
    """What the terms of a law that go together do: `stroke` [body lengths] in the `time` [s] of a period, or once, in
    that of a ramp."""

    stroke: float
    time: float
    once: bool


def effort_of(law: Law, length: float, duration: float) -> Effort:
    """Of `law` for a body of `length` [m] that swims for `duration` [s], infinite where nobody knows how long. A bend
    counts in every period of the waves: it turns the swimmer for as long as it is there."""
    motions = motions_of(law, length)
    shortest = min((each.time for each in motions if not each.once), default=None)
    periods = max(1.0, min(duration / shortest, LONGEST)) if shortest else 1.0
    ways = [each.stroke * min(duration / each.time, periods) for each in motions]
    return Effort(math.hypot(*(each.stroke for each in motions)), math.hypot(*ways))


def speed_of(law: Law, length: float) -> float:
    """Speed [m/s] that the shape gives to a body of `length` [m], of the order of."""
    return length * math.hypot(*(each.stroke / each.time for each in motions_of(law, length)))


@lru_cache(maxsize=4096)
def motions_of(law: Law, length: float) -> tuple[Motion, ...]:
    """What the terms of `law` do, of equal axis, period and envelope together."""
    found = []
    for (_, period, envelope), terms in groups_of(law).items():
        stroke = math.sqrt(0.5 * _moved(tuple(terms), period > 0.0, length)) / length * _height(envelope)
        if period > 0.0:
            found.append(Motion(2.0 * math.pi * stroke, period, False))
        elif envelope:
            found.append(Motion(2.0 * stroke, min(ramp.end - ramp.start for ramp in envelope), True))
    return tuple(found)


def _height(envelope: tuple[Ramp, ...]) -> float:
    """The greatest value of an envelope, or change of it."""
    level, heights = 0.0, [] if envelope else [1.0]
    for ramp in sorted(envelope, key=lambda ramp: ramp.end):
        level += ramp.delta
        heights += [abs(level), abs(ramp.delta)]
    return max(heights)


@lru_cache(maxsize=4096)
def _moved(waveforms: tuple, moving: bool, length: float) -> float:
    """Mean square [m^2] of what `waveforms` move the sections by, about their mean place; of sine and cosine in time
    together where they are `moving`, else twice that of their sum."""
    x = length * (np.arange(POINTS) + 0.5) / POINTS
    with np.errstate(over="ignore", invalid="ignore"):
        bends = np.zeros((2, POINTS))
        for amplitude, knots, wave_number, phase in waveforms:
            angle = wave_number * x + phase
            bends += amplitude_of(amplitude, knots, x) * np.stack((np.sin(angle), np.cos(angle)))
        offset = np.cumsum(np.cumsum(bends, axis=1), axis=1) * (length / POINTS) ** 2
        offset -= offset.mean(axis=1, keepdims=True)
        sine, cosine = (offset**2).mean(axis=1).tolist()
    return sine + (cosine if moving else sine)
