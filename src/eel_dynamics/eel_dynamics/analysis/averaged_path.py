# SPDX-License-Identifier: Apache-2.0
"""The path of a swimmer averaged over a period of its gait, and the excursion of the tail across it.

The averaged centre of mass moves with |c(t + T) - c(t)| / T. Kern and Koumoutsakos, J. Exp. Biol. 209 (2006), average
over a cycle in the same way.
"""

import numpy as np
from eel_common.cached import cached_property

from eel_dynamics.analysis.averaging_window import AveragingWindow
from eel_dynamics.analysis.powers import area


class AveragedPath:
    """The averaged path in a `window`. A window of a single period holds one step of it, from its start to its end.

    Paths are evaluated at N equidistant instants, with n of them in each period.
    """

    def __init__(self, window: AveragingWindow):
        self._window = window
        self._instants = window.instants
        self._period = (len(self._instants) - 1) // window.periods  # instants

    def mean_speed(self) -> float:
        """[m/s], as `Analysis.mean_speed`."""
        speed = self._step_lengths / self._window.period
        time = self._instants[: len(speed)]
        return float(area(speed, time) / (time[-1] - time[0]) if len(speed) > 1 else speed[0])

    def speed_change(self) -> float | None:
        """Change [m/s] of the speed from the first period of the window to its last, as `Analysis.speed_change`."""
        window, period, ways = self._window, self._window.period, self._step_lengths
        first = ways[0]
        if window.periods == 1:
            if window.start - period < window.run.time[0] - 1e-9 * period:
                return None
            first = np.linalg.norm(np.subtract(*window.paths((window.start, window.start - period))[:, 0]))
        return float(abs(ways[-1] - first) / period)

    def speeds(self, edges: np.ndarray) -> np.ndarray:
        """(n,) [m/s], of the averaged centre over the periods between the `edges` (n + 1,) [s]."""
        return np.linalg.norm(np.diff(self._window.paths(edges)[:, 0], axis=0), axis=1) / np.diff(edges)

    def tail_excursion(self, moves: bool) -> float:
        """[m], as `Analysis.tail_excursion`. moves: whether there is a path to measure across.

        `ValueError` if the last station is not the tail.
        """
        run, window, n = self._window.run, self._window, self._period
        if abs(run.x[-1] - run.body.length) > 1e-9 * run.body.length:
            raise ValueError(
                f"run must have a station at the tail, X = {run.body.length:g} m, got the last at {run.x[-1]:g} m"
            )
        tail = self._paths[:, 1]
        if window.periods == 1:
            apart = tail - tail[0] - np.linspace(0.0, 1.0, len(tail))[:, None] * (tail[-1] - tail[0])
        else:
            total = window.paths.antiderivative()(self._instants)[:, 1]
            apart = tail[n // 2 : -(n // 2)] - (total[n:] - total[:-n]) / window.period
        if moves:
            along = self._steps / self._step_lengths[:, None]
            apart = apart - np.sum(apart * along, axis=1, keepdims=True) * along
        beats = np.stack([apart[begin : begin + n + 1] for begin in range(0, len(apart) - 1, n)])
        return float(np.mean(_widths(beats)))

    @cached_property
    def _paths(self) -> np.ndarray:
        """(N, 2, 3) [m], as `AveragingWindow.paths`."""
        return np.asarray(self._window.paths(self._instants))

    @cached_property
    def _steps(self) -> np.ndarray:
        """(N - n, 3) [m], displacement of the centre of mass over the water in the period after each instant."""
        centre = self._paths[:, 0]
        return np.asarray(centre[self._period :] - centre[: -self._period])

    @cached_property
    def _step_lengths(self) -> np.ndarray:
        return np.linalg.norm(self._steps, axis=1)


def _widths(points: np.ndarray) -> np.ndarray:
    """(B,) [m], the greatest distance between two of the points (B, n, 3) in each beat."""
    squares = np.sum(points**2, axis=2)
    apart = squares[:, :, None] + squares[:, None] - 2.0 * points @ points.transpose(0, 2, 1)
    return np.sqrt(np.maximum(0.0, np.max(apart, axis=(1, 2))))
