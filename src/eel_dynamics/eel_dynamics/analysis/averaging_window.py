# SPDX-License-Identifier: Apache-2.0
"""The averaging window of a run: whole periods of its gait.

Samples are interpolated by cubic splines, so a window need not begin or end at a sample. Positions are relative to the
water: a current is subtracted.
"""

import math
from typing import Any

import numpy as np
from eel_common.cached import cached_property
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.laws.term import Term
from eel_gaits.sources.sampled_law import SampledLaw

LONGEST_COMMON = 12  # of the strongest wave's periods: the whole gait must repeat within them
FEWEST_SAMPLES = 8  # per period
WHOLE = 1e-4  # part of a period that may be missing, as the period of measured rows is not exact
PLACES = 33  # along the body, for the strength of a wave
FINE = 64  # points per period for a path or its width


def strength(term: Term, x: np.ndarray, time: np.ndarray) -> float:
    """Greatest curvature [rad/m] of `term` over the stations `x` [m] and the instants `time` [s]."""
    return float(np.max(np.abs(term.amplitude_at(x))) * np.max(np.abs(term.envelope_at(time)[0])))


def by_strength(law: Law | SampledLaw, x: np.ndarray, time: np.ndarray) -> list[tuple[Term, float]]:
    """The periodic terms of `law` and their greatest curvatures [rad/m], the strongest first.

    Yaw comes before pitch at any strength, and terms without effect come last. x (M,) [m] and time (T,) [s]: places and
    times at which strength is measured; a single term needs none.
    """
    if len(law.waves) == 1:
        return [(law.waves[0], math.inf)]
    found = [(term, strength(term, x, time)) for term in law.waves]
    return sorted(found, key=lambda each: (not each[1] > 0.0, each[0].axis != "yaw", -each[1]))


def common_period(law: Law | SampledLaw, x: np.ndarray, time: np.ndarray) -> float:
    """Time [s] after which the gait repeats: the least whole multiple of the strongest wave's period that is also a
    multiple of every other term's. `ValueError` for a law without period, or a multiple above 12."""
    return _common_period(law, by_strength(law, x, time))


def _common_period(law: Law | SampledLaw, waves: list[tuple[Term, float]]) -> float:
    if not waves:
        raise ValueError(f"law {shown(law.name)} has no periodic term: it has no period to average over")
    first = waves[0][0].period
    periods = {first} | {term.period for term, curvature in waves if curvature > 0.0}
    for multiple in range(1, LONGEST_COMMON + 1):
        ratios = [multiple * first / period for period in periods]
        if all(abs(ratio - round(ratio)) < 1e-9 * ratio and round(ratio) for ratio in ratios):
            return multiple * first
    listed = ", ".join(f"{period:g}" for period in sorted(periods))
    raise ValueError(
        f"law {shown(law.name)} does not repeat within {LONGEST_COMMON} periods: it has periods {listed} s"
    )


