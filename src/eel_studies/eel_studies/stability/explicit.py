# SPDX-License-Identifier: Apache-2.0
"""Why the added mass is part of the inertia matrix: with an explicit treatment, light bodies are unstable.

A wrench w acts on a straight body at rest. Implicit treatment solves (I_b + I_f) a = w. Explicit treatment, as with a
separate solver for the water, iterates I_b a[n+1] = w - I_f a[n] with the acceleration of the previous step. The error
grows in each step by the greatest eigenvalue of I_b^-1 I_f, however short the step is.
"""

from typing import NamedTuple

import numpy as np
from eel_model.body.body import Body
from eel_model.body.grid import Grid
from eel_model.body.panels import panels_of
from eel_model.inertia import straight_inertia
from eel_model.scene import Scene
from eel_model.section_data import sections_on

STEPS = 20
WRENCH = np.array([1e-3, -1e-2, -1e-2, 1.0, 1.0, 1.0])  # N m, N


class Treated(NamedTuple):
    """Result for one body.

    ratio: density relative to water. growth: factor of the explicit error per step. explicit: magnitude of the explicit
    acceleration after `STEPS` steps, relative to the correct one. condition: of the 6 x 6 matrix, in units of the
    body's length.
    """

    ratio: float
    growth: float
    explicit: float
    condition: float


def treat(ratio: float, body: Body | None = None, fluid_density: float = 1000.0) -> Treated:
    """Solve for the acceleration of a straight `body` under a wrench, with both treatments.

    ratio: density of the body relative to water. body: None: the paper's robot. fluid_density: [kg/m^3].
    """
    of_body, of_fluid = inertias(body or Body.boyer2010(), ratio * fluid_density, fluid_density)
    both = of_body + of_fluid
    right = np.linalg.solve(both, WRENCH)
    present = np.zeros(6)
    for _ in range(STEPS):
        present = np.linalg.solve(of_body, WRENCH - of_fluid @ present)
    growth = np.abs(np.linalg.eigvals(np.linalg.solve(of_body, of_fluid))).max()
    explicit = np.linalg.norm(present) / np.linalg.norm(right)
    return Treated(ratio, float(growth), float(explicit), float(np.linalg.cond(both)))


def inertias(body: Body, density: float, fluid_density: float) -> tuple[np.ndarray, np.ndarray]:
    """Inertia matrices (6, 6) of the straight body and of its added mass, about the head, rotation first.

    Densities are in kg/m^3. Rotations are scaled by the body's length, so that all entries are masses [kg].
    """
    grid = Grid.of(panels_of(body, 40.0))
    sections = sections_on(body, Scene(density=density, fluid_density=fluid_density), grid)
    none = np.zeros_like(sections.mass)
    dry = sections._replace(added2=none, added3=none, inertia1=sections.inertia1 - sections.added_roll)
    body_alone, added = (straight_inertia(grid, each, 0.0, body.length) for each in (dry, sections.of_water()))
    return body_alone, added
