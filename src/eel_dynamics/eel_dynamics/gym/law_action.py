# SPDX-License-Identifier: Apache-2.0
"""Actions that are numbers of a law: the size of its wave, its speed in time, and bends of the whole body.

    K(t, X) = amplitude(t) law(tau(t), X) + bends(t),   d tau / dt = tempo(t)

Each number follows its action as a critically damped oscillator, so the curvature, its rate and its acceleration never
jump.
"""

import math
from typing import NamedTuple

import numpy as np
from eel_gaits.input_output.wording import shown
from eel_gaits.laws.law import Law

from eel_dynamics.model.arguments import checked_instance, checked_number, checked_row

AXES = {"pitch": 0, "yaw": 1}


class Number(NamedTuple):
    """A number of the law."""

    rest: float  # without an action
    unit: str
    description: str


NUMBERS = {
    "amplitude": Number(1.0, "", "factor of the law's waves"),
    "tempo": Number(1.0, "", "rate of the law's own time; 1: as the law says"),
    "left_bend": Number(0.0, "rad/m", "bend of the whole body; positive: turns left"),
    "up_bend": Number(0.0, "rad/m", "bend of the whole body; positive: climbs"),
}
BENDS = {"left_bend": "yaw", "up_bend": "pitch"}  # both are minus the curvature in the section's axes


class LawAction:
    """Turns actions into the curvature of the body at the ends of control steps.

    An action holds one value for each of the `numbers`, from -1 (its low bound) to 1 (its high bound).

    Args:
        law: its waves; the ramps of their envelopes count as complete. Terms without a period are constant bends.
        numbers: name of each number: (low, high). See `NUMBERS` for names and units.
        response: [s], time constant with which a number follows its action.
        length: [m], of the body.
        points: along the body.
    """

    def __init__(self, law: Law, numbers: dict, *, response: float = 0.2, length: float = 1.0, points: int = 21):
        checked_instance("law", law, Law)
        for name, bounds in checked_instance("numbers", numbers, dict).items():
            if name not in NUMBERS:
                raise ValueError(f"a law has no number {shown(name)}, it has: {', '.join(NUMBERS)}")
            low, high = checked_row(f"bounds of {name}", bounds, 2)
            if not low < high:
                raise ValueError(f"bounds of {name} must rise, got {shown(bounds)}")
        if not numbers:
            raise ValueError("numbers must hold one or more, got none")
        checked_number("response", response, "s")
        self.law, self.names, self.x = law, tuple(numbers), np.linspace(0.0, length, points)
        low, high = np.array(list(numbers.values()), dtype=float).T
        self._middle, self._half, self._rate = 0.5 * (low + high), 0.5 * (high - low), 1.0 / response
        self._waves = [(term.angular_frequency, AXES[term.axis]) for term in law.terms]
        self._rows = np.concatenate([_rows(term, self.x) for term in law.terms] + [np.ones((1, points))])
        self._held = {name: (number.rest, 0.0, 0.0) for name, number in NUMBERS.items()}
        self._period = min((term.period for term in law.terms if term.period), default=1.0)
        self._values = self._held
        self._own_time = 0.0
        self.begin()

    @property
    def size(self) -> int:
        """How many values an action has."""
        return len(self.names)

    @property
    def period(self) -> float:
        """Period [s] of the law's fastest wave."""
        return self._period

    def described(self) -> list[str]:
        """One line for each value of an action: name, unit, bounds, meaning."""
        bounds = zip(self._middle - self._half, self._middle + self._half, strict=True)
        return [
            f"{name} [{NUMBERS[name].unit or '1'}], {low:g} to {high:g}: {NUMBERS[name].description}"
            for name, (low, high) in zip(self.names, bounds, strict=True)
        ]

    def begin(self, own_time: float = 0.0) -> np.ndarray:
        """Start anew with all numbers at rest and the law at its `own_time` [s]; the curvature as of `advance`."""
        self._own_time, self._values = own_time, dict(self._held)
        return self._curvature()

    def advance(self, action: np.ndarray, step: float) -> np.ndarray:
        """The curvature at the end of a control step of `step` [s] with this `action` (size,).

        Returns (6, points): pitch, its rate and its acceleration, then yaw: rad/m, rad/m/s, rad/m/s^2.
        """
        elapsed = step * self._values["tempo"][0]
        targets = (self._middle + self._half * action).tolist()
        for name, target in zip(self.names, targets, strict=True):
            self._values[name], integral = _followed(self._values[name], target, self._rate, step)
            if name == "tempo":
                elapsed = integral
        self._own_time += elapsed
        return self._curvature()

    @property
    def names_of_state(self) -> list[tuple[str, str, float]]:
        """Name, unit and greatest size of what `state` holds."""
        named = []
        for name, middle, half in zip(self.names, self._middle.tolist(), self._half.tolist(), strict=True):
            unit = NUMBERS[name].unit
            size = max(abs(middle) + half, abs(NUMBERS[name].rest))
            named += [
                (name, unit, 1.5 * size),
                (f"{name} rate", f"{unit}/s" if unit else "1/s", 2.0 * size * self._rate),
            ]
        return [*named, ("sine of the wave's phase", "", 1.0), ("cosine of the wave's phase", "", 1.0)]

    @property
    def state(self) -> list[float]:
        """Each number and its rate, then sine and cosine of the wave's phase."""
        found = [value for name in self.names for value in self._values[name][:2]]
        phase = 2.0 * math.pi * math.fmod(self._own_time / self._period, 1.0)
        return [*found, math.sin(phase), math.cos(phase)]

    def _curvature(self) -> np.ndarray:
        size, speed = self._values["amplitude"], self._values["tempo"]
        factors = np.zeros((2, 3, len(self._rows)))
        for k, (frequency, axis) in enumerate(self._waves):
            angle = frequency * self._own_time
            s, c = math.sin(angle), math.cos(angle)
            for row, (f, f1) in ((2 * k, (c, -frequency * s)), (2 * k + 1, (-s, -frequency * c))):
                rate = f1 * speed[0]
                acceleration = -frequency * frequency * f * speed[0] ** 2 + f1 * speed[1]
                factors[axis, :, row] = (
                    size[0] * f,
                    size[1] * f + size[0] * rate,
                    size[2] * f + 2.0 * size[1] * rate + size[0] * acceleration,
                )
        for name, axis in BENDS.items():
            factors[AXES[axis], :, -1] = [-value for value in self._values[name]]
        return factors.reshape(6, -1) @ self._rows


def _rows(term, x: np.ndarray) -> np.ndarray:
    """Rows (2, len(x)) of a term with its ramps complete: those of the cosine and the sine of its time."""
    end = max((ramp.end for ramp in term.envelope), default=0.0)
    size = term.amplitude_at(x) * term.envelope_at(end)[0]
    angle = term.wave_number * x + term.phase
    return np.stack((size * np.sin(angle), size * np.cos(angle)))


def _followed(jet: tuple, target: float, rate: float, step: float) -> tuple[tuple, float]:
    """Value, rate and acceleration after `step` [s] of a critically damped oscillator that goes to its `target`.

    jet: the same before. rate [1/s]: of the oscillator. Returns the integral of the value over the step too.
    """
    away, slope = jet[0] - target, jet[1] + rate * (jet[0] - target)
    left = math.exp(-rate * step)
    distance = (away + slope * step) * left
    speed = slope * left - rate * distance
    integral = away * (1.0 - left) / rate + slope * (1.0 - left * (1.0 + rate * step)) / rate**2
    return (target + distance, speed, -rate * rate * distance - 2.0 * rate * speed), target * step + integral
