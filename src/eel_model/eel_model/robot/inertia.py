# SPDX-License-Identifier: Apache-2.0
"""Inertia of the modes of a straight body in its water, with the head free: what makes steps short, or modes singular.

In one plane, with Theta_a the angle and D_a the deflection that mode a gives the sections (Theta' = B, D' = Theta; the
head's rows are Theta, D = 1, x and 0, 1),

    M_ab = integral (J Theta_a Theta_b + m D_a D_b) dX + armature,

J, m: inertia of the section about the plane's normal, and mass with added mass along the deflection.
"""

from itertools import pairwise

import numpy as np
from eel_base.wording import shown
from numpy.polynomial import legendre

from eel_model.body.body import Body
from eel_model.robot.compiled import HINGE, ModeTable
from eel_model.scene import Scene
from eel_model.section_data import sections_of

MOST = 1e12  # condition of the scaled matrix: above it, less than four digits of an acceleration are left
PART = 0.1  # of a singular direction, from which a mode is named
GAUSS = legendre.leggauss(24)


def effective_inertia(table: ModeTable, body: Body, scene: Scene) -> np.ndarray:
    """Inertia (M, M) of the modes alone, with the head free [kg m^2; kg m^4 of continuous parts]: (M^-1)_qq^-1.

    Its least eigenvalue over those of the springs and dampers bounds explicit steps. `ValueError` names the modes for
    which it is not positive definite.
    """
    result = np.zeros((len(table), len(table)))
    for axis in (1, 2):
        modes = np.flatnonzero(table.axis == axis)
        if len(modes):
            result[np.ix_(modes, modes)] = _of_plane(table, modes, body, scene)
    return result


def _of_plane(table: ModeTable, modes: np.ndarray, body: Body, scene: Scene) -> np.ndarray:
    x, weight = _rule(table, body)
    sections = sections_of(body, scene, x)
    pitch = table.axis[modes[0]] == 1
    turning = sections.inertia2 if pitch else sections.inertia3
    mass = sections.mass + (sections.added3 if pitch else sections.added2)
    angle = np.array([np.ones_like(x), np.zeros_like(x), *(_angle(table, mode, x) for mode in modes)])
    deflection = np.array([x, np.ones_like(x), *(_deflection(table, mode, x) for mode in modes)])
    matrix = (angle * (weight * turning)) @ angle.T + (deflection * (weight * mass)) @ deflection.T
    matrix[2:, 2:] += np.diag(table.armature[modes])
    scale = 1.0 / np.sqrt(np.diag(matrix))
    value, direction = np.linalg.eigh(matrix * scale[:, None] * scale)
    if not value[0] * MOST > value[-1]:
        guilty = dict.fromkeys(
            table.name[mode] for mode, part in zip(modes, direction[2:, 0], strict=True) if part**2 > PART
        )
        raise ValueError(
            f"robot modes of {', '.join(map(shown, guilty))} must be independent and have inertia: their matrix is "
            f"singular (condition {value[-1] / max(value[0], 1e-300):.2g}, of {MOST:g} at most); give them supports "
            "that differ more, or fewer modes"
        )
    head, cross, inner = matrix[:2, :2], matrix[:2, 2:], matrix[2:, 2:]
    return np.asarray(inner - cross.T @ np.linalg.solve(head, cross))


def _rule(table: ModeTable, body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights [m] between all edges; near the nose in the root of X."""
    ends = sorted({0.0, *body.panel_ends, *table.edges})
    points, weights = [], []
    for start, end in pairwise(ends):
        u, w = 0.5 * (1.0 + GAUSS[0]), 0.5 * GAUSS[1]
        if start == 0.0:
            u, w = u**2, w * 2.0 * u
        points.append(start + (end - start) * u)
        weights.append((end - start) * w)
    return np.concatenate(points), np.concatenate(weights)


def _angle(table: ModeTable, mode: int, x: np.ndarray) -> np.ndarray:
    """Integral of B from the nose to `x`."""
    return _integral(table, mode, x, 1)


def _deflection(table: ModeTable, mode: int, x: np.ndarray) -> np.ndarray:
    """Integral of the angle from the nose to `x`."""
    behind = np.maximum(x - table.end[mode], 0.0)
    end = np.array([table.end[mode]])
    return np.asarray(_integral(table, mode, x, 2) + behind * _integral(table, mode, end, 1))


def _integral(table: ModeTable, mode: int, x: np.ndarray, times: int) -> np.ndarray:
    """The `times`-fold integral of B from its support's start to `x`, or to its end."""
    start, end, degree = table.start[mode], table.end[mode], int(table.degree[mode])
    half = 0.5 * (end - start)
    series = np.eye(max(degree, 0) + 1)[max(degree, 0)] * (1.0 / (end - start) if degree == HINGE else 1.0)
    z = np.clip((x - start) / half - 1.0, -1.0, 1.0)
    return np.asarray(half**times * legendre.legval(z, legendre.legint(series, times, lbnd=-1)))
