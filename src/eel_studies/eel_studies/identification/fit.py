# SPDX-License-Identifier: Apache-2.0
"""The least-squares problem of `identify`: unknowns, residuals, minimisation, and the result."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from eel_dynamics.model.equality import EqualByFields

from eel_dynamics import Run
from eel_studies.identification.measurements import MeasuredPath, MeasuredSpeed, Measurement, count_of
from eel_studies.identification.prediction import Predicted, Swims, placed, placement_of
from eel_studies.identification.statistics import Block, correlation_of, gauss_newton_covariance, undetermined, whitened

POSITIVE = ("body.", "scene.", "robot.")  # parameters that stay above 0
LEAST = 1e-6  # of the first guess: lower bound instead of 0
PASSES = 4  # passes of the fit, each with the correlation found in the last one
SAME = 0.01  # smaller changes of the correlation end the passes
UNLIKELY = 1e-3  # probability of the residuals for the given noise, below which a warning reports a misfit
INSENSITIVE = 1e-8  # relative derivative along an axis, below which no parameter moves the point along it
TOLERANCE = 1e-6  # of the unknowns and of the sum of squares, relative
MOST_EVALUATIONS = 50  # of the model, per pass


@dataclass(frozen=True, eq=False, repr=False)
class Identified(EqualByFields):
    """P parameters fitted to measurements."""

    names: tuple[str, ...]
    value: np.ndarray  #: (P,)
    error: np.ndarray  #: (P,) standard errors
    low: np.ndarray  #: (P,) interval
    high: np.ndarray  #: (P,)
    level: float  #: probability that an interval covers the true value
    covariance: np.ndarray  #: (P, P)
    noise: float  #: standard deviation of the measurements' errors [m], [rad] or [m/s]
    correlation: float  #: of successive errors of a path, at the median time between samples
    residuals: tuple[np.ndarray, ...]  #: measured minus predicted, each: (T, D) [m], (T, J) [rad] or (1,) [m/s]
    runs: tuple[Run, ...]  #: the swims with the values found, one per measurement
    warnings: tuple[str, ...]

    def __getitem__(self, name: str) -> tuple[float, float, float]:
        """Value, low and high end of the interval of the parameter `name`."""
        if name not in self.names:
            raise KeyError(name)
        index = self.names.index(name)
        return float(self.value[index]), float(self.low[index]), float(self.high[index])

    def __repr__(self) -> str:
        return f"Identified({', '.join(f'{name}={value:.4g}' for name, value in self.numbers.items())})"

    @property
    def numbers(self) -> dict[str, float]:
        """The values by name, for the argument `numbers` of `gradient`, `sweep` and `optimise`."""
        return dict(zip(self.names, self.value.tolist(), strict=True))

    def table(self) -> str:
        """The parameters with their standard errors and intervals, as lines of text."""
        width = max(len(name) for name in self.names)
        lines = [
            f"{name:<{width}s}  {value:.5g} +- {error:.2g}, {100.0 * self.level:.4g} % interval {low:.5g} to {high:.5g}"
            for name, value, error, low, high in zip(
                self.names, self.value, self.error, self.low, self.high, strict=True
            )
        ]
        lines.append(f"{'errors':<{width}s}  {self.noise:.3g}, each correlated with the next by {self.correlation:.2f}")
        return "\n".join(lines)


class Fit:
    """Fits parameters to `measured`, from their values `first`. `ValueError` if they are not determined."""

    def __init__(
        self,
        swims: Swims,
        measured: list[Measurement],
        first: dict[str, float],
        progress: Callable[[float, float], object],
    ):
        self.names, self._swims, self._progress = tuple(first), swims, progress
        self._start = np.array(list(first.values()))
        self._known: dict[bytes, list[Predicted]] = {}
        self._unknown, self._measured, self.correlation = self._start, measured, 0.0
        self._measured = [_informative(*pair, self._start) for pair in zip(measured, self._predicted(), strict=True)]
        self._known.clear()
        pairs = zip(self._measured, self._predicted(), strict=True)
        placements = [placement_of(each, found.value) for each, found in pairs if isinstance(each, MeasuredPath)]
        self._unknown = np.concatenate((self._start, *placements))

    @property
    def values(self) -> np.ndarray:
        """The present parameters (P,)."""
        return self._unknown[: len(self.names)]

    @property
    def blocks(self) -> list[Block]:
        """Residuals and derivatives at the present values."""
        found = zip(self._measured, self._compared(), strict=True)
        return [block for each, compared in found for block in _blocks(each.time, *compared)]

    def solve(self, noise: float | None) -> None:
        """Minimise the sum of squares with correlated errors. `ValueError`: singular, or too few measurements."""
        count, unknowns = count_of(self._measured), len(self._unknown)
        if count < (least := unknowns + (noise is None)):
            known = "" if noise is not None else ", or the noise be given"
            raise ValueError(f"measured must hold {least} numbers or more for {unknowns} unknowns{known}, got {count}")
        self._check_determined()
        for _ in range(PASSES):
            self._minimise()
            before, self.correlation = self.correlation, correlation_of(self.blocks)
            if abs(self.correlation - before) < SAME:
                break
        self._check_determined()
        self._progress(len(self._known), len(self._known))

    def result(self, noise: float | None, level: float) -> Identified:
        """The result, with intervals of this `level`."""
        from scipy.stats import chi2, norm, t

        covariance, squares = gauss_newton_covariance(self.blocks, self.correlation)
        free = count_of(self._measured) - len(self._unknown)
        size = noise if noise is not None else float(np.sqrt(squares / free))
        quantile = norm.ppf(0.5 + 0.5 * level) if noise is not None else t.ppf(0.5 + 0.5 * level, free)
        value, names = self.values, self.names
        covariance = (size**2 * covariance)[: len(names), : len(names)]
        error = np.sqrt(np.diag(covariance))
        least = 2.0 * LEAST * np.abs(self._start)
        at_bound = [name for name, low in zip(names, value <= least, strict=True) if low and name.startswith(POSITIVE)]
        lines = [f"{name} is at its lower bound, 0: its interval does not hold" for name in at_bound]
        if noise is not None and free > 0 and chi2.sf(squares / noise**2, free) < UNLIKELY:
            times = f"{np.sqrt(squares / free) / noise:.2g} times the noise"
            why = "the model does not fit these measurements, and the intervals are too narrow"
            lines.append(f"the residuals are {times}: {why}")
        compared = zip(self._measured, self._compared(), strict=True)
        return Identified(
            names=names,
            value=value,
            error=error,
            low=value - quantile * error,
            high=value + quantile * error,
            level=level,
            covariance=covariance,
            noise=size,
            correlation=self.correlation,
            residuals=tuple(rows[0] if isinstance(each, MeasuredSpeed) else rows for each, (rows, _) in compared),
            runs=tuple(found.run for found in self._predicted()),
            warnings=tuple(lines),
        )

    def _minimise(self) -> None:
        from scipy.optimize import least_squares

        def at(unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            self._unknown = unknown.copy()
            residual, derivative, _ = whitened(self.blocks, self.correlation)
            return residual, -derivative

        low = np.full(len(self._unknown), -np.inf)
        for index, (name, value) in enumerate(zip(self.names, self._start, strict=True)):
            if name.startswith(POSITIVE) and value > 0.0:
                low[index] = LEAST * value
        scale = np.ones(len(self._unknown))
        scale[: len(self.names)] = np.where(self._start, np.abs(self._start), 1.0)
        found = least_squares(
            lambda unknown: at(unknown)[0],
            np.maximum(self._unknown, 1.001 * low),
            jac=lambda unknown: at(unknown)[1],
            bounds=(low, np.inf),
            x_scale=scale,
            ftol=TOLERANCE,
            xtol=TOLERANCE,
            gtol=None,
            max_nfev=MOST_EVALUATIONS,
        )
        self._unknown = found.x

    def _check_determined(self) -> None:
        scale = np.where(self.values, self.values, 1.0)
        combination = undetermined(self.blocks, self.names, scale)
        if combination:
            raise ValueError(
                f"parameters must be ones that the measurements determine; these do not change with {combination}: "
                "leave one out, or measure another swim"
            )

    def _predicted(self) -> list[Predicted]:
        """The prediction of each measurement at the present values."""
        key = self.values.tobytes()
        if key not in self._known:
            at = dict(zip(self.names, self.values.tolist(), strict=True))
            self._known[key] = [self._swims.predicted(each, at) for each in self._measured]
            self._progress(len(self._known), len(self._known) + 1)
        return self._known[key]

    def _compared(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """For each measurement: measured minus predicted (T, D), and derivatives (T, D, U) of the prediction."""
        place = len(self.names)
        for each, found in zip(self._measured, self._predicted(), strict=True):
            value, by_parameters = found.value, found.derivative
            derivative = np.zeros((*value.shape, len(self._unknown)))
            if isinstance(each, MeasuredPath):
                own = slice(place, place + value.shape[1] + 1)
                value, by_parameters, derivative[..., own] = placed(found, self._unknown[own])
                place = own.stop
            derivative[..., : len(self.names)] = by_parameters
            yield each.values - value, derivative


def _blocks(time: np.ndarray, residual: np.ndarray, derivative: np.ndarray) -> Iterator[Block]:
    """A block for each column, with the instants at which it is known."""
    for column, known in enumerate(np.isfinite(residual).T):
        step = np.diff(time[known])
        if known.any():
            step = step / np.median(step) if len(step) else step
            yield Block(step, residual[known, column], derivative[known, column])


def _informative(measured: Measurement, found: Predicted, values: np.ndarray) -> Measurement:
    """A path without its height if no parameter moves the point up or down: the height's errors are then irrelevant."""
    if not isinstance(measured, MeasuredPath) or measured.position.shape[1] == 2:
        return measured
    derivative = np.abs(found.derivative * np.where(values, values, 1.0))
    if derivative[:, 2].max() > INSENSITIVE * derivative.max():
        return measured
    return replace(measured, position=measured.position[:, :2])
