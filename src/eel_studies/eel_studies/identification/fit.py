# SPDX-License-Identifier: Apache-2.0
"""The least-squares problem of `identify`: unknowns, residuals, and how they are brought to their least."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from eel_dynamics.runs.run import Run

from eel_studies.identification.measurements import MeasuredPath, MeasuredSpeed, Measurement, count_of
from eel_studies.identification.prediction import Predicted, Swims, placed, placement_of
from eel_studies.identification.statistics import Block, correlation_of, undetermined, whitened

POSITIVE = ("body.", "scene.", "robot.")  # parameters that stay above 0
LEAST = 1e-6  # of the first guess, in place of 0
PASSES = 4  # of the fit, each with the correlation of the one before
SAME = 0.01  # change of the correlation that needs no further pass
INSENSITIVE = 1e-8  # relative derivative of an axis below which no parameter moves the point along it
TOLERANCE = 1e-6  # of the unknowns and of the sum of squares, relative
MOST_EVALUATIONS = 50  # of the model, in a pass


class Fit:
    """Fits parameters, from their values `first`, to what was `measured`. `ValueError`: they are not determined."""

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
        """The parameters (P,) reached."""
        return self._unknown[: len(self.names)]

    @property
    def count(self) -> int:
        """Measured numbers that tell something."""
        return count_of(self._measured)

    @property
    def unknowns(self) -> int:
        """Parameters and placements."""
        return len(self._unknown)

    @property
    def at_bound(self) -> list[str]:
        """Parameters that the measurements put at 0 or below."""
        low = 2.0 * LEAST * np.abs(self._start)
        return [self.names[k] for k in np.flatnonzero(self.values <= low) if self.names[k].startswith(POSITIVE)]

    @property
    def runs(self) -> tuple[Run, ...]:
        """The swims with the values reached."""
        return tuple(found.run for found in self._predicted())

    @property
    def residuals(self) -> tuple[np.ndarray, ...]:
        """Measured less predicted: (T, D) of a path, (T, J) of angles, (1,) of a speed."""
        found = zip(self._measured, self._compared(), strict=True)
        return tuple(table[0] if isinstance(each, MeasuredSpeed) else table for each, (table, _) in found)

    @property
    def blocks(self) -> list[Block]:
        """Residuals and derivatives at the values reached."""
        found = zip(self._measured, self._compared(), strict=True)
        return [block for each, compared in found for block in _blocks(each.time, *compared)]

    def check_count(self, noise: float | None) -> None:
        """`ValueError` where the measurements are too few for the unknowns."""
        least = self.unknowns + (noise is None)
        if self.count < least:
            known = "" if noise is not None else ", or the noise be given"
            raise ValueError(
                f"measured must hold {least} numbers or more for {self.unknowns} unknowns{known}, got {self.count}"
            )

    def solve(self) -> None:
        """Minimise the sum of squares, with errors as they are correlated. `ValueError`: singular."""
        self._check_determined()
        for _ in range(PASSES):
            self._minimise()
            before, self.correlation = self.correlation, correlation_of(self.blocks)
            if abs(self.correlation - before) < SAME:
                break
        self._check_determined()
        self._progress(len(self._known), len(self._known))

    def _minimise(self) -> None:
        from scipy.optimize import least_squares

        def at(unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            self._unknown = unknown.copy()
            residual, derivative, _ = whitened(self.blocks, self.correlation)
            return residual, -derivative

        low = np.full(self.unknowns, -np.inf)
        for index, (name, value) in enumerate(zip(self.names, self._start, strict=True)):
            if name.startswith(POSITIVE) and value > 0.0:
                low[index] = LEAST * value
        scale = np.ones(self.unknowns)
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
        """Of each measurement, at the values reached."""
        key = self.values.tobytes()
        if key not in self._known:
            at = dict(zip(self.names, self.values.tolist(), strict=True))
            self._known[key] = [self._swims.predicted(each, at) for each in self._measured]
            self._progress(len(self._known), len(self._known) + 1)
        return self._known[key]

    def _compared(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Of each measurement: measured less predicted (T, D), and derivatives (T, D, U) of what is predicted."""
        place = len(self.names)
        for each, found in zip(self._measured, self._predicted(), strict=True):
            value, by_parameters = found.value, found.derivative
            derivative = np.zeros((*value.shape, self.unknowns))
            if isinstance(each, MeasuredPath):
                own = slice(place, place + value.shape[1] + 1)
                value, by_parameters, derivative[..., own] = placed(found, self._unknown[own])
                place = own.stop
            derivative[..., : len(self.names)] = by_parameters
            yield each.values - value, derivative


def _blocks(time: np.ndarray, residual: np.ndarray, derivative: np.ndarray) -> Iterator[Block]:
    """A block for each column, of the instants at which it is known."""
    for column, known in enumerate(np.isfinite(residual).T):
        step = np.diff(time[known])
        if known.any():
            step = step / np.median(step) if len(step) else step
            yield Block(step, residual[known, column], derivative[known, column])


def _informative(measured: Measurement, found: Predicted, values: np.ndarray) -> Measurement:
    """A path without its height, where no parameter moves the point up or down: its errors tell nothing then."""
    if not isinstance(measured, MeasuredPath) or measured.position.shape[1] == 2:
        return measured
    derivative = np.abs(found.derivative * np.where(values, values, 1.0))
    if derivative[:, 2].max() > INSENSITIVE * derivative.max():
        return measured
    return replace(measured, position=measured.position[:, :2])
