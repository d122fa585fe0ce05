# SPDX-License-Identifier: Apache-2.0
"""A law whose size, tempo and bends change while the swimmer moves.

    K3(t, X) = amplitude(t) law3(tau(t), X) - left_bend(t)
    K2(t, X) = amplitude(t) law2(tau(t), X) - up_bend(t) + tilt(t) wave3(tau(t), X) + swirl(t) wave3(tau(t) - T/4, X)
    d tau / dt = tempo(t)

wave3 is the travelling part of the law in yaw, each wave with its own period T. Each number follows its target as a
critically damped oscillator. So the curvature, its rate and its acceleration never jump.
"""

import copy
import math
import operator
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from eel_gaits.laws.law import Law
from eel_gaits.laws.term import LAW_ROW, Term

Jet = tuple[Any, Any, Any]  # value, rate and acceleration, of one swimmer or several


class Number(NamedTuple):
    """A number of the steered law."""

    rest: float  # value without a target
    unit: str
    description: str


NUMBERS = {
    "amplitude": Number(1.0, "", "factor of the law's waves"),
    "tempo": Number(1.0, "", "rate of the law's own time; 1: as the law says"),
    "left_bend": Number(0.0, "rad/m", "bend of the whole body; positive: turns left"),
    "up_bend": Number(0.0, "rad/m", "bend of the whole body; positive: climbs"),
    "tilt": Number(0.0, "", "factor of the yaw waves that the body bends by in pitch too: it tilts the beat"),
    "swirl": Number(0.0, "", "the same a quarter of a period later: it rolls the body"),
}
BENDS = {"left_bend": "yaw", "up_bend": "pitch"}  # both are minus the curvature in the section's axes
ROLLING = {"tilt": (1.0, 0.0), "swirl": (0.0, 1.0)}  # cosine and sine of the delay


class SteeredLaw:
    """The curvature of a steered law, advanced step by step. The ramps of the law's envelopes count as complete.

    It steers one swimmer, or N in parallel: its own time, its numbers and their targets then have shape (N,).

    Args:
        law: its waves; terms without a period are constant bends.
        response: [s], time constant of a number's response to its target.
        length: [m], of the body.
        points: number of points along the body.
    """

    def __init__(self, law: Law, *, response: float = 0.2, length: float = 1.0, points: int = 21):
        self.law, self.x, self._rate = law, np.linspace(0.0, length, points), 1.0 / response
        self._rows = np.concatenate([_rows(term, self.x) for term in law.terms] + [np.ones((1, points))])
        self._waves = [  # each with the slots of its cosine and sine
            (term.angular_frequency, term.axis, self._places(term.axis, 2 * k), self._places(term.axis, 2 * k + 1))
            for k, term in enumerate(law.terms)
        ]
        self._rest = {name: (number.rest, 0.0, 0.0) for name, number in NUMBERS.items()}
        self.period = min((term.period for term in law.terms if term.period), default=1.0)  # s, of the fastest wave
        self.values: dict[str, Any] = dict(self._rest)  # by number: value, rate, acceleration
        self.greatest_curvature = float(np.max(sum(np.hypot(*_rows(term, self.x)) for term in law.terms)))  # rad/m
        self.own_time: Any = 0.0  # s, tau
        self._swimmers: tuple[int, ...] = ()  # (N,), or () for one
        self.begin()

    def begin(self, own_time: Any = 0.0, **values: float) -> np.ndarray:
        """Restart at the law's `own_time` [s], or (N,) for N swimmers. All numbers are at rest, or have these `values`.
        Returns the curvature as `advance` does."""
        self.own_time, self._swimmers = own_time, np.shape(own_time)
        self.values = dict(self._rest)
        for name, value in values.items():
            jet = value, 0.0, 0.0
            self.values[name] = tuple(np.full(self._swimmers, part) for part in jet) if self._swimmers else jet
        return self._curvature()

    def begin_some(self, swimmers: list[int], own_times: np.ndarray) -> np.ndarray:
        """Restart K of N swimmers with all their numbers at rest. Returns their curvature (K, 6, points)."""
        self.own_time[swimmers] = own_times
        for name, rest in self._rest.items():
            if self.values[name] is not rest:
                for value, begun in zip(self.values[name], rest, strict=True):
                    value[swimmers] = begun
        return copy.copy(self).begin(own_times)

    def advance(self, targets: Mapping[str, Any], step: float, response: float | None = None) -> np.ndarray:
        """The curvature after a step of `step` [s] towards these `targets`, by name; other targets stay.

        response [s]: replaces the law's in this step. Returns (6, points), or (N, 6, points): pitch, its rate and its
        acceleration, then yaw: rad/m, rad/m/s, rad/m/s^2.
        """
        rate = 1.0 / response if response else self._rate
        speed, wanted = self.values["tempo"], targets.get("tempo")
        elapsed = step * speed[0] if wanted is None else _travelled(speed, wanted, rate, step)
        for name, target in targets.items():
            self.values[name] = _followed(self.values[name], target, rate, step)
        self.own_time = self.own_time + elapsed
        return self._curvature()

    def _curvature(self) -> np.ndarray:
        size, speed = self.values["amplitude"], self.values["tempo"]
        as_it_is = size is self._rest["amplitude"] and speed is self._rest["tempo"]
        count, points = self._rows.shape
        # factors of the rows, by axis and derivative: a list of floats, which are faster, or (., N)
        factors: Any = np.zeros((*self._swimmers, 6 * count)).T if self._swimmers else [0.0] * (6 * count)
        for k, (frequency, axis, of_cosine, of_sine) in enumerate(self._waves):
            angle = frequency * self.own_time
            s, c = np.sin(angle), np.cos(angle)
            if not self._swimmers:
                s, c = float(s), float(c)
            fs, fc = -frequency * s, -frequency * c
            if as_it_is:  # the most frequent case
                square = frequency * frequency
                factors[of_cosine] = c, fs, -square * c
                factors[of_sine] = -s, fc, square * s
            else:
                factors[of_cosine] = _product(size, c, fs, frequency, speed)
                factors[of_sine] = _product(size, -s, fc, frequency, speed)
            if frequency and axis == "yaw":
                for name, (now, later) in ROLLING.items():
                    number = self.values[name]
                    if number is not self._rest[name]:
                        f, g = now * c + later * s, later * c - now * s
                        for row, (value, slope) in enumerate(((f, frequency * g), (g, -frequency * f)), 2 * k):
                            place, rolled = self._places("pitch", row), _product(number, value, slope, frequency, speed)
                            factors[place] = list(map(operator.add, factors[place], rolled))
        for name, bent in BENDS.items():
            if self.values[name] is not self._rest[name]:
                value, rate, acceleration = self.values[name]
                factors[self._places(bent, count - 1)] = -value, -rate, -acceleration
        rows: np.ndarray = np.asarray(factors).T.reshape(-1, count).dot(self._rows)
        return rows.reshape(*self._swimmers, 6, points)

    def _places(self, axis: str, row: int) -> slice:
        """The slots of a row's factors: value, rate and acceleration about an axis."""
        first = 3 * LAW_ROW[axis] * len(self._rows) + row
        return slice(first, first + 3 * len(self._rows), len(self._rows))


