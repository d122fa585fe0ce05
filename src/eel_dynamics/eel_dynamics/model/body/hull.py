# SPDX-License-Identifier: Apache-2.0
"""The effect of a section's shape on the water: cross flow, and added mass in separated flow. For blunt, jointed
robots.

The roundness of a section is s = min(a, b) / max(a, b), 0 for a plate and 1 for a circle. Broadside is motion normal to
the section's longer axis.

    cross flow by shape   broadside 1.98 - 0.78 s, along the long axis 1.0 + 0.2 s      (k2 = 2 c_2 a, k3 = 2 c_3 b)
    added mass            times beta(s) = 1 - (1 - C_a) s^2, on both axes alike

A long plate has 1.98 and a circular cylinder 1.20 (Matthews, Aeronautical Engineer's Data Book, p. 95); 1.0 edge on is
the paper's c_3. C_a is the added mass of a circular cylinder in cross flow divided by that of potential flow: 1 for
attached flow; about 0.2 in oscillating flow with KC 8 to 20 (Sarpkaya, OTC 2533, 1976). Plates keep theirs (Keulegan
and Carpenter 1958). The interpolation of beta with s^2 is our own; it was chosen with knowledge of both gaits of the
robot Mamba. Both axes have the same factor, as a round section must be isotropic.
"""

from itertools import pairwise
from typing import Any

import numpy as np

BY_SHAPE = "by shape"  # value of `Body.lateral_drag` and `vertical_drag`
PLATE, ROUND, EDGE_ON = 1.98, 1.20, 1.0  # drag coefficients across a plate and a circular cylinder, and along a plate
SEPARATED = 0.2  # C_a of a body of links
CUT = 1e-9  # of the greatest half-axis: least difference on both sides of a crossing


def roundness_squared(a_squared: np.ndarray, b_squared: np.ndarray) -> np.ndarray:
    """s^2 (n,) of sections from the squares of their half-axes (n,) [m^2]; 0 where both are 0."""
    least, most = np.minimum(a_squared, b_squared), np.maximum(a_squared, b_squared)
    return np.asarray(np.divide(least, most, out=np.zeros_like(most), where=most > 0.0))


def cross_flow_by_shape(a_squared: np.ndarray, b_squared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """c_2 and c_3 (n,) of sections by their roundness, from the squares of their half-axes (n,) [m^2]."""
    s = np.sqrt(roundness_squared(a_squared, b_squared))
    broadside, along = PLATE - (PLATE - ROUND) * s, EDGE_ON + (ROUND - EDGE_ON) * s
    high = a_squared >= b_squared
    return np.where(high, broadside, along), np.where(high, along, broadside)


def attached(round_added_mass: float, a_squared: np.ndarray, b_squared: np.ndarray) -> np.ndarray:
    """beta (n,): added mass / that of potential flow. round_added_mass: C_a."""
    return 1.0 - (1.0 - round_added_mass) * roundness_squared(a_squared, b_squared)


def crossings(body: Any, bounds: tuple[float, ...]) -> list[float]:
    """X [m] inside the body where sections change between higher than wide and wider than high: there, laws by shape
    have a kink."""
    x = np.unique(np.concatenate([np.linspace(*ends, 257) for ends in pairwise(bounds)]))
    found: list[float] = []

    def more(at: Any) -> Any:
        return body.half_height(at) - body.half_width(at)

    values = more(x)
    least = CUT * max(float(np.max(body.half_height(x))), float(np.max(body.half_width(x))))
    known = np.flatnonzero(np.abs(values) > least)
    for before, behind in pairwise(known):
        if values[before] * values[behind] < 0.0:
            low, high = float(x[before]), float(x[behind])
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (
                    (middle, high) if float(more(np.array([middle]))[0]) * values[before] > 0.0 else (low, middle)
                )
            found.append(0.5 * (low + high))
    return found
