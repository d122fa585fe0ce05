# SPDX-License-Identifier: Apache-2.0
"""Actions that are numbers of a law: the amplitude of its wave, its tempo, and bends of the whole body.

They move a `SteeredLaw`, so the curvature, its rate and its acceleration never jump.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from eel_common.quantity import checked_instance, checked_row, positive
from eel_common.wording import shown
from eel_dynamics.accuracy.law_waves import check_law
from eel_dynamics.curvature.curvature_samples import POINTS_PER_WAVE
from eel_dynamics.simulation.sampled_swimmers import Array
from eel_gaits.laws.law import Law
from eel_gaits.laws.steered_law import BENDS, NUMBERS, SteeredLaw
from eel_gaits.laws.term import Term


class LawAction:
    """Turns actions into the curvature of the body at the ends of control steps.

    An action holds one value for each of the `numbers`, from -1 (its low bound) to 1 (its high bound).

    Args:
        law: its waves; the ramps of their envelopes count as complete. Terms without a period are constant bends.
        numbers: name of each number: (low, high). See `NUMBERS` for names and units.
        response: [s], time constant of a number's response to its action.
        length: [m], of the body.
        points: number of points along the body; None: so many that the dynamics node, which does not know the law,
            takes the same grid.

    Attributes:
        x: (points,) [m], points along the body.
        waves: number of waves on the body for the grid: those with all numbers at their greatest magnitude, or more.
    """

    def __init__(
        self,
        law: Law,
        numbers: dict[str, Any],
        *,
        response: float = 0.2,
        length: float = 1.0,
        points: int | None = None,
    ):
        checked_instance("law", law, Law)
        for name, bounds in checked_instance("numbers", numbers, dict).items():
            if name not in NUMBERS:
                raise ValueError(f"a law has no number {shown(name)}, it has: {', '.join(NUMBERS)}")
            low, high = checked_row(f"bounds of {name}", bounds, 2)
            if not low < high:
                raise ValueError(f"bounds of {name} must rise, got {shown(bounds)}")
        if not numbers:
            raise ValueError("numbers must hold one or more, got none")
        positive("response", response, "s")
        length = positive("length", length, "m")
        self.law, self.names, self._rate = law, tuple(numbers), 1.0 / response
        self._span = [(0.5 * (low + high), 0.5 * (high - low)) for low, high in numbers.values()]  # middle, half width
        self.waves = max(1.0, check_law(_largest(law, numbers), length))
        if points is None:
            self.waves = 2.0 ** math.ceil(math.log2(self.waves))
            points = round(POINTS_PER_WAVE * self.waves) + 1
        self._steered = SteeredLaw(law, response=response, length=length, points=points)
        self.x = self._steered.x

    @property
    def size(self) -> int:
        """The number of values in an action."""
        return len(self.names)

    @property
    def period(self) -> float:
        """Period [s] of the law's fastest wave."""
        return self._steered.period

    def described(self) -> list[str]:
        """One line for each value of an action: name, unit, bounds, meaning."""
        return [
            f"{name} [{NUMBERS[name].unit or '1'}], {middle - half:g} to {middle + half:g}: {NUMBERS[name].description}"
            for name, (middle, half) in zip(self.names, self._span, strict=True)
        ]

    def begin(self, own_time: Any = 0.0) -> Array:
        """Restart with all numbers at rest and the law at its `own_time` [s], or (N,) for N swimmers. Returns the
        curvature as `advance` does."""
        return self._steered.begin(own_time)

    def begin_some(self, swimmers: list[int], own_times: Array) -> Array:
        """Restart K of N swimmers. Returns their curvature (K, 6, points)."""
        return self._steered.begin_some(swimmers, own_times)

    def advance(self, action: Array, step: float) -> Array:
        """The curvature at the end of a control step of `step` [s] with this `action` (size,), or (N, size).

        Returns (6, points), or (N, 6, points): pitch, its rate and its acceleration, then yaw: rad/m, rad/m/s,
        rad/m/s^2.
        """
        values = action.tolist() if action.ndim == 1 else action.T
        spans = zip(self.names, self._span, values, strict=True)
        return self._steered.advance({name: middle + half * value for name, (middle, half), value in spans}, step)

    @property
    def names_of_state(self) -> list[tuple[str, str, float]]:
        """Name, unit and scale of each value of `state`: a number's greatest target, and that by the response."""
        named = []
        for name, (middle, half) in zip(self.names, self._span, strict=True):
            unit = NUMBERS[name].unit
            size = max(abs(middle) + half, abs(NUMBERS[name].rest))
            named += [(name, unit, size), (f"{name} rate", f"{unit}/s" if unit else "1/s", size * self._rate)]
        return [*named, ("sine of the wave's phase", "", 1.0), ("cosine of the wave's phase", "", 1.0)]

    @property
    def state(self) -> list[Any]:
        """Each number and its rate, then sine and cosine of the wave's phase; (N,) each for N swimmers."""
        found = [value for name in self.names for value in self._steered.values[name][:2]]
        phase = 2.0 * math.pi * (self._steered.own_time / self.period % 1.0)
        return [*found, np.sin(phase), np.cos(phase)]


def _largest(law: Law, numbers: dict[str, Any]) -> Law:
    """The law that bends the body most, with all `numbers` at their greatest magnitude."""
    size = {name: max(map(abs, bounds)) for name, bounds in numbers.items()}
    rolling = math.hypot(size.get("tilt", 0.0), size.get("swirl", 0.0))
    terms = [term.scaled(size.get("amplitude", 1.0)) for term in law.terms]
    terms += [replace(term, axis="pitch").scaled(rolling) for term in law.terms if term.axis == "yaw" and term.period]
    bends = [Term(axis=axis, amplitude=(size.get(name, 0.0),), phase=0.5 * math.pi) for name, axis in BENDS.items()]
    return Law([*terms, *bends], name=law.name)
