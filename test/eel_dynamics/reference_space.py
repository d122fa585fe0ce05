"""Quadrature and interpolation of the reference: Gauss panels that no kink of the body straddles."""

import itertools

import numpy as np
from numpy.polynomial import legendre


class Space:
    """Gauss panels on [0, l]: nodes `x`, `weights`, and `cumulate`, the matrix of the integrals from 0 to each node."""

    def __init__(self, kinks, panels_per_span=2, nodes_per_panel=16):
        self.gauss, self.gauss_weights = legendre.leggauss(nodes_per_panel)
        self.order = nodes_per_panel
        self.spans, local = [], self.gauss
        values = legendre.legvander(local, nodes_per_panel)  # P_n at the Gauss nodes, n = 0 ... order
        # integral of P_n from -1 to xi is (P_{n+1} - P_{n-1}) / (2 n + 1), and xi + 1 for n = 0
        integrals = np.empty((nodes_per_panel, nodes_per_panel))
        integrals[:, 0] = local + 1
        for n in range(1, nodes_per_panel):
            integrals[:, n] = (values[:, n + 1] - values[:, n - 1]) / (2 * n + 1)
        local_cumulate = integrals @ self._expansion()
        x, weights, blocks = [], [], []
        for span, (start, end) in enumerate(itertools.pairwise(kinks)):
            for panel in range(panels_per_span):
                low, high = panel / panels_per_span, (panel + 1) / panels_per_span
                u, slope = low + (high - low) * (local + 1) / 2, (high - low) / 2
                if span == 0:  # graded: X = end u^2, as the radius goes like sqrt(X) at a round nose
                    nodes, slope, edges = end * u**2, end * 2 * u * slope, (end * low**2, end * high**2)
                else:
                    nodes, slope = start + (end - start) * u, (end - start) * slope * np.ones_like(u)
                    edges = (start + (end - start) * low, start + (end - start) * high)
                self.spans.append((*edges, span == 0, end, low, high, start))
                x.append(nodes), weights.append(self.gauss_weights * slope), blocks.append(local_cumulate * slope)
        self.x, self.weights, count = np.concatenate(x), np.concatenate(weights), nodes_per_panel
        self.cumulate = np.zeros((self.x.size, self.x.size))
        for panel, block in enumerate(blocks):
            rows = slice(panel * count, (panel + 1) * count)
            self.cumulate[rows, rows] = block
            self.cumulate[rows, : panel * count] = self.weights[: panel * count]

    def _expansion(self):
        """Matrix from values at the Gauss nodes of a panel to the coefficients of P_0 ... P_{order-1}."""
        degree = np.arange(self.order)
        return ((2 * degree + 1) / 2)[:, None] * legendre.legvander(self.gauss, self.order - 1).T * self.gauss_weights

    def evaluate(self, field, stations, derivative=False):
        """Values (or d/dX) of the panels' polynomials at the stations; at an edge, of the panel that ends there."""
        out, expand = [], self._expansion()
        for station in np.atleast_1d(stations):
            panel = next((p for p, s in enumerate(self.spans) if station <= s[1]), len(self.spans) - 1)
            _, _, graded, end, low, high, start = self.spans[panel]
            u = np.sqrt(station / end) if graded else (station - start) / (end - start)
            xi, rate = 2 * (u - low) / (high - low) - 1, 2 / (high - low)
            rate = rate / (2 * end * u) if graded and u > 0 else rate / (end - start)
            coefficients = expand @ field[panel * self.order : (panel + 1) * self.order]
            out.append(
                rate * legendre.legval(xi, legendre.legder(coefficients))
                if derivative
                else legendre.legval(xi, coefficients)
            )
        return np.array(out)
