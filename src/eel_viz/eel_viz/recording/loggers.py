# SPDX-License-Identifier: Apache-2.0
"""Logs the swimmer's messages to one Rerun recording, with their own stamps.

Each kind of drawing is a class with a method for each topic that it draws, named after the topic. A new curve or
drawing is logged there under a path of entities.py, and an arrangement of views/blueprint.py shows it.

Geometry is drawn in single precision at one rate. Scalars and profiles are logged in double precision at another rate
(see `Rates`). The skin combines the backbone and the torque of the same stamp, in any order. Rows are sent in batches
(see `batched_stream`): call `send_due` regularly, and `flush` at the end.
"""

from typing import Any

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream, Rates
from eel_viz.limit import Limit
from eel_viz.messages import Body, Load, Pose, Profiles, Twist, same
from eel_viz.plots.comparison import Comparison
from eel_viz.plots.profiles import ProfilePlots
from eel_viz.plots.sensors import SensorPlots
from eel_viz.plots.series import Series
from eel_viz.recording.run_text import RunText
from eel_viz.robots.parts import Parts
from eel_viz.scene3d.arrows import Arrows
from eel_viz.scene3d.course import Course
from eel_viz.scene3d.swimmer_scene import SwimmerScene
from eel_viz.scene3d.track import Track
from eel_viz.settings import Settings


class Loggers:
    """Logs one run to one `recording`; `name` is the run's.

    With `settings.compare`, `log` also draws the compared run over this one.
    """

    def __init__(self, recording: rr.RecordingStream, settings: Settings, rates: Rates, name: str = "eel") -> None:
        self._stream = stream = BatchedStream(recording, rates)
        self._text = RunText(recording, stream, settings)
        torque = Limit(settings.colour_limit, grows=not settings.colour_limit)  # N m: for the colours of C3
        this: list[object] = [self._text, Numbers(stream), Series(stream), ProfilePlots(stream, settings, torque)]
        this += [SwimmerScene(stream, torque), Track(stream), Arrows(stream, settings), Course(stream, settings.reach)]
        this += [Parts(stream), SensorPlots(stream)]
        self._drawers: tuple[list[object], list[object]] = this, []  # drawers of this run, and of the compared one
        if settings.compare:
            names = (name, settings.compare.strip("/") or "eel")
            comparison = Comparison(stream, names=names, limit=settings.torque_limit)
            self._drawers[0].append(comparison.this)
            self._drawers[1].append(comparison.other)

    def log(self, topic: str, stamp: int, *values: Any, compared: bool = False) -> None:
        """Log the `values` of `topic` at `stamp` [ns] by the methods of that name. compared: for the compared run."""
        for drawer in self._drawers[compared]:
            draw = getattr(drawer, topic, None)
            if draw is not None:
                draw(stamp, *values)

    def send_due(self) -> None:
        self._stream.send_due()

    def flush(self) -> None:
        """Send all rows, and the last diagnostics, before the recording is closed."""
        self._stream.flush()
        self._text.finish()


class Numbers:
    """Logs arrays of messages unchanged as components, through the methods of topics; stations when they change."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._stations: dict[str, np.ndarray] = {}  # by entity

    def body(self, stamp: int, body: Body) -> None:
        """Log the geometry, for all times."""
        values = {name: getattr(body, name) for name in ("length", "mass", "x", "half_width", "half_height")}
        self._stream.log_static(entities.BODY_NUMBERS, rr.DynamicArchetype("BodyGeometry", components=values))

    def odom(self, stamp: int, pose: Pose, twist: Twist) -> None:
        values = {"position": pose.position, "orientation": pose.orientation}
        values |= {"linear": twist.linear, "angular": twist.angular}
        self._log(stamp, entities.ODOMETRY_NUMBERS, "Odometry", None, values)

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        self._log(stamp, entities.WRENCH_NUMBERS, "InternalWrench", wrench.x, wrench.values)

    def curvature(self, stamp: int, curvature: Profiles) -> None:
        self._log(stamp, entities.CURVATURE_NUMBERS, "Curvature", curvature.x, curvature.values)

    def hydrodynamic_load(self, stamp: int, load: Load) -> None:
        """Log the fluid's force on the body, and the momentum that the tail gives to the wake."""
        values = {**load.profiles.values, "tail_force": load.tail, "nose_force": load.nose}
        if load.wake is not None:
            values["wake_momentum_rate"] = load.wake
        if len(load.fins):
            values["fin_force"] = load.fins
        self._log(stamp, entities.LOAD_NUMBERS, "HydrodynamicLoad", load.profiles.x, values)

    def _log(self, stamp: int, path: str, name: str, x: np.ndarray | None, values: dict[str, np.ndarray]) -> None:
        """Log `values` as components of the archetype `name`, if due."""
        if self._stream.number_due(path, stamp):
            known = self._stations.get(path)
            if x is not None and (known is None or not same(known, x)):
                self._stations[path] = x
                values = {"x": x, **values}
            self._stream.add_arrays(stamp, path, name, values)
