# SPDX-License-Identifier: Apache-2.0
"""Draws arrows in the world: the fluid's force along the body and at nose and tail, and the water's velocity.

A load is in section axes, so it needs the backbone of the same stamp.
"""

import numpy as np
import rerun as rr
from eel_common.attitude import world_from_section

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone, Body, Load
from eel_viz.same_stamp import SameStamp
from eel_viz.scene3d import colours, legend
from eel_viz.scene3d.centre_line import forces_along, forces_at_ends
from eel_viz.scene3d.track import Wake
from eel_viz.settings import Settings

LONGEST = 0.16  # body lengths: longest arrow of the water's velocity
RADII = {entities.LOAD: 0.0022, entities.LOAD_ENDS: 0.004, entities.FLOW: 0.0018}  # body lengths
COLOURS = {entities.LOAD: colours.FORCE, entities.LOAD_ENDS: colours.ENDS, entities.FLOW: colours.FLOW}


class Arrows:
    """Draws arrows, and the wake, through the methods of topics. The scales are those of the `settings`."""

    def __init__(self, stream: BatchedStream, settings: Settings) -> None:
        self._stream, self._settings = stream, settings
        self._both = SameStamp(self._draw)
        self._wake = Wake(stream, settings.wake_scale)
        self._explained, self._fastest, self._told = False, 0.0, ""  # m/s: of the water so far, and in the legend
        self._length = 1.0  # m, of the body
        self._log_styles()

    def body(self, stamp: int, body: Body) -> None:
        self._length = body.length
        self._log_styles()

    def _log_styles(self) -> None:
        """Log colour and thickness of the arrows, for all times."""
        for path, colour in COLOURS.items():
            style = rr.Arrows3D.from_fields(colors=[colour], radii=[RADII[path] * self._length])
            self._stream.log_static(path, style)

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        if self._stream.drawing_due("line with load", stamp):
            self._both.first(stamp, backbone)

    def hydrodynamic_load(self, stamp: int, load: Load) -> None:
        if self._stream.drawing_due("load", stamp):
            if not self._explained:
                self._explained = True
                legend.log_words(self._stream, stamp)
            self._both.second(stamp, load)

    def flow_vectors(self, stamp: int, position: np.ndarray, velocity: np.ndarray) -> None:
        """Draw the water's velocities (n, 3) [m/s] at points (n, 3) [m] as arrows. The fastest so far has `LONGEST`."""
        if self._stream.drawing_due("flow", stamp):
            fastest = float(np.linalg.norm(velocity, axis=1).max(initial=0.0))
            self._fastest = max(self._fastest, fastest)
            if (told := f"{self._fastest:.2g} m/s") != self._told:
                self._told = told
                legend.log_flow(self._stream, stamp, told)
            self._log(stamp, entities.FLOW, position, LONGEST * self._length / max(self._fastest, 1e-9) * velocity)

    def _draw(self, stamp: int, backbone: Backbone, load: Load) -> None:
        places, forces = forces_along(backbone, load)
        self._log(stamp, entities.LOAD, places, forces * self._settings.load_scale)
        places, forces = forces_at_ends(backbone, load)
        self._log(stamp, entities.LOAD_ENDS, places, forces * self._settings.end_force_scale)
        if load.wake is not None:
            momentum_rate = world_from_section(backbone.orientation[-1], load.wake)
            self._wake.draw(stamp, backbone.position[-1], momentum_rate)

    def _log(self, stamp: int, path: str, origins: np.ndarray, vectors: np.ndarray) -> None:
        self._stream.add_row(
            stamp, path, rr.Arrows3D, origins=origins.astype(np.float32), vectors=vectors.astype(np.float32)
        )
