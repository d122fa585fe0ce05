# SPDX-License-Identifier: Apache-2.0
"""The samples of a run: their times, and whether they fit into memory."""

import math
import os
from collections.abc import Iterable
from typing import Any

import numpy as np
from eel_common.quantity import is_finite, number, positive
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.simulation.observations import places_of

MOST_SAMPLES = 10_000_000  # of a run: the motion alone takes gigabytes
SAMPLE_PERIOD = 0.05  # s, for gaits with a period of 1 s or more
SAMPLES_OF_PERIOD = 20  # default number per shortest period of the law
ALIKE = 0.99  # tolerance, as a period found from rows is not exact
MOST_DEFAULT_SAMPLES = 20_000  # of a run whose sample period follows from the law
MOST_MEMORY = 0.8  # share of the machine's memory for the samples


def default_sample_period(laws: Iterable[Law | SampledLaw], duration: Any) -> float:
    """The default sample period [s]: `SAMPLE_PERIOD`, or fine enough to analyse the fastest of `laws`.

    Finer ones divide the `duration`, and none is longer than it. By default a run has at most `MOST_DEFAULT_SAMPLES`.
    """
    shortest = min((term.period for law in laws for term in law.waves), default=np.inf)
    fine = shortest / SAMPLES_OF_PERIOD
    if fine >= ALIKE * SAMPLE_PERIOD or not is_finite(duration) or not 0.0 < duration <= MOST_DEFAULT_SAMPLES * fine:
        return min(SAMPLE_PERIOD, duration) if is_finite(duration) and duration > 0.0 else SAMPLE_PERIOD
    return float(duration / math.ceil(duration / fine - 1e-9))


def checked_times(duration: Any, sample_period: Any) -> np.ndarray:
    """Times (T,) [s] of the samples, the multiples of `sample_period` [s] up to `duration` [s].

    `ValueError` for a bad duration or period, for a period above the duration, or for more than `MOST_SAMPLES`.
    """
    duration = number("duration", duration, "s", minimum=0.0)
    sample_period = positive("sample_period", sample_period, "s")
    steps = duration / sample_period + 1e-9
    if duration > 0.0 and steps < 1.0:
        raise ValueError(f"sample_period must be at most the duration of {duration:g} s, got {sample_period:g} s")
    if not steps < MOST_SAMPLES:
        raise ValueError(
            f"duration must be at most {MOST_SAMPLES:,} samples of sample_period, got {duration:g} s at "
            f"{sample_period:g} s: {steps:.4g} samples"
        )
    return np.asarray(np.arange(int(steps) + 1) * sample_period)


def check_memory(swimmers: int, samples: int, stations: int, wrench: bool, load: bool, runs: int = 1) -> None:
    """`ValueError` if the profiles of so many `runs` of each swimmer would not fit into memory."""
    needed = 8.0 * runs * swimmers * places_of(samples, stations, wrench, load)[1]
    there = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") * MOST_MEMORY
    if needed > there:
        raise ValueError(
            f"stations must be fewer (or samples, or swimmers): {swimmers} swimmer{'s' if swimmers > 1 else ''} of "
            f"{samples} samples at {stations} stations take {needed / 1e9:.3g} GB, of {there / 1e9:.3g} GB"
        )
