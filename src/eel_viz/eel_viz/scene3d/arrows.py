# SPDX-License-Identifier: Apache-2.0
"""Draws the fluid's force on the body as arrows in the world, along the body, and at nose and tail; and the wake.

A load is in section axes, so it needs the backbone of the same stamp.
"""

import numpy as np
import rerun as rr
from eel_base.attitude import world_from_section

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone, Load
from eel_viz.same_stamp import SameStamp
from eel_viz.scene3d import colours
from eel_viz.scene3d.load_vectors import LoadVectors
from eel_viz.scene3d.track import Wake


class Arrows:
    """Draws arrows, `load_scale` [m per N/m] and `end_scale` [m per N] long, and the wake, `wake_scale` [m per N]."""

    def __init__(self, stream: BatchedStream, *, load_scale: float, end_scale: float, wake_scale: float) -> None:
        self._stream, self._vectors = stream, LoadVectors(load_scale=load_scale, end_scale=end_scale)
        self._both = SameStamp(self._draw)
        self._wake = Wake(stream, wake_scale)
        stream.log_static(entities.LOAD, rr.Arrows3D.from_fields(colors=[colours.FORCE], radii=[0.0022]))
        stream.log_static(entities.LOAD_ENDS, rr.Arrows3D.from_fields(colors=[colours.ENDS], radii=[0.004]))

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Take the backbone at `stamp` [ns]."""
        self._both.first(stamp, backbone)

    def load(self, stamp: int, load: Load) -> None:
        """Take the load at `stamp` [ns]."""
        self._both.second(stamp, load)

    def _draw(self, stamp: int, backbone: Backbone, load: Load) -> None:
        self._log(stamp, entities.LOAD, *self._vectors.along(backbone, load))
        self._log(stamp, entities.LOAD_ENDS, *self._vectors.ends(backbone, load))
        if load.wake is not None:
            momentum_rate = world_from_section(backbone.orientation[-1], load.wake)
            self._wake.draw(stamp, backbone.position[-1], momentum_rate)

    def _log(self, stamp: int, path: str, origins: np.ndarray, vectors: np.ndarray) -> None:
        self._stream.add_row(
            stamp, path, rr.Arrows3D, origins=origins.astype(np.float32), vectors=vectors.astype(np.float32)
        )
