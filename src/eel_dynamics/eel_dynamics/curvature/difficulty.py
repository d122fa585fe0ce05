"""The difficulty of a swim. The errors of a run grow with the distance by which its law moves the sections.

At the same settings the error of the head's position grows with the path of the sections in the whole swim. This holds
up to some body lengths. Beyond, the head's path grows as well, and the error is relative to it. The error of the torque
grows with the stroke of the sections in one period. Both exponents were measured with laws of a tenth to twice the
nominal bends, at a third of to three times the nominal pace, in swims of 1 to 60 s. Stroke and path are in body
lengths. They are root mean squares over the sections about the body's mean place, as if the body lay still.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from eel_gaits.law import Law, Ramp, amplitude_of

from eel_dynamics.curvature.law_waves import groups_of

POINTS = 64  # along the body
STROKE_RMS, PATH_RMS = 0.37, 3.7  # body lengths, of the paper's gait in a period and in 10 s: the table's nominal swim
LONGEST = 60.0  # periods: in longer swims the error relative to the path no longer grows
EASIEST, HARDEST = 0.05, 1e3  # bounds of the error scale
# Exponents of error growth below nominal difficulty. Of the position with the path: by (drag, motion in a plane), for
# runs of the motion alone and with torque. Of the torque with the stroke.
PATH_POWERS = {
    (True, False): (1.0, 1.2),
    (True, True): (0.65, 0.9),
    (False, False): (0.75, 1.2),
    (False, True): (0.5, 1.0),
}
STROKE_POWER = 0.75
PATH_POWER_ABOVE, STROKE_POWER_ABOVE = 0.7, 0.3  # exponents above nominal difficulty
LEVELS = 12  # of the target scale, to a decade


class Difficulty(NamedTuple):
    """Root mean squares of the stroke in a period and of the path in the swim [body lengths]."""

    stroke_rms: float
    path_rms: float

    def at_least(self, other: "Difficulty") -> "Difficulty":
        """The difficulty with the greater stroke and the greater path of the two."""
        return Difficulty(max(self.stroke_rms, other.stroke_rms), max(self.path_rms, other.path_rms))

    def error_scale(self, drag: bool, torque: bool, plane: bool) -> float:
        """The error at the same settings, relative to that of the nominal swim.

        It is the error of the position or, with `torque`, the greater of the errors of position and torque. drag: the
        scene has drag. plane: the motion stays in a plane.
        """
        scale = _grown(self.path_rms / PATH_RMS, PATH_POWERS[drag, plane][torque], PATH_POWER_ABOVE)
        if torque:
            scale = max(scale, _grown(self.stroke_rms / STROKE_RMS, STROKE_POWER, STROKE_POWER_ABOVE))
        return min(max(scale, EASIEST), HARDEST) if scale == scale else HARDEST

    def target_scale(self, drag: bool, torque: bool, plane: bool) -> float:
        """Factor of the target in the look-up of its settings: 1/`error_scale`, rounded towards finer targets."""
        return 10.0 ** (math.floor(1e-9 - LEVELS * math.log10(self.error_scale(drag, torque, plane))) / LEVELS)


def _grown(ratio: float, below: float, above: float) -> float:
    """Growth of an error with the `ratio` to the nominal swim, by the exponents `below` and `above` 1."""
    return ratio ** (below if ratio < 1.0 else above)


NOMINAL = Difficulty(STROKE_RMS, PATH_RMS)


class GroupMotion(NamedTuple):
    """Root mean square stroke [body lengths] of the terms of one group.

    time [s]: the period or, where the group moves `once`, the duration of a ramp.
    """

    stroke_rms: float
    time: float
    once: bool


def difficulty_of(law: Law, length: float, duration: float) -> Difficulty:
    """The difficulty of a swim by `law`, for a body of `length` [m].

    duration [s]: of the swim, infinite where it is not known. A bend counts in every period of the waves, because it
    turns the swimmer as long as it lasts.
    """
    motions = motions_of(law, length)
    shortest = min((each.time for each in motions if not each.once), default=None)
    periods = max(1.0, min(duration / shortest, LONGEST)) if shortest else 1.0
    paths = [each.stroke_rms * min(duration / each.time, periods) for each in motions]
    return Difficulty(math.hypot(*(each.stroke_rms for each in motions)), math.hypot(*paths))


def speed_of(law: Law, length: float) -> float:
    """Order of magnitude of the speed [m/s] that `law` gives to a body of `length` [m]."""
    return length * math.hypot(*(each.stroke_rms / each.time for each in motions_of(law, length)))


@lru_cache(maxsize=4096)
def motions_of(law: Law, length: float) -> tuple[GroupMotion, ...]:
    """Motions of the terms of `law` on a body of `length` [m], grouped by axis, period and envelope."""
    found = []
    for (_, period, envelope), terms in groups_of(law).items():
        stroke_rms = math.sqrt(0.5 * _moved(tuple(terms), period > 0.0, length)) / length * _height(envelope)
        if period > 0.0:
            found.append(GroupMotion(2.0 * math.pi * stroke_rms, period, False))
        elif envelope:
            found.append(GroupMotion(2.0 * stroke_rms, min(ramp.end - ramp.start for ramp in envelope), True))
    return tuple(found)


def _height(envelope: tuple[Ramp, ...]) -> float:
    """Greatest value or change of an envelope."""
    level, heights = 0.0, [] if envelope else [1.0]
    for ramp in sorted(envelope, key=lambda ramp: ramp.end):
        level += ramp.delta
        heights += [abs(level), abs(ramp.delta)]
    return max(heights)


@lru_cache(maxsize=4096)
def _moved(waveforms: tuple, moving: bool, length: float) -> float:
    """Mean square [m^2] of the displacement of the sections about their mean place: of sine and cosine in time together
    where the `waveforms` are `moving`, else twice that of their sum."""
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
