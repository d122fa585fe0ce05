# SPDX-License-Identifier: Apache-2.0
"""Swims that begin at their final speed, so that a few periods show the steady state."""

from typing import Any

import numpy as np
from eel_dynamics.analysis.averaging_window import common_period

from eel_gaits import Law
from eel_studies.points import Numbers, law_of_terms

SAMPLES = 16  # per period


def swim_times(law: Law, length: float, periods: int) -> dict[str, Any]:
    """Duration and sample period [s] of a swim of so many `periods` of `law`. Samples divide the period evenly.

    length: of the body [m]. `ValueError` for a law without terms or without a period.
    """
    longest = max((term.period for term in law_of_terms(law).terms), default=0.0)
    ends = [ramp.end for term in law.terms for ramp in term.envelope]
    period = common_period(law, np.linspace(0.0, length, 11), np.linspace(0.0, max([longest, *ends]), 65))
    return {"duration": periods * period, "sample_period": period / SAMPLES}


def at_speed(numbers: Numbers, speed: float) -> Numbers:
    """The `numbers` with a start at `speed` [m/s] ahead, unless they have a velocity already."""
    return {"initial.v_x": speed} | numbers