def _product(number: Jet, f: Any, f1: Any, frequency: float, speed: Jet) -> tuple[Any, Any, Any]:
    """Value, rate and acceleration of a `number` times f(tau), with f'' = -frequency^2 f and tau' the `speed`."""
    rate = f1 * speed[0]
    acceleration = -frequency * frequency * f * speed[0] ** 2 + f1 * speed[1]
    return (
        number[0] * f,
        number[1] * f + number[0] * rate,
        number[2] * f + 2.0 * number[1] * rate + number[0] * acceleration,
    )


def _rows(term: Term, x: np.ndarray) -> np.ndarray:
    """Rows (2, len(x)) of a term with complete ramps: factors of the cosine and the sine in time."""
    end = max((ramp.end for ramp in term.envelope), default=0.0)
    size = term.amplitude_at(x) * term.envelope_at(end)[0]
    angle = term.wave_number * x + term.phase
    return np.stack((size * np.sin(angle), size * np.cos(angle)))


def _followed(jet: Jet, target: Any, rate: float, step: float) -> Jet:
    """Value, rate and acceleration of a critically damped oscillator after `step` [s] towards its `target`.

    jet: the same before the step. rate: [1/s], of the oscillator.
    """
    away = jet[0] - target
    slope, left = jet[1] + rate * away, math.exp(-rate * step)
    distance = (away + slope * step) * left
    speed = slope * left - rate * distance
    return target + distance, speed, -rate * rate * distance - 2.0 * rate * speed


def _travelled(jet: Jet, target: Any, rate: float, step: float) -> Any:
    """The integral of that oscillator's value over the step."""
    away = jet[0] - target
    slope, left = jet[1] + rate * away, math.exp(-rate * step)
    integral = away * (1.0 - left) / rate + slope * (1.0 - left * (1.0 + rate * step)) / rate**2
    return target * step + integral
