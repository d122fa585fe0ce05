# SPDX-License-Identifier: Apache-2.0
"""The curvature law on the grid: rows along the body times factors of time.

Every law is a sum of fields of X times functions of time alone,

    K_d(t, X) = sum_m c_m(t) row_m(X),

since sin(kX + phase - wt) = sin(kX + phase) cos wt - cos(kX + phase) sin wt. The rows are tabulated once: at the nodes,
at the stations, and as the Magnus moments of the intervals that lead to both. An instant needs only the factors c_m.
The difference between a motion and its successor, and the quintic between two samples of a controller, have the same
form. `eel_core.LawOnGrid` holds both and evaluates them.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import factors_of
from eel_gaits.laws.spline import natural_spline
from eel_gaits.laws.term import LAW_ROW, amplitude_of

import eel_core
from eel_dynamics.accuracy.law_waves import groups_of

SEGMENT_AXES = np.repeat((0, 1), 6)  # of the rows of a quintic between two samples
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(10)  # Gauss points per interval, for the Magnus moments


class Tabulation:
    """Points along the body at which rows are tabulated, and their Magnus moments.

    columns: [nodes n | moments of nodes 3n | stations s | moments of stations 3s | further points p]
    """

    def __init__(
        self,
        nodes: np.ndarray,
        previous: np.ndarray,
        stations: np.ndarray,
        station_base: np.ndarray,
        further: np.ndarray | tuple[()] = (),
    ):
        self.nodes, self.stations, self.further = len(nodes), len(stations), len(further)
        start, end = np.concatenate((previous, station_base)), np.concatenate((nodes, stations))
        self._length = end - start
        inside = 0.5 * (start + end)[:, None] + 0.5 * self._length[:, None] * POINTS
        self.x = np.concatenate((nodes, stations, inside.ravel(), further))
        b0, b1, b2 = 0.5 * WEIGHTS, 0.25 * WEIGHTS * POINTS, 0.125 * WEIGHTS * POINTS**2
        self._moments = np.stack((b0, 12.0 * b1, 180.0 * b2 - 15.0 * b0))  # B0, alpha2, alpha3 per unit length

    @property
    def width(self) -> int:
        """Numbers in a tabulated row."""
        return 4 * (self.nodes + self.stations) + self.further

    def columns(self, values: np.ndarray) -> np.ndarray:
        """Tabulated rows (..., width) of fields with `values` (..., len(x)) at the points x."""
        n, s = self.nodes, self.stations
        inside = values[..., n + s : (n + s) * (1 + len(POINTS))].reshape(*values.shape[:-1], n + s, len(POINTS))
        moments = np.einsum("...ig,kg->...ki", inside, self._moments) * self._length
        flat = values.shape[:-1]
        return np.concatenate(
            (
                values[..., :n],
                moments[..., :n].reshape(*flat, 3 * n),
                values[..., n : n + s],
                moments[..., n:].reshape(*flat, 3 * s),
                values[..., values.shape[-1] - self.further :],
            ),
            axis=-1,
        )

    def weights_of(self, points: np.ndarray) -> np.ndarray:
        """Tabulated rows (n, width) of the natural cubic splines that are 1 at one of the `points` (n,) [m] each."""
        return np.ascontiguousarray(self.columns(natural_spline(points, np.eye(len(points)), self.x)))

    def law_tables(self, rows: np.ndarray, axis: Any) -> eel_core.LawTables:
        """Tabulated `rows` (m, width) of the axes `axis` (m,) (0 pitch, 1 yaw), for the core."""
        rows = np.ascontiguousarray(rows[:, : self.width - self.further])
        return eel_core.LawTables(np.asarray(axis).tolist(), rows, self.nodes, self.stations)


class TabulatedLaw(NamedTuple):
    """A source of curvature: m rows on the grid, and the data of their factors. It never changes."""

    rows: np.ndarray  # (m, width), as from `Tabulation.columns`
    axis: np.ndarray  # (m,) axis of each row, 0 pitch, 1 yaw
    tables: eel_core.LawTables | None = None  # the rows for the core, if several runs share them
    waves: tuple[Any, ...] = ()  # as for `eel_core.LawOnGrid`: period [s], envelope, rows of sine and cosine
    origin: float = 0.0  # s, simulation time of the law's own t = 0
    segment: tuple[float, float] | None = None  # s, of the quintic between two samples of a controller
    law: Law | None = None  # the tabulated law
    ramp_ends: tuple[float, ...] = ()  # s of the law's own time: beginnings and ends of ramps

    @staticmethod
    def of_law(law: Law | None, origin: float, tabulation: Tabulation) -> "TabulatedLaw":
        """Tabulate `law`, whose own t = 0 is at `origin` [s]."""
        return _tabulated(law, tabulation)._replace(origin=origin)

    @staticmethod
    def constant(value: np.ndarray) -> "TabulatedLaw":
        """A constant shape. value (2, width): its rows in pitch and yaw."""
        return TabulatedLaw(np.array(value), np.arange(2), waves=tuple((0.0, (), row, row) for row in range(2)))

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Times [s] at which a derivative of the source jumps."""
        return self.segment or tuple(self.origin + time for time in self.ramp_ends)


@lru_cache(maxsize=1024)
def _tabulated(law: Law | None, tabulation: Tabulation) -> TabulatedLaw:
    """`law`, or the straight shape without one. Terms of equal axis, period and envelope share their rows. Laws that
    differ only in periods and envelopes share their tables."""
    groups = groups_of(law) if law is not None else {}
    if not groups:
        straight = TabulatedLaw.constant(np.zeros((2, tabulation.width)))
        return straight._replace(tables=tabulation.law_tables(straight.rows, straight.axis))
    moving = tuple((axis, period > 0.0, tuple(terms)) for (axis, period, _), terms in groups.items())
    rows, axis, tables, sine, cosine = _rows_of(moving, tabulation)
    envelopes = [
        [[(ramp.start, ramp.end, ramp.delta) for ramp in factor] for factor in factors_of(envelope)]
        for _, _, envelope in groups
    ]
    periods = [period for _, period, _ in groups]
    waves = tuple(zip(periods, envelopes, sine, cosine, strict=True))
    ends = {time for _, _, envelope in groups for ramp in envelope for time in (ramp.start, ramp.end)}
    return TabulatedLaw(rows, axis, tables, waves, law=law, ramp_ends=tuple(sorted(ends)))


@lru_cache(maxsize=1024)
def _rows_of(groups: tuple[Any, ...], tabulation: Tabulation) -> tuple[Any, ...]:
    """Rows of `groups` of terms (axis, whether they have a period, their waveforms), their axes and tables, and for
    each group the rows of its sine and cosine."""
    rows: list[np.ndarray] = []
    axis, sine, cosine = [], [], []
    for name, moving, waveforms in groups:
        angle = [wave_number * tabulation.x + phase for _, _, wave_number, phase in waveforms]
        amplitude = [amplitude_of(values, knots, tabulation.x) for values, knots, _, _ in waveforms]
        sine.append(len(rows))
        rows.append(sum(a * np.sin(b) for a, b in zip(amplitude, angle, strict=True)))
        cosine.append(len(rows) if moving else sine[-1])
        if moving:
            rows.append(sum(a * np.cos(b) for a, b in zip(amplitude, angle, strict=True)))
        axis += [LAW_ROW[name]] * (2 if moving else 1)
    tabulated = tabulation.columns(np.array(rows))
    return tabulated, np.array(axis), tabulation.law_tables(tabulated, axis), tuple(sine), tuple(cosine)
