# SPDX-License-Identifier: Apache-2.0
"""The speed of a body's sections under a law, from the strokes of its terms.

Strokes are root mean squares over the sections about the body's mean place, as if the body lay still.
"""

import math
from functools import lru_cache

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import height_of
from eel_gaits.laws.term import amplitude_of

from eel_dynamics.accuracy.law_waves import groups_of

POINTS = 64  # along the body


@lru_cache(maxsize=4096)
def speed_of(law: Law, length: float) -> float:
    """Order of magnitude of the speed [m/s] of a body of `length` [m] under `law`."""
    speeds = []  # body lengths per second, of all terms of one axis, period and envelope
    for (_, period, envelope), terms in groups_of(law).items():
        stroke = math.sqrt(0.5 * _moved(tuple(terms), period > 0.0, length)) / length * height_of(envelope)
        if period > 0.0:
            speeds.append(2.0 * math.pi * stroke / period)
        elif envelope:  # once, while a ramp lasts
            speeds.append(2.0 * stroke / min(ramp.end - ramp.start for ramp in envelope))
    return length * math.hypot(*speeds)


@lru_cache(maxsize=4096)
def _moved(waveforms: tuple, moving: bool, length: float) -> float:
    """Mean square [m^2] of the displacement of the sections about their mean place: sum of sine and cosine in time if
    the `waveforms` are `moving`, otherwise twice the square of their sum."""
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
