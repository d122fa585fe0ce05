# SPDX-License-Identifier: Apache-2.0
"""Quadrature and interpolation of the reference: Gauss panels that no kink of the body straddles."""

import itertools

import numpy as np
from numpy.polynomial import legendre


class Space:
    """Gauss panels on [0, l]: nodes `x` (N,), `weights` (N,), integrals from 0 to each node, values and slopes between.

    The first span is graded, X = end u^2, as the body's radius goes like sqrt(X) at a round nose; fields (N, ...) are
    polynomials in u on its panels, and in X on the others.
    """

    def __init__(self, kinks, panels_per_span=2, nodes_per_panel=16):
        self.order = nodes_per_panel
        gauss, self.gauss_weights = legendre.leggauss(nodes_per_panel)
        degree, values = np.arange(nodes_per_panel), legendre.legvander(gauss, nodes_per_panel)
        # from the values at a panel's nodes to the coefficients of P_0 ... P_{order - 1}
        self.expand = ((2 * degree + 1) / 2)[:, None] * values[:, :-1].T * self.gauss_weights
        # integral of P_n from -1 to xi: (P_{n+1} - P_{n-1}) / (2 n + 1), and xi + 1 for n = 0
        integrals = np.empty((nodes_per_panel, nodes_per_panel))
        integrals[:, 0] = gauss + 1
        for n in range(1, nodes_per_panel):
            integrals[:, n] = (values[:, n + 1] - values[:, n - 1]) / (2 * n + 1)
        self.local = integrals @ self.expand  # integrals over xi from -1 to each node of a panel

        cuts = np.linspace(0, 1, panels_per_span + 1)
        self.spans = [
            (span == 0, start, end, low, high)
            for span, (start, end) in enumerate(itertools.pairwise(kinks))
            for low, high in itertools.pairwise(cuts)
        ]
        x, slope = zip(*(_position(span, gauss) for span in self.spans), strict=True)
        self.x, self.slope = np.concatenate(x), np.concatenate(slope)  # slope: dX/dxi
        self.weights = np.tile(self.gauss_weights, len(self.spans)) * self.slope
        self.ends = np.array([_position(span, np.array([1.0]))[0][0] for span in self.spans])

    def cumulate(self, field):
        """Integrals of the field (N, ...) over X from 0 to each node."""
        panels = (field.reshape(len(field), -1) * self.slope[:, None]).reshape(len(self.spans), self.order, -1)
        wholes = np.tensordot(self.gauss_weights, panels, axes=(0, 1))
        before = np.cumsum(wholes, axis=0) - wholes
        return (self.local @ panels + before[:, None, :]).reshape(field.shape)

    def evaluate(self, field, stations, derivative=False):
        """Values (or d/dX) of the panels' polynomials at the stations; at an edge, of the panel that ends there."""
        stations = np.atleast_1d(np.asarray(stations, float))
        home = np.searchsorted(self.ends[:-1], stations)
        out = np.empty((len(stations), *field.shape[1:]))
        for panel in np.unique(home):
            graded, start, end, low, high = self.spans[panel]
            x, here = stations[home == panel], slice(panel * self.order, (panel + 1) * self.order)
            u = np.sqrt(x / end) if graded else (x - start) / (end - start)
            xi = 2 * (u - low) / (high - low) - 1
            coefficients = np.tensordot(self.expand, field[here], axes=1)
            values = legendre.legval(xi, legendre.legder(coefficients) if derivative else coefficients)
            scale = np.maximum(_position(self.spans[panel], xi)[1], 1e-12) if derivative else 1.0
            out[home == panel] = np.moveaxis(values / scale, -1, 0)
        return out


def _position(span, xi):
    """X and dX/dxi at xi in -1 ... 1 of a panel (graded, start and end of its span, low and high u of the panel)."""
    graded, start, end, low, high = span
    u, rate = low + (high - low) * (xi + 1) / 2, (high - low) / 2
    return (end * u**2, 2 * end * u * rate) if graded else (start + (end - start) * u, (end - start) * rate + 0 * u)