class AveragingWindow:
    """The last `periods` whole periods of `run` (None: those in the later half of the run, at least one).

    run, periods; period [s]: after which the gait of the later half repeats; start, end [s]; wave: the strongest wave
    (yaw, else pitch). `ValueError` if the run is too short or has too few samples.
    """

    def __init__(self, run, periods: int | None = None):
        time = np.asarray(run.time, dtype=float)
        x, later = np.linspace(0.0, run.body.length, PLACES), time[time >= 0.5 * (time[0] + time[-1])]
        waves = by_strength(run.law, x, later)
        self.run, self.period, self.wave = run, _common_period(run.law, waves), waves[0][0]
        self.travelling_wave = next((term for term, _ in waves if term.axis == "yaw" and term.wavelength), None)
        whole = math.floor((time[-1] - time[0]) / self.period + WHOLE)
        if whole < 1:
            raise ValueError(f"run must hold a whole period of {self.period:g} s, got {time[-1] - time[0]:g} s")
        if periods is None:
            periods = (whole + 1) // 2
        if isinstance(periods, bool) or not isinstance(periods, (int, np.integer)) or not 1 <= periods <= whole:
            raise ValueError(
                f"periods must be a whole number from 1 to {whole}, those of the run, got {shown(periods)}"
            )
        if np.max(np.diff(time)) > self.wave.period / FEWEST_SAMPLES * (1.0 + 1e-9):
            raise ValueError(
                f"run must have {FEWEST_SAMPLES} samples or more in a period of {self.wave.period:g} s, "
                f"got a sample period of {np.max(np.diff(time)):g} s"
            )
        self.periods, self.end = int(periods), float(time[-1])
        self.start = max(float(time[0]), self.end - self.periods * self.period)
        self.inside = (time >= self.start - 1e-9 * self.period) & (time <= self.end)

    def __repr__(self) -> str:
        return f"AveragingWindow({self.told})"

    @property
    def told(self) -> str:
        """The window in words."""
        return f"{self.periods} periods of {self.period:g} s, {self.start:g} to {self.end:g} s"

    @property
    def duration(self) -> float:
        """Length of the window [s]."""
        return self.end - self.start

    @property
    def instants(self) -> np.ndarray:
        """(N,) [s], over the window's periods, `FINE` per period of the strongest wave."""
        count = FINE * round(self.period / self.wave.period) * self.periods
        return np.linspace(self.end - self.periods * self.period, self.end, count + 1)

    def mean(self, values: np.ndarray) -> np.ndarray:
        """Mean over the window of samples (T, ...): the integral of the spline through them."""
        return np.asarray(self.spline(values).integrate(self.start, self.end) / self.duration)

    def edges(self, fewest: int) -> np.ndarray:
        """(n + 1,) [s], of the window's periods, or of the run's last `fewest` periods if the window has fewer."""
        whole = math.floor((self.end - float(self.run.time[0])) / self.period + WHOLE)
        count = min(whole, max(self.periods, fewest))
        return np.maximum(self.end - self.period * np.arange(count, -1, -1), self.run.time[0])

    def rate(self, work: np.ndarray, power: np.ndarray) -> float:
        """Mean power [W] over the window of `work` (T,) [J], whose derivative is `power` (T,) [W].

        Between two samples the work at the window's start is interpolated by Hermite's cubic.
        """
        first = max(0, int(np.searchsorted(self.run.time, self.start, side="right")) - 1)
        (before, after), (work_before, work_after), (rate, later) = (
            each[first : first + 2] for each in (self.run.time, work, power)
        )
        length = after - before
        s = (self.start - before) / length
        rise = (work_after - work_before) * (3.0 - 2.0 * s) * s**2
        at_start = work_before + rise + length * s * (1.0 - s) * (rate * (1.0 - s) - later * s)
        return float(work[-1] - at_start) / self.duration

    def spline(self, values: np.ndarray):
        """Cubic not-a-knot spline in time through samples (T, ...). `ValueError` if they are not finite."""
        from scipy.interpolate import make_interp_spline  # twice as fast as CubicSpline

        return make_interp_spline(self.run.time, values, k=min(3, len(self.run.time) - 1))

    def center_of_mass(self, time: Any) -> np.ndarray:
        """The centre of mass over the water (..., 3) [m] at the times (...) [s]."""
        start = self.run.center_of_mass[0] - self.run.time[0] * np.asarray(self.run.scene.current)
        return np.asarray(start + self.paths(time)[..., 0, :])

    @cached_property
    def paths(self):
        """Spline of the displacements (2, 3) [m] over the water since the start: of centre of mass and last station."""
        paths = np.stack((self.run.center_of_mass, self.run.backbone[:, -1]), axis=1)
        drift = np.outer(self.run.time - self.run.time[0], self.run.scene.current)
        return self.spline(paths - paths[0] - drift[:, None])
