# SPDX-License-Identifier: Apache-2.0
"""The path of a swimmer averaged over a period of its gait, and the excursion of the tail across it.

The averaged centre of mass moves with |c(t + T) - c(t)| / T (Kern and Koumoutsakos, J. Exp. Biol. 209 (2006), average
over a cycle likewise).
"""

import numpy as np

from eel_dynamics.analysis.averaging_window import AveragingWindow
from eel_dynamics.analysis.powers import area


class AveragedPath:
    """The averaged path in a `window`. A window of a single period holds one step of it, from its start to its end."""

    def __init__(self, window: AveragingWindow):
        self._window = window

    def mean_speed(self) -> float:
        """[m/s], as `Analysis.mean_speed`."""
        window, period = self._window, self._window.period
        if window.periods == 1:
            return float(np.linalg.norm(self._way(window.start, window.end))) / period
        time = window.instants(window.start, window.end - period)
        speed = np.linalg.norm(self._way(time, time + period), axis=1)
        return float(area(speed, time)) / period / (time[-1] - time[0])

    def speed_change(self) -> float | None:
        """Change [m/s] of the speed from the first period of the window to its last, as `Analysis.speed_change`."""
        window, period = self._window, self._window.period
        first = window.start if window.periods > 1 else window.start - period
        if first < window.run.time[0] - 1e-9 * period:
            return None
        start = np.array([first, window.end - period])
        before, after = np.linalg.norm(self._way(start, start + period), axis=1)
        return float(abs(after - before) / period)

    def speeds(self, edges: np.ndarray) -> np.ndarray:
        """(n,) [m/s], of the averaged centre over the periods between the `edges` (n + 1,) [s]."""
        return np.linalg.norm(self._way(edges[:-1], edges[1:]), axis=1) / np.diff(edges)

    def tail_excursion(self, moves: bool) -> float:
        """[m], as `Analysis.tail_excursion`. moves: whether there is a path to measure across."""
        window, period = self._window, self._window.period
        if window.periods == 1:
            time = window.instants(window.start, window.end)
            chord = window.tail(window.end) - window.tail(window.start)
            apart = window.tail(time) - np.outer((time - time[0]) / period, chord)
            way = self._way(window.start, window.end)
            return _width(_across(apart, np.broadcast_to(way, apart.shape), moves))
        half = 0.5 * period
        starts = window.start + half + np.arange(window.periods - 1) * period
        time = np.linspace(starts, starts + period, len(window.instants(0.0, period)), axis=1)  # a row for each beat
        apart = window.tail(time) - window.averaged_tail(time)
        return float(np.mean([_width(beat) for beat in _across(apart, self._way(time - half, time + half), moves)]))

    def _way(self, start, end) -> np.ndarray:
        """Displacement (..., 3) [m] of the centre of mass over the water, from the times `start` to `end` (...) [s]."""
        return self._window.center_of_mass(end) - self._window.center_of_mass(start)


def _across(apart: np.ndarray, way: np.ndarray, moves: bool) -> np.ndarray:
    """`apart` (..., 3) [m] less its part along `way` (..., 3)."""
    if not moves:
        return apart
    along = way / np.linalg.norm(way, axis=-1, keepdims=True)
    return apart - np.sum(apart * along, axis=-1, keepdims=True) * along


def _width(points: np.ndarray) -> float:
    """Greatest distance [m] between two of the `points` (n, 3)."""
    from scipy.spatial.distance import pdist

    return float(np.max(pdist(points)))
