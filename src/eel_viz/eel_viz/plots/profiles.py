# SPDX-License-Identifier: Apache-2.0
"""Drawings of profiles: torque, force and curvature against X, and the torque C3 over X and time."""

import numpy as np

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.limit import Limit
from eel_viz.messages import Profiles
from eel_viz.plots.heat_map import HeatMap
from eel_viz.plots.profile_plot import ProfilePlot
from eel_viz.scene3d import colours
from eel_viz.settings import Settings


class ProfilePlots:
    """Draws through the methods of topics. limit: of the colours of C3, kept up to date here."""

    def __init__(self, stream: BatchedStream, settings: Settings, limit: Limit) -> None:
        self._limit, self._heat_map = limit, HeatMap(stream, limit=limit)
        self._torque, self._force, self._curvature = (
            ProfilePlot(stream, path, names=names, unit=unit, limit=most, palette=colours.AXIS[3 - len(names) :])
            for path, names, unit, most in (
                (entities.TORQUE, ("C1", "C2", "C3"), "N m", settings.torque_limit),
                (entities.FORCE, ("N1", "N2", "N3"), "N", settings.force_limit),
                (entities.CURVATURE, ("K2", "K3"), "rad/m", settings.curvature_limit),
            )
        )

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        x, c3 = wrench.x, wrench.values["torque_3"]
        k = int(np.argmax(np.abs(c3)))
        self._limit.recent.include(stamp, abs(float(c3[k])), float(x[k]))
        self._torque.add(stamp, x, wrench.together("torque_1", "torque_2", "torque_3"))
        self._force.add(stamp, x, wrench.together("force_1", "force_2", "force_3"))
        self._heat_map.add(stamp, x, c3)

    def curvature(self, stamp: int, curvature: Profiles) -> None:
        self._curvature.add(stamp, curvature.x, curvature.together("pitch", "yaw"))
