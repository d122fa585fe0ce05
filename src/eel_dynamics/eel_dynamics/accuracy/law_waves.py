# SPDX-License-Identifier: Apache-2.0
"""A law along the body: the waveforms of its terms, its number of waves, and the knots of its splines."""

from functools import lru_cache

import numpy as np
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.laws.spline import natural_spline
from eel_gaits.laws.term import LAW_ROW, Term, amplitude_of
from eel_gaits.sources.sampled_law import SampledLaw

PART_OF_PEAK = 0.75  # of the turns at the strongest bend by all terms
TURN_POINTS = 64  # along the body, for the angle by which a law bends it
MOST_KNOTS = 8  # of laws whose knots become ends of panels
MOST_WAVES = 200.0  # on the body: five points each on the finest grid
WIGGLE_POINTS, WINDOW = 1024, 128  # along the body, for the turning points of an amplitude; size of a local window
# Part of the greatest amplitude: least rise or fall between two turns that count. Smaller waves move the
# body less, and the points for the others resolve most of them.
LEAST_WIGGLE = 1e-3
SHARPNESS, FEW_KNOTS = 1.5, 6  # factor for a spline's waves; most knots of a spline whose waves are not counted
MODES, LEFT_OUT = 128, 1e-3  # of rows: number of polynomials along the body, and part of the rows left out
SHORTEST_RAMP = 1e-9  # s, or relative to its end: time steps do not resolve a shorter ramp


def groups_of(law: Law) -> dict:
    """Waveforms of the terms of `law`, grouped by axis, period [s] and envelope."""
    groups: dict = {}
    for term in law.terms:
        groups.setdefault((term.axis, term.period, term.envelope), []).append(waveform(term))
    return groups


def waveform(term: Term) -> tuple:
    """The shape of a term along the body: amplitude and knots, wave number [rad/m], phase [rad]."""
    return term.amplitude, term.knots, term.wave_number, term.phase


@lru_cache(maxsize=4096)
def _waves(waveforms: tuple, length: float) -> float:
    """The largest number of waves into which terms (axis, waveform) bend a body of `length` [m].

    A spline counts as an eighth of its intervals. An amplitude counts as its own waves, where they are shortest. A full
    turn of the backbone is a wave too, because its direction goes once around. The turns are those of the strongest
    term, or three quarters of those of all terms together where the body is bent most.
    """
    waves = [length * abs(wave_number) / (2.0 * np.pi) for _, (_, _, wave_number, _) in waveforms]
    waves += [(len(knots) - 1) / 8.0 for _, (_, knots, _, _) in waveforms]
    waves += [_wiggles(amplitude, knots, length) for _, (amplitude, knots, _, _) in waveforms]
    x = length * (np.arange(TURN_POINTS) + 0.5) / TURN_POINTS
    bends = [np.abs(amplitude_of(amplitude, knots, x)) for _, (amplitude, knots, _, _) in waveforms]
    together = np.zeros((2, TURN_POINTS))
    for (axis, _), bend in zip(waveforms, bends, strict=True):
        together[LAW_ROW[axis]] += bend
    turns = [*(np.mean(bend) for bend in bends), PART_OF_PEAK * np.max(np.hypot(*together))]
    return float(max(*waves, *(length / (2.0 * np.pi) * turn for turn in turns), 0.0))


@lru_cache(maxsize=4096)
def _wiggles(amplitude: tuple, knots: tuple, length: float) -> float:
    """The number of waves of an amplitude itself on a body of `length` [m], from its turning points.

    It counts all except the smallest (`LEAST_WIGGLE`), or extrapolates from where they are closest. These waves are
    sharper than sines, so each counts as one and a half. A spline of few knots has none, because panels end at its
    knots.
    """
    if len(amplitude) <= 2 or 0 < len(knots) <= FEW_KNOTS:
        return 0.0
    turns = _turns(amplitude_of(amplitude, knots, np.linspace(0.0, length, WIGGLE_POINTS + 1)))
    turning = np.bincount(turns, minlength=WIGGLE_POINTS).cumsum()
    closest = np.max(turning[WINDOW:] - turning[:-WINDOW])
    return SHARPNESS * 0.5 * max(int(turning[-1]), (int(closest) - 1) * WIGGLE_POINTS // WINDOW)


def _turns(values: np.ndarray) -> list[int]:
    """Indices of the values at their turning points, after changes of `LEAST_WIGGLE` or more."""
    steps, least = np.diff(values), LEAST_WIGGLE * np.max(np.abs(values))
    kept = [0]  # the start, the turns, and the farthest point since the last
    for index in [*(np.flatnonzero(np.diff(np.sign(steps))) + 1), len(steps)]:
        rise = values[index] - values[kept[-1]]
        if len(kept) > 1 and rise * (values[kept[-1]] - values[kept[-2]]) >= 0.0:
            kept[-1] = index
        elif abs(rise) > least:
            kept.append(index)
    return [int(index) for index in kept[1:-1]]


@lru_cache(maxsize=1024)
def check_law(law: Law, length: float) -> float:
    """The number of waves of `law` on a body of `length` [m].

    `ValueError` for a law with more waves than any grid can resolve, or with a ramp as short as a jump.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        waves = _waves(tuple((term.axis, waveform(term)) for term in law.terms), length)
    if not waves <= MOST_WAVES:
        raise ValueError(
            f"law {shown(law.name)} bends the body into {waves:.3g} waves or turns: at most {MOST_WAVES:g} can be "
            "resolved"
        )
    for ramp in (ramp for term in law.terms for ramp in term.envelope):
        least = SHORTEST_RAMP * max(1.0, abs(ramp.end))
        if ramp.end - ramp.start < least:
            raise ValueError(
                f"law {shown(law.name)} has a ramp at {ramp.start:g} s of {ramp.end - ramp.start:.3g} s: at least "
                f"{least:.3g} s can be resolved"
            )
    return waves


@lru_cache(maxsize=64)
def waves_of_rows(law: SampledLaw) -> float:
    """The number of waves on the body of a law's rows, from the degree of the polynomials in X that represent all but
    `LEFT_OUT` of them. A wave of w wavelengths needs about the degree pi w + 3."""
    points, weights = np.polynomial.legendre.leggauss(MODES)
    x = 0.5 * law.length * (points + 1.0)
    modes = np.polynomial.legendre.legvander(points, MODES - 1) * np.sqrt(np.arange(MODES) + 0.5)
    of_rows = natural_spline(law.x, np.eye(len(law.x)), x) @ (weights[:, None] * modes)
    power = (law.values[:, :, 0].reshape(-1, len(law.x)) @ of_rows) ** 2
    left = np.max(np.cumsum(power[:, ::-1], axis=1), axis=0)[::-1]  # of each mode and the higher ones, in any row
    return max(1.0, (int(np.count_nonzero(left > LEFT_OUT**2 * left[0])) - 4) / np.pi)


def knots_of_law(law: Law) -> tuple[float, ...]:
    """Inner knots X [m] of the splines of `law`, where third derivatives jump. None of them if they are many."""
    knots = sorted({knot for term in law.terms for knot in term.knots[1:-1]})
    return tuple(knots) if len(knots) <= MOST_KNOTS else ()
