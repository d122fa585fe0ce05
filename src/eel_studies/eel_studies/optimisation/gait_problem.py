# SPDX-License-Identifier: Apache-2.0
"""Speed and cost of a gait as functions of its parameters, with derivatives, for an optimiser.

An optimiser sees each parameter as a number from 0 to 1, its place between its bounds: logarithmic if both bounds are
above 0. Speed and cost are nearly powers of a period or a length.
"""

import warnings
from dataclasses import dataclass, field

import numpy as np
from eel_dynamics.analysis.measures import measures_of
from eel_dynamics.batches.simulate_batch import in_threads

from eel_dynamics import Run, SimulationStopped, Swim
from eel_gaits import Law
from eel_studies.gradients.gradient import gradient
from eel_studies.points import Gait, Numbers, law_of_terms, point_at
from eel_studies.steady_swim import at_speed, swim_times

STEP = 1e-5  # of the bounds' distance: difference to either side, for derivatives
SPEED, CHANGE = "mean_speed", "speed_change"
STEADY = 0.05  # greatest change of the speed within a swim that counts as steady
STRIDE = 0.5  # body lengths per period: start of a gait of unknown speed
LONGER = 2  # times the periods, for the final swim


class NoSteadySwim(RuntimeError):
    """A swim stopped, or has no speed or cost, so no derivative exists there."""


@dataclass
class GaitProblem:
    """The gaits between the bounds `low` and `high` (P,) of the parameters `names`, and the gaits tried so far.

    base: body, scene, accuracy. cost: the name of a measure. periods: periods per swim; the later half is measured.
    """

    names: tuple[str, ...]
    low: np.ndarray
    high: np.ndarray
    gait: Gait
    numbers: Numbers
    base: Swim
    cost: str
    periods: int
    threads: int | None
    tried: list[tuple[float, float]] = field(default_factory=list)  # speed and cost of each steady gait
    jumps: bool = False  # the printed friction jumped between two swims of a derivative

    def values(self, place: np.ndarray) -> dict[str, float]:
        """The parameters at a `place` (P,) between their bounds, by name."""
        place = np.clip(place, 0.0, 1.0)
        found = np.where(self._by_power, self.low * self._ratio**place, self.low + place * (self.high - self.low))
        return dict(zip(self.names, found.tolist(), strict=True))

    def law(self, place: np.ndarray) -> Law:
        """The law at a `place` (P,). `ValueError` if the parameters are invalid together."""
        return law_of_terms(point_at(self.values(place), self.gait, self.numbers, self.base).law)

    def measured(self, places: np.ndarray, speed: float | None) -> np.ndarray:
        """Speed [m/s] and cost (N, 2) at `places` (N, P), of swims that begin at `speed` [m/s]; NaN if one stops.

        speed: None starts them at half a body length per period.
        """
        return np.array(in_threads(lambda place: self._measured(place, speed), places, self.threads))

    def derivatives(self, place: np.ndarray, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Speed and cost (2,) at a `place` (P,), and their derivatives (2, P) by the place; or `NoSteadySwim`."""
        place = np.clip(place, STEP, 1.0 - STEP)  # no swim may leave the bounds
        at = self.values(place)
        size = np.where(self._by_power, np.log(self._ratio) * list(at.values()), self.high - self.low)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                found = gradient(
                    (SPEED, self.cost),
                    at,
                    gait=self.gait,
                    numbers=at_speed(self.numbers, speed),
                    body=self.base.body,
                    robot=self.base.robot,
                    scene=self.base.scene,
                    accuracy=self.base.accuracy,
                    stations=self._stations,
                    steps=dict(zip(self.names, 0.5 * STEP * size, strict=True)),
                    estimate=False,
                    threads=self.threads,
                    **swim_times(self.law(place), self.base.body.length, self.periods),
                )
            except (SimulationStopped, ValueError) as error:
                raise NoSteadySwim(str(error)) from error
        self.jumps = self.jumps or bool(found.warnings)
        self._note(*(*found.value.tolist(), measures_of(found.run, (CHANGE,))[CHANGE]))
        return found.value, found.derivative * size

    def run(self, place: np.ndarray, speed: float) -> Run:
        """A longer swim at a `place` (P,), with profiles along the body and an error estimate."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the run keeps them
            return self._swim(place, speed, LONGER * self.periods, 51, estimate=True)

    @property
    def _by_power(self) -> np.ndarray:
        return self.low > 0.0

    @property
    def _ratio(self) -> np.ndarray:
        return np.where(self._by_power, self.high / np.where(self._by_power, self.low, 1.0), 1.0)

    @property
    def _stations(self) -> int:
        return 51 if self.cost in ("greatest_torque", "tail_excursion", "strouhal") else 2

    def _measured(self, place: np.ndarray, speed: float | None) -> tuple[float, float]:
        try:
            if speed is None:
                period = swim_times(self.law(place), self.base.body.length, 1)["duration"]
                speed = STRIDE * self.base.body.length / period
            run = self._swim(place, speed, self.periods, self._stations, estimate=False)
        except (SimulationStopped, ValueError):
            return np.nan, np.nan
        found = measures_of(run, (SPEED, self.cost, CHANGE))
        self._note(found[SPEED], found[self.cost], found[CHANGE])
        return found[SPEED], found[self.cost]

    def _note(self, speed: float, cost: float, change: float) -> None:
        if np.isfinite(cost) and change <= STEADY:
            self.tried.append((speed, cost))

    def _swim(self, place: np.ndarray, speed: float, periods: int, stations: int, estimate: bool) -> Run:
        point = point_at(self.values(place), self.gait, at_speed(self.numbers, speed), self.base)
        times = swim_times(point.law, point.body.length, periods)
        return point.run(**times, stations=stations, estimate=estimate)
