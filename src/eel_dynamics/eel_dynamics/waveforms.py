"""What a law is along the body: its terms' waveforms, the waves that they bend it into, the knots of their splines."""

from functools import lru_cache

import numpy as np
from eel_gaits.law import Law, Term, amplitude_of

from .drive import AXES

PART_OF_PEAK = 0.75  # of the turns where all terms bend the body most
TURN_POINTS = 64  # along the body, for the angle that a law bends it by
MOST_KNOTS = 8  # of laws whose panels are cut at them


def groups_of(law: Law) -> dict:
    """Waveforms of the terms of `law` by what they have in common: axis, period [s] and envelope."""
    groups: dict = {}
    for term in law.terms:
        groups.setdefault((term.axis, term.period, term.envelope), []).append(waveform(term))
    return groups


def waveform(term: Term) -> tuple:
    """What a term is along the body: amplitude and its knots, wave number, phase."""
    return term.amplitude, term.knots, term.wave_number, term.phase


def waves_of_law(law: Law, length: float) -> float:
    """How many waves a law bends a body of `length` [m] into, at most; a spline counts an eighth of its intervals.

    A turn of the backbone is a wave too, as its direction goes once around: turns are counted by the term that turns it
    most, and by three quarters of what all do together where the body is bent most.
    """
    return _waves(tuple((term.axis, waveform(term)) for term in law.terms), length)


@lru_cache(maxsize=4096)
def _waves(waveforms: tuple, length: float) -> float:
    waves = [length * abs(wave_number) / (2.0 * np.pi) for _, (_, _, wave_number, _) in waveforms]
    waves += [(len(knots) - 1) / 8.0 for _, (_, knots, _, _) in waveforms]
    x = length * (np.arange(TURN_POINTS) + 0.5) / TURN_POINTS
    bends = [np.abs(amplitude_of(amplitude, knots, x)) for _, (amplitude, knots, _, _) in waveforms]
    together = np.zeros((2, TURN_POINTS))
    for (axis, _), bend in zip(waveforms, bends, strict=True):
        together[AXES[axis]] += bend
    turns = [*(np.mean(bend) for bend in bends), PART_OF_PEAK * np.max(np.hypot(*together))]
    return float(max(*waves, *(length / (2.0 * np.pi) * turn for turn in turns), 0.0))


def knots_of_law(law: Law) -> tuple[float, ...]:
    """X [m] inside the splines of `law`, where their third derivative jumps; none where there are many."""
    knots = sorted({knot for term in law.terms for knot in term.knots[1:-1]})
    return tuple(knots) if len(knots) <= MOST_KNOTS else ()
