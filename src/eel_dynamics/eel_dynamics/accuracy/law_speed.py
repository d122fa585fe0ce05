# SPDX-License-Identifier: Apache-2.0
"""The speed that a law gives to the sections of a body, from the strokes of its terms.

Strokes are root mean squares over the sections about the body's mean place, as if the body lay still.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import height_of
from eel_gaits.laws.term import amplitude_of

from eel_dynamics.accuracy.law_waves import groups_of

POINTS = 64  # along the body


class GroupMotion(NamedTuple):
    """Root mean square stroke [body lengths] of the terms of one group.

    time [s]: the period or, where the group moves `once`, the duration of a ramp.
    """

    stroke_rms: float
    time: float
    once: bool


def speed_of(law: Law, length: float) -> float:
    """Order of magnitude of the speed [m/s] that `law` gives to a body of `length` [m]."""
    return length * math.hypot(*(each.stroke_rms / each.time for each in motions_of(law, length)))


@lru_cache(maxsize=4096)
def motions_of(law: Law, length: float) -> tuple[GroupMotion, ...]:
    """Motions of the terms of `law` on a body of `length` [m], grouped by axis, period and envelope."""
    found = []
    for (_, period, envelope), terms in groups_of(law).items():
        stroke_rms = math.sqrt(0.5 * _moved(tuple(terms), period > 0.0, length)) / length * height_of(envelope)
        if period > 0.0:
            found.append(GroupMotion(2.0 * math.pi * stroke_rms, period, False))
        elif envelope:
            found.append(GroupMotion(2.0 * stroke_rms, min(ramp.end - ramp.start for ramp in envelope), True))
    return tuple(found)


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
