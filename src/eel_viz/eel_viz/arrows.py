"""The fluid's force on the body as arrows in the world: along the body, and at nose and tail.

A load is in section axes, so it needs the backbone of the same time; whichever comes first waits for the other.
"""

from collections import OrderedDict

import numpy as np
import rerun as rr

from eel_viz import colours, entities
from eel_viz.centre_line import Resampling
from eel_viz.messages import Backbone, Load
from eel_viz.orientation import world_from_section

ALONG = 24  # arrows between nose and tail
KEPT = 512  # that wait; the oldest is given up


class Arrows:
    """`load_scale` [m per N/m] and `end_scale` [m per N] are the arrows' lengths."""

    def __init__(self, stream: rr.RecordingStream, *, load_scale: float, end_scale: float) -> None:
        self._stream, self._load_scale, self._end_scale = stream, load_scale, end_scale
        self._backbones: OrderedDict[int, Backbone] = OrderedDict()
        self._loads: OrderedDict[int, Load] = OrderedDict()
        stream.log(entities.LOAD, rr.Arrows3D.from_fields(colors=[colours.TEAL], radii=[0.0022]), static=True)
        stream.log(entities.LOAD_ENDS, rr.Arrows3D.from_fields(colors=[colours.MAGENTA], radii=[0.004]), static=True)

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """The backbone at `stamp` [ns], which is the stream's present time."""
        load = self._loads.pop(stamp, None)
        if load is None:
            _keep(self._backbones, stamp, backbone)
        else:
            self._draw(backbone, load)

    def load(self, stamp: int, load: Load) -> None:
        """The load at `stamp` [ns], which is the stream's present time."""
        backbone = self._backbones.pop(stamp, None)
        if backbone is None:
            _keep(self._loads, stamp, load)
        else:
            self._draw(backbone, load)

    def _draw(self, backbone: Backbone, load: Load) -> None:
        x = np.linspace(backbone.x[0], backbone.x[-1], ALONG + 2)[1:-1]
        origins, axes = Resampling(backbone.x, x).centre_line(backbone.position, backbone.orientation)
        force = Resampling(load.profiles.x, x).linear(load.profiles.together("force_1", "force_2", "force_3"))
        self._log(entities.LOAD, origins, np.einsum("nij,nj->ni", axes, force) * self._load_scale)
        ends = [0, -1]
        forces = world_from_section(backbone.orientation[ends], np.stack([load.nose, load.tail]))
        self._log(entities.LOAD_ENDS, backbone.position[ends], forces * self._end_scale)

    def _log(self, path: str, origins: np.ndarray, vectors: np.ndarray) -> None:
        arrows = rr.Arrows3D.from_fields(origins=origins.astype(np.float32), vectors=vectors.astype(np.float32))
        self._stream.log(path, arrows)


def _keep(waiting: OrderedDict, stamp: int, value) -> None:
    waiting[stamp] = value
    if len(waiting) > KEPT:
        waiting.popitem(last=False)
