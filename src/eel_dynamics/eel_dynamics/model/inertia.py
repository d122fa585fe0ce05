# SPDX-License-Identifier: Apache-2.0
"""Inertia (6, 6) of the straight body with its water, and the refusal of bodies with a singular inertia.

Rotations are scaled by the body's length, so that all entries are masses [kg] and the condition number has no unit. The
straight shape has the least inertia in roll, as a bent shape has lever arms. A condition number above `MOST` leaves
less than four digits of an acceleration in double precision, and counts as singular.
"""

import numpy as np

from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.section_data import SectionData

MOST = 1e12
PART = 0.25  # of a singular direction: a degree of freedom with a larger part is named
FREEDOMS = "roll", "pitch", "yaw", "surge", "sway", "heave"
PLANE = 2, 3, 4


def straight_inertia(
    grid: Grid, sections: SectionData, nose_mass: float, length: float, offset: bool = False
) -> np.ndarray:
    """Inertia (6, 6) [kg] of a straight body about the head, rotation first.

    sections: `SectionData` at the nodes of `grid`. nose_mass: m_o [kg]. length: [m], of the body. offset: whether its
    centre of mass is off the axis.
    """
    x, weight, square = grid.x / length, grid.weight, length * length  # infinite if a power overflows
    roll, pitch, yaw = (
        float(weight @ each) / square for each in (sections.inertia1, sections.inertia2, sections.inertia3)
    )
    along2, along3 = sections.mass + sections.added2, sections.mass + sections.added3
    matrix = np.diag(
        [
            roll,
            pitch + weight @ (along3 * x * x),
            yaw + weight @ (along2 * x * x),
            weight @ sections.mass + nose_mass,
            weight @ along2,
            weight @ along3,
        ]
    )
    matrix[2, 4] = matrix[4, 2] = weight @ (along2 * x)
    matrix[1, 5] = matrix[5, 1] = -(weight @ (along3 * x))
    lever = offset * sections.lever / length
    matrix[0, 2] = matrix[2, 0] = weight @ (lever * x)
    matrix[0, 4] = matrix[4, 0] = weight @ lever
    matrix[1, 3] = matrix[3, 1] = -(weight @ lever)
    return matrix


def condition_of(matrix: np.ndarray) -> float:
    """The greatest eigenvalue of a symmetric positive `matrix` divided by the least; infinite if it is singular."""
    value = np.linalg.eigvalsh(matrix)
    return float(value[-1] / value[0]) if value[0] > 0.0 else np.inf


def check_inertia(
    grid: Grid, sections: SectionData, nose_mass: float, length: float, planar: bool, offset: bool = False
) -> None:
    """`ValueError` that names the degrees of freedom without inertia. Arguments as in `straight_inertia`."""
    free = list(PLANE) if planar else list(range(6))
    matrix = straight_inertia(grid, sections, nose_mass, length, offset)[np.ix_(free, free)]
    if not np.isfinite(matrix).all():
        raise ValueError("body is too large or too dense for numbers: its inertia is not finite")
    value, direction = np.linalg.eigh(matrix)
    none = value * MOST <= value[-1]
    if not none.any():
        return
    part = np.sum(direction[:, none] ** 2, axis=1)
    names = ", ".join(FREEDOMS[each] for each, share in zip(free, part, strict=True) if share > PART)
    raise ValueError(
        f"body has no inertia in {names}: its matrix of inertia is singular (condition {condition_of(matrix):.2g}, of "
        f"{MOST:g} at most); make it thicker, denser, or give it a nose"
    )
