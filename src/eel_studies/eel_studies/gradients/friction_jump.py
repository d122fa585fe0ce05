# SPDX-License-Identifier: Apache-2.0
"""Where the printed friction law jumps between two neighbouring swims."""

import numpy as np
from eel_base.attitude import world_from_body
from eel_dynamics.model.section_data import TRANSITION
from eel_dynamics.runs.run import Run

PRINTED = "printed"


def share_across_jump(one: Run, other: Run) -> float:
    """Share of samples and stations at which two runs lie on different sides of the printed friction's jump; 0 without.

    The speed V1 along the body is that of the backbone through the water, from splines through the samples.
    """
    if one.scene.friction != PRINTED or not one.scene.resistive or not one.scene.viscosity or len(one.time) < 4:
        return 0.0
    return float(np.mean(_is_turbulent(one) != _is_turbulent(other)))


def _is_turbulent(run: Run) -> np.ndarray:
    """Whether Re = abs(V1) X / nu exceeds the transition, (T, M)."""
    from scipy.interpolate import CubicSpline

    velocity = CubicSpline(run.time, run.backbone, axis=0)(run.time, 1) - run.scene.current
    along = world_from_body(run.section_orientation)[..., 0]  # axis 1 of each section
    speed = np.abs(np.sum(velocity * along, axis=-1))
    return np.asarray(speed * run.x > TRANSITION * run.scene.viscosity)
