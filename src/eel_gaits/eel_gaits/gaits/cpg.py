# SPDX-License-Identifier: Apache-2.0
"""A central pattern generator: a chain of phase oscillators. Its curvature follows every new number smoothly.

Oscillator i at X_i has a phase theta_i and an amplitude r_i, and the curvature there is K3 = b - r_i sin(theta_i):

    theta_i' = 2 pi f + w sum over neighbours j of sin(theta_j - theta_i + k (X_j - X_i))
    r_i''    = a (a / 4 (A(X_i) - r_i) - r_i')        b'' = a (a / 4 (B - b) - b')

after Ijspeert, Crespi, Ryczko and Cabelguen, Science 315 (2007), 1416-1420, doi:10.1126/science.1138353. The numbers p,
which are f = 1 / period, k = 2 pi / wavelength, those of A(X) = a0 + a1 X + a2 X^2, and B = -left_bend, follow theirs:

    p'' = g^2 (p_set - p) - 2 g p'

So curvature, rate and acceleration never jump. In the settled state, the curvature is one wave term and a bend.
"""

import math
from dataclasses import dataclass

import numpy as np
from eel_common.quantity import quantity

from eel_gaits.gaits.numbers import left_quantity, left_turn
from eel_gaits.gaits.registry import register
from eel_gaits.gaits.swimming import Wave
from eel_gaits.laws.term import Term

OSCILLATORS = 21
COUPLING = 40.0  # 1/s, w
STEPS_PER_PERIOD = 25.0  # of the Runge-Kutta method
SAMPLES_PER_PERIOD = 25.0
LONGEST_SAMPLE = 0.02  # s


@dataclass(frozen=True, kw_only=True)
class Oscillation(Wave):
    """The numbers of a chain of oscillators. The node streams its curvature; a law holds only the settled wave."""

    left_bend: float = left_quantity(0.0, "yaw curvature of a turn")
    convergence: float = quantity(8.0, "1/s", "rate at which amplitudes settle, a", 0.01, 1e3)
    following: float = quantity(4.0, "1/s", "rate at which new numbers are followed, g", 0.01, 1e3)
    length: float = quantity(1.0, "m", "body length L", 1e-4, 1e3)

    @property
    def sample_period(self) -> float:
        """Time [s] between two samples of the stream."""
        return min(LONGEST_SAMPLE, self.period / SAMPLES_PER_PERIOD)

    def targets(self) -> np.ndarray:
        """The target values of the oscillators: f [Hz], k [rad/m], a0, a1, a2, B, shape (6,)."""
        wave = self.amplitude_0, self.amplitude_1, self.amplitude_2
        return np.array((1.0 / self.period, 2.0 * math.pi / self.wavelength, *wave, -self.left_bend))


@register(Oscillation)
def cpg(numbers: Oscillation) -> tuple[Term, ...]:
    """A chain of phase oscillators. The node streams it; the law is its settled wave."""
    return (numbers.term(), *left_turn(numbers.left_bend, numbers.term().envelope))


class Oscillators:
    """The chain in motion, from rest at `time` [s]. numbers: `Oscillation`; its `length` is fixed at the start.

    Attributes:
        numbers: the present targets.
        time: [s], the present time.
        x: (21,) m, places of the oscillators.
    """

    def __init__(self, numbers: Oscillation, time: float = 0.0) -> None:
        self.numbers, self.time = numbers, time
        self.x = np.linspace(0.0, numbers.length, OSCILLATORS)
        n = OSCILLATORS
        self._parts = np.split(np.arange(12 + n + 2 * (n + 1)), np.cumsum([6, 6, n, n + 1]))  # p, p', theta, r, r'
        self._state = np.zeros(12 + n + 2 * (n + 1))
        p, _, theta, _, _ = self._parts
        self._state[p[:2]] = numbers.targets()[:2]
        self._state[theta] = -self._state[p[1]] * self.x

    def advance(self, time: float) -> None:
        """Move on to `time` [s] by steps of the classical Runge-Kutta method."""
        beat = 2.0 * math.pi * max(abs(self._state[0]), 1.0 / self.numbers.period)
        fastest = max(beat, self.numbers.convergence, self.numbers.following)
        steps_per_second = max(fastest * STEPS_PER_PERIOD / (2.0 * math.pi), 4.0 * COUPLING)
        count = max(1, math.ceil((time - self.time) * steps_per_second))
        step = (time - self.time) / count
        for _ in range(count):
            first = self._rate(self._state)
            second = self._rate(self._state + 0.5 * step * first)
            third = self._rate(self._state + 0.5 * step * second)
            fourth = self._rate(self._state + step * third)
            self._state = self._state + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
        self.time = time

    def curvature(self) -> np.ndarray:
        """K3 [rad/m], its rate [rad/m/s] and its acceleration [rad/m/s^2] at the oscillators, shape (3, 21)."""
        p, _, theta, r, r_rate = (self._state[part] for part in self._parts)
        rates = self._rate(self._state)
        p_rate, _, theta_rate, _, r_second = (rates[part] for part in self._parts)
        between = np.diff(self.x)
        apart_rate = np.cos(np.diff(theta) + p[1] * between) * (np.diff(theta_rate) + p_rate[1] * between)
        theta_second = 2.0 * math.pi * p_rate[0] + _pull(apart_rate)
        sine, cosine = np.sin(theta), np.cos(theta)
        amplitude, amplitude_rate, amplitude_second = r[:-1], r_rate[:-1], r_second[:-1]
        return np.stack(
            (
                r[-1] - amplitude * sine,
                r_rate[-1] - amplitude_rate * sine - amplitude * theta_rate * cosine,
                r_second[-1]
                - amplitude_second * sine
                - 2.0 * amplitude_rate * theta_rate * cosine
                - amplitude * (theta_second * cosine - theta_rate**2 * sine),
            )
        )

    def _rate(self, state: np.ndarray) -> np.ndarray:
        p, p_rate, theta, r, r_rate = (state[part] for part in self._parts)
        g, a = self.numbers.following, self.numbers.convergence
        wanted = np.append(p[2] + self.x * (p[3] + self.x * p[4]), p[5])
        pull = _pull(np.sin(np.diff(theta) + p[1] * np.diff(self.x)))
        return np.concatenate(
            (
                p_rate,
                g * g * (self.numbers.targets() - p) - 2.0 * g * p_rate,
                2.0 * math.pi * p[0] + pull,
                r_rate,
                a * (0.25 * a * (wanted - r) - r_rate),
            )
        )


def _pull(apart: np.ndarray) -> np.ndarray:
    """The coupling of n oscillators from the differences `apart` (n - 1,) between neighbours."""
    return np.asarray(COUPLING * (np.append(apart, 0.0) - np.append(0.0, apart)))
