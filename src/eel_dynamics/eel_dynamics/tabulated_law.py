"""The shape that drives the body: laws, samples of a controller, and the blends between them, as rows times factors.

Every law is a sum of fields of X times functions of time alone,

    K(t, X) = sum_m c_m(t) row_m(X),

since sin(kX + phase - wt) = sin(kX + phase) cos wt - cos(kX + phase) sin wt. The rows are tabulated once: at the nodes,
at the stations, and as the Magnus moments of the intervals that lead to both; an instant needs the factors c_m only.
The difference between a motion and the law that takes over, and the quintic between two instants of a controller, are
of the same form.
"""

import numpy as np

import eel_core

AXES = {"pitch": 0, "yaw": 1}
MOMENT_POINTS = 10  # Gauss points per interval for the Magnus moments


class Tabulation:
    """Points along the body at which rows are tabulated, and their Magnus moments.

    columns: [nodes n | moments of nodes 3n | stations s | moments of stations 3s]
    """

    def __init__(self, nodes: np.ndarray, previous: np.ndarray, stations: np.ndarray, station_base: np.ndarray):
        self.nodes, self.stations = len(nodes), len(stations)
        points, weights = np.polynomial.legendre.leggauss(MOMENT_POINTS)
        start, end = np.concatenate((previous, station_base)), np.concatenate((nodes, stations))
        self._length = end - start
        inside = 0.5 * (start + end)[:, None] + 0.5 * self._length[:, None] * points
        self.x = np.concatenate((nodes, stations, inside.ravel()))
        b0, b1, b2 = 0.5 * weights, 0.25 * weights * points, 0.125 * weights * points**2
        self._moments = np.stack((b0, 12.0 * b1, 180.0 * b2 - 15.0 * b0))  # B0, alpha2, alpha3 per unit length

    @property
    def width(self) -> int:
        return 4 * (self.nodes + self.stations)

    def columns(self, values: np.ndarray) -> np.ndarray:
        """Tabulated rows (..., width) of fields with `values` (..., len(x)) at the points x."""
        n, s = self.nodes, self.stations
        inside = values[..., n + s :].reshape(*values.shape[:-1], n + s, MOMENT_POINTS)
        moments = np.einsum("...ig,kg->...ki", inside, self._moments) * self._length
        flat = values.shape[:-1]
        return np.concatenate(
            (
                values[..., :n],
                moments[..., :n].reshape(*flat, 3 * n),
                values[..., n : n + s],
                moments[..., n:].reshape(*flat, 3 * s),
            ),
            axis=-1,
        )

    def law_tables(self, rows: np.ndarray, axis) -> eel_core.LawTables:
        """Tabulated `rows` (m, width) of the axes `axis` (m,) (0 pitch, 1 yaw), for the compiled mechanics."""
        n, s, m = self.nodes, self.stations, len(rows)
        node, moments, station, station_moments = np.split(rows, [n, 4 * n, 4 * n + s], axis=1)
        moments, station_moments = moments.reshape(m, 3, n), station_moments.reshape(m, 3, s)
        tables = node, np.cumsum(moments[:, 0], axis=1), moments, station, station_moments
        return eel_core.LawTables([int(each) for each in axis], *(np.ascontiguousarray(table) for table in tables))
