# SPDX-License-Identifier: Apache-2.0
"""Curves of what sensors read, where it is published, by the methods of topics."""

from typing import Any

import numpy as np
from eel_common.topics import SENSORS

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.plots.series import log_styles
from eel_viz.scene3d import colours

AXES = tuple(zip("xyz", colours.AXIS, strict=True))
CURVES: dict[str, dict[str, tuple[Any, ...]]] = {  # topic: entities, each with name and colour of its values
    "imu": {entities.FORCE_READ: AXES, entities.TURNING_READ: AXES},
    "pressure": {entities.PRESSURE_READ: (("pressure [Pa]", colours.PLAIN),)},
    "depth": {entities.DEPTH_READ: (("depth, read [m]", colours.FORCE),)},
    "velocity": {entities.VELOCITY_READ: AXES},
}
assert tuple(CURVES) == SENSORS


class SensorPlots:
    """Logs readings in double precision, with names from the first of a topic on."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._named: set[str] = set()

    def imu(self, stamp: int, force: np.ndarray, turning: np.ndarray) -> None:
        self._log("imu", stamp, force, turning)

    def pressure(self, stamp: int, pressure: np.ndarray) -> None:
        self._log("pressure", stamp, pressure)

    def depth(self, stamp: int, depth: np.ndarray) -> None:
        self._log("depth", stamp, depth)

    def velocity(self, stamp: int, velocity: np.ndarray) -> None:
        self._log("velocity", stamp, velocity)

    def _log(self, topic: str, stamp: int, *rows: np.ndarray) -> None:
        if self._stream.number_due(topic, stamp):
            for (path, lines), row in zip(CURVES[topic].items(), rows, strict=True):
                if path not in self._named:
                    self._named.add(path)
                    log_styles(self._stream, {path: lines})
                self._stream.add_scalars(stamp, path, row)
