# SPDX-License-Identifier: Apache-2.0
"""The time until a swimmer's gait has settled: the meaning of the duration "settled"."""

import math
from functools import lru_cache
from typing import Any

import numpy as np
from eel_common.wording import shown
from eel_gaits.laws.law import Law

from eel_dynamics.accuracy.accuracy import PRESETS, Accuracy
from eel_dynamics.analysis.analysis import STILL
from eel_dynamics.analysis.averaging_window import PLACES, common_period
from eel_dynamics.analysis.settling import FEWEST, SETTLED, settling_of
from eel_dynamics.simulation.march import March
from eel_dynamics.simulation.observations import Observations
from eel_dynamics.simulation.swimmer import Swimmer

UNTIL_SETTLED = "settled"  # as a duration
MOST_PERIODS = 100  # longest swim if it does not settle
MARGIN = 0.8  # of the change that counts as settled, as a more exact swim may differ
NO_WORK = 1e-6  # of the kinetic energy: a smaller net work per period counts as none


def until_settled(duration: object) -> bool:
    """Whether the `duration` is "settled"."""
    return isinstance(duration, str) and duration == UNTIL_SETTLED


def settling_time(swimmer: Swimmer) -> float:
    """Time [s], in whole periods, after which the gait of a `swimmer` has settled.

    The later half of that time is after the law's last ramp. Over its periods the mean speed and the mean power of the
    actuators change by at most `SETTLED`, and at most as much is still to come (`analysis.settling.settling_of`). Both
    are exact means of a swim with the error of the preset draft, or the swimmer's own if that is greater. A body at
    rest has settled. `MOST_PERIODS` if the gait does not settle within them, or if the swim stops. `ValueError` for a
    law without a period.
    """
    law: Any = swimmer.law
    period, last_ramp = period_of(law, swimmer.body.length), _last_ramp(law)
    coarse = swimmer.unchecked(accuracy=_coarse(swimmer.accuracy), stations=swimmer.x[:1])
    drift = swimmer.current * period  # m

    def settled(seen: Observations, done: np.ndarray) -> bool:
        """Whether the gait has settled after the `done` (n, 8) [J] works of n - 1 periods."""
        count = len(done) - 1
        window = (count + 1) // 2
        if window < FEWEST or (count - window) * period < last_ramp * (1.0 - 1e-9):
            return False
        lately = slice(count - window, count + 1)
        centre, work = seen.center_of_mass[lately], done[lately, 0]
        steps = centre[1:] - centre[:-1] - drift
        ways = [math.hypot(*step) for step in steps.tolist()]  # m, of the centre of mass in each period
        if max(ways) > STILL * swimmer.body.length and settling_of(ways).change > MARGIN * SETTLED:
            return False
        works = (work[1:] - work[:-1]).tolist()  # J, of the actuators
        little = max(map(abs, works)) <= NO_WORK * sum(seen.energies[count, :2].tolist())
        return not swimmer.scene.ledger or little or settling_of(works).change <= MARGIN * SETTLED

    times = period * np.arange(MOST_PERIODS + 1)
    _, _, done, stopped = March(coarse).record(times, False, False, enough=settled)
    return float(times[-1 if stopped else done - 1])


def period_of(law: Any, length: float) -> float:
    """The period [s] of `law` after its last ramp, on a body of `length` [m]. `ValueError` without one."""
    if not isinstance(law, Law):
        raise ValueError(f"duration {UNTIL_SETTLED!r} needs a Law, whose terms tell its period, got {shown(law)}")
    try:
        return _later_period(law, length)
    except ValueError as error:
        raise ValueError(f"duration {UNTIL_SETTLED!r} needs a gait that repeats: {error}") from None


@lru_cache(maxsize=1024)
def _later_period(law: Law, length: float) -> float:
    later = _last_ramp(law) + np.linspace(0.0, max((term.period for term in law.waves), default=0.0), 65)
    return common_period(law, np.linspace(0.0, length, PLACES), later)


def _last_ramp(law: Law) -> float:
    return max((ramp.end for term in law.terms for ramp in term.envelope), default=0.0)


def _coarse(accuracy: Accuracy) -> Accuracy:
    """The preset draft instead of a finer target; other settings are unchanged."""
    target = accuracy.target
    return Accuracy.of("draft") if target is not None and target < PRESETS["draft"] else accuracy
