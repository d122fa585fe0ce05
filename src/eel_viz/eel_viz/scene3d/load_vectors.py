# SPDX-License-Identifier: Apache-2.0
"""Turns a load into vectors in the world: along the body, and at nose and tail."""

import numpy as np
from eel_base.attitude import world_from_section

from eel_viz.messages import Backbone, Load, same
from eel_viz.scene3d.centre_line import Resampling

ALONG = 24  # vectors between nose and tail


class LoadVectors:
    """Makes vectors of the lengths `load_scale` [m per N/m] along the body and `end_scale` [m per N] at its ends."""

    def __init__(self, *, load_scale: float, end_scale: float) -> None:
        self._load_scale, self._end_scale = load_scale, end_scale
        self._along: tuple[np.ndarray, np.ndarray] | None = None  # all stations, and which have a vector

    def along(self, backbone: Backbone, load: Load) -> tuple[np.ndarray, np.ndarray]:
        """Origins and vectors along the body, each (n, 3) [m], world frame; n <= ALONG."""
        chosen = self._stations(backbone.x)
        x, force = backbone.x[chosen], load.profiles.together("force_1", "force_2", "force_3")
        alike = same(load.profiles.x, backbone.x)
        force = force[chosen] if alike else Resampling(load.profiles.x, x).linear(force)
        return backbone.position[chosen], world_from_section(backbone.orientation[chosen], force) * self._load_scale

    def ends(self, backbone: Backbone, load: Load) -> tuple[np.ndarray, np.ndarray]:
        """Origins and vectors at nose and tail, each (2, 3) [m], world frame."""
        ends = [0, -1]
        forces = world_from_section(backbone.orientation[ends], np.stack([load.nose, load.tail]))
        return backbone.position[ends], forces * self._end_scale

    def _stations(self, x: np.ndarray) -> np.ndarray:
        """Indices of the stations that have a vector, evenly spaced along the body as far as stations allow."""
        if self._along is None or not same(self._along[0], x):
            wanted = np.linspace(x[0], x[-1], ALONG + 2)[1:-1]
            self._along = x, np.unique(np.searchsorted(x, wanted - 1e-9))
        return self._along[1]
