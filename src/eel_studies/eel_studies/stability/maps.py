# SPDX-License-Identifier: Apache-2.0
"""Maps of the error over two parameters of a run at a time, beyond the range of any swimmer.

Each run is compared with a finer one. The error is the greatest distance between the two heads over all samples,
relative to the length of the head's path or of the body, whichever is longer. A run is accurate if its error meets the
target. For an inaccurate run the map records whether the run indicates it: by a warning, or by its error estimate.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from eel_dynamics.accuracy.accuracy import ORDERS, PRESETS, Accuracy
from eel_dynamics.model.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.batch import simulate_batch

from eel_gaits import straight

TARGET, FINER = 1e-3, 1e-6
FINEST = Accuracy(name="finest", resolution=200.0, tolerance=1e-12)  # for comparison with the finer presets
SAMPLES = 32  # eight per period
LEAST_VISCOSITY = 1e-10  # m^2/s
METHODS = (*(("adams", order) for order in ORDERS["adams"]), ("dormand_prince", 5))
STATIONS = 33
FIXED_RESOLUTION = 36.0  # points per body length with a fixed step: the error in space stays below the target
ACCURATE, INACCURATE, STOPPED = "accurate", "inaccurate", "stopped"


class Axis(NamedTuple):
    """An axis of a map: label, least and greatest value."""

    label: str
    low: float
    high: float


PERIOD = Axis("period (s)", 0.02, 50.0)
DENSITY = Axis("density of the body, by water's", 1e-3, 1e3)
SLENDERNESS = Axis("slenderness l / (2 max(a, b))", 5.0, 500.0)


def named(label: str, count: int) -> Axis:
    """An axis of `count` rows with names: the values are the powers of 2."""
    return Axis(label, 1.0, 2.0 ** (count - 1))


def sized(low: float, high: float) -> Axis:
    """The amplitude of the wave as an axis."""
    return Axis("amplitude, by the paper's", low, high)


@dataclass(frozen=True)
class Map:
    """A sweep over two axes, with `points` values of each in geometric sequence.

    swimmer(x, y): arguments of one run by their names in `simulate_batch`, and `duration` [s]. y_names: labels of the
    rows where y is not a number: one row for each (`named`). target: of the relative error, one number or one per row.
    """

    name: str
    title: str
    across: Axis
    up: Axis
    points: int
    swimmer: Callable
    y_names: tuple[str, ...] = ()
    target: np.ndarray | float = TARGET

    @property
    def x(self) -> np.ndarray:
        """Values along the map."""
        return np.geomspace(self.across.low, self.across.high, self.points)

    @property
    def y(self) -> np.ndarray:
        """Values of the rows; of rows with names the powers of 2."""
        return np.geomspace(self.up.low, self.up.high, len(self.y_names) or self.points)


@dataclass(frozen=True)
class Measured:
    """The results of a map: (len(y), len(x)) arrays."""

    map: Map
    error: np.ndarray  # relative; NaN where the run stopped
    reason: np.ndarray  # message of the stop, empty where there was none
    steps: np.ndarray  # in time
    limits: np.ndarray  # bool: the run warns of a limit of the model
    warned: np.ndarray  # bool: inaccurate, and the run warns of an open energy ledger
    estimate: np.ndarray  # error estimate of an inaccurate run relative to its target; else NaN

    @property
    def size(self) -> np.ndarray:
        """Error relative to the target."""
        return self.error / np.reshape(self.map.target, (-1, 1))

    @property
    def outcome(self) -> np.ndarray:
        """`ACCURATE`, `INACCURATE` or `STOPPED` for each run."""
        kept = np.where(self.size <= 1.0, ACCURATE, INACCURATE)
        return np.where(self.reason != "", STOPPED, kept)

    @property
    def worst(self) -> float:
        """Greatest error relative to the target among finished runs; NaN where none finished."""
        return float(np.nanmax(self.size)) if np.isfinite(self.error).any() else np.nan


def measure(item: Map) -> Measured:
    """Simulate every point of the map, and again with finer settings for comparison."""
    points = [item.swimmer(x, y) for y in item.y for x in item.x]
    shape = len(item.y), len(item.x)
    error, reason = np.full(len(points), np.nan), np.full(len(points), "", dtype=object)
    steps, target = np.zeros(len(points), dtype=int), np.repeat(np.resize(item.target, shape[0]), shape[1])
    limits, warned, estimate = np.zeros(len(points), dtype=bool), np.zeros(len(points), dtype=bool), error.copy()
    durations = [point.pop("duration") for point in points]
    for duration in sorted(set(durations)):
        chosen = [index for index, each in enumerate(durations) if each == duration]
        swims = [points[index] for index in chosen]
        shared = {"duration": duration, "sample_period": duration / SAMPLES}
        keywords: dict[str, Any] = {name: [swim[name] for swim in swims] for name in swims[0]}
        batch = simulate_batch(**shared, **keywords, stations=STATIONS)
        finest = [FINER if each >= TARGET else FINEST for each in target[chosen]]
        finer = simulate_batch(**shared, **{**keywords, "accuracy": finest}, estimate=False)
        for place, index in enumerate(chosen):
            steps[index] = batch.steps[place]
            stop = batch.error[place] or finer.error[place]
            if stop is not None:
                reason[index] = str(stop)
                continue
            apart = np.linalg.norm(batch.position[place] - finer.position[place], axis=1).max()
            path = np.linalg.norm(np.diff(finer.position[place], axis=0), axis=1).sum()
            error[index] = apart / max(path, batch.bodies[place].length)
            run = batch[place]
            ledger = [text for text in run.warnings if "ledger" in text]
            limits[index] = len(run.warnings) > len(ledger)
            if error[index] > target[index]:
                warned[index] = bool(ledger)
                assert run.error_estimate is not None
                estimate[index] = run.error_estimate.worst / target[index]
    found = error, reason, steps, limits, warned, estimate
    return Measured(item, *(each.reshape(shape) for each in found))


def maps_of(points: int = 13) -> tuple[Map, ...]:
    """The maps, of `points` by `points` runs each. Maps over presets or methods have one row for each of them."""
    rows = [
        ("gait", "period and amplitude: 4 periods", PERIOD, sized(1e-12, 4.0),
         lambda period, size: _swim(_wave(period=period, size=size), 4.0 * period)),
        ("wave", "wavelength and amplitude: 4 periods",
         Axis("wavelength (body lengths)", 0.2, 100.0), sized(1e-3, 12.0),
         lambda wavelength, size: _swim(_wave(wavelength=wavelength, size=size), 4.0)),
        ("water", "density and viscosity: 4 periods", DENSITY, Axis("viscosity (m²/s)", 1e-9, 1.0),
         lambda ratio, viscosity: _swim(_wave(), 4.0, scenes=Scene(density=1000.0 * ratio, viscosity=viscosity))),
        ("viscosity", "period and viscosity: 4 periods", PERIOD,
         Axis("viscosity (m²/s), the lowest row: 0", LEAST_VISCOSITY, 1.0),
         lambda period, viscosity: _swim(_wave(period=period), 4.0 * period,
                                         scenes=Scene(viscosity=viscosity * (viscosity > LEAST_VISCOSITY)))),
        ("velocity", "initial velocity, and spin about three axes: 0.2 s",
         Axis("speed (m/s)", 1e-2, 100.0), Axis("spin (turns/s)", 1e-2, 100.0),
         lambda speed, turns: _swim(
             _wave(), 0.2, twists=np.array([*np.full(3, 2.0 * np.pi * turns / np.sqrt(3.0)), -speed, 0.0, 0.0]))),
        ("body", "length and slenderness: 4 periods", Axis("length (m)", 0.01, 100.0), SLENDERNESS,
         lambda length, slenderness: _swim(_wave(length=length), 4.0, bodies=Body.spindle(length, slenderness))),
        ("step", "a fixed step (classical Runge-Kutta): 4 periods", Axis("step (periods)", 1e-2, 1.0), DENSITY,
         lambda step, ratio: _swim(_wave(), 4.0, scenes=Scene(density=1000.0 * ratio), accuracy=Accuracy(
             name=f"step {step:.3g}", resolution=FIXED_RESOLUTION, step=step))),
    ]  # fmt: skip
    presets = Map(
        *("preset", "the presets, each by its own target: 4 periods", PERIOD, named("preset", len(PRESETS)), points),
        lambda period, row: _swim(_wave(period=period), 4.0 * period, accuracy=list(PRESETS)[round(np.log2(row))]),
        tuple(PRESETS),
        np.array(list(PRESETS.values())),
    )
    methods = Map(
        *("method", "every adaptive method: 4 periods", Axis("tolerance of a step", 1e-8, 1.0)),
        *(named("method", len(METHODS)), points),
        lambda tolerance, row: _swim(_wave(), 4.0, accuracy=_method(round(np.log2(row)), tolerance)),
        tuple(f"{method} {order}" for method, order in METHODS),
    )
    return *(Map(*row[:4], points, row[4]) for row in rows), presets, methods


def _wave(period=1.0, wavelength=1.0, size=1.0, length=1.0):
    """The paper's wave on a body of `length` [m]. period: [s]; wavelength: [body lengths]; size: amplitude ratio."""
    return straight(
        period=period,
        wavelength=wavelength * length,
        amplitude_0=size / length,
        amplitude_1=0.5 * size / length**2,
        amplitude_2=2.0 * size / length**3,
    )


def _method(row: int, tolerance: float) -> Accuracy:
    method, order = METHODS[row]
    name = f"{method} {order} {tolerance:.3g}"
    return Accuracy(name=name, resolution=FIXED_RESOLUTION, method=method, order=order, tolerance=tolerance)


def _swim(law, duration, **rest) -> dict:
    plain = {"bodies": _ROBOT, "scenes": Scene(), "accuracy": TARGET, "twists": np.zeros(6)}
    return {"laws": law, "duration": float(duration), **plain, **rest}


_ROBOT = Body.boyer2010()
