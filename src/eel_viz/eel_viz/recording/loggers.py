# SPDX-License-Identifier: Apache-2.0
"""Logs the swimmer's messages to one Rerun recording: one method per topic, called with the message's own stamp.

A new curve or drawing is logged here under a path of entities.py, and an arrangement of views/blueprint.py shows it.

Geometry is drawn in single precision at one rate. Scalars and profiles are logged in double precision at another rate
(see `Rates`). The skin takes its shape from the backbone and its colour from the torque of the same stamp, in any
order. Rows are sent in batches (see `batched_stream`): call `send_due` regularly, and `flush` at the end.
"""

import reprlib
from typing import Any

import numpy as np
import rerun as rr
from eel_base.attitude import attitude

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone, Body, Load, Pose, Profiles, Status, Twist, same
from eel_viz.plots.comparison import Comparison
from eel_viz.plots.heat_map import HeatMap
from eel_viz.plots.limit import Limit
from eel_viz.plots.profile_plot import ProfilePlot
from eel_viz.plots.series import Attitude, log_styles
from eel_viz.plots.state_text import Summary, look_text
from eel_viz.recording.destination import send_properties
from eel_viz.recording.rates import Rates, Slots, period_of
from eel_viz.robots.parts import Parts
from eel_viz.scene3d import colours
from eel_viz.scene3d.swimmer_scene import SwimmerScene
from eel_viz.settings import Settings

ENVELOPE_PERIOD = 500_000_000  # ns
HEAT_MAP_PERIOD = 200_000_000
SHORT = reprlib.Repr()
SHORT.maxstring = 220  # characters of a law's name, which is not checked before
BESIDES = {
    entities.POWER_BESIDES: ("flow_power", "fins_power", "damping_power"),
    entities.STORED: ("potential", "elastic"),
}
LEVELS = ("INFO", "WARN", "ERROR", "WARN")  # of a DiagnosticStatus: OK, WARN, ERROR, STALE


class Loggers:
    """Logs one run to one `recording`; `name` is the run's.

    With `settings.compare`, `log` draws the compared run too, over this one.
    """

    def __init__(self, recording: rr.RecordingStream, settings: Settings, rates: Rates, name: str = "eel") -> None:
        self._recording = recording
        self._stream = stream = BatchedStream(recording, tick=rates.tick)
        self._number_period = period_of(rates.numbers)
        self._drawing_period = period_of(rates.drawings)
        self._due = Slots().due
        self._stations: dict[str, np.ndarray] = {}
        self._statuses: dict[str, tuple[int, str]] = {}  # level and message, by name
        self._besides: set[str] = set()  # paths of `BESIDES` that have lines
        self.summary = Summary()
        self._attitude = Attitude()
        self._scene = SwimmerScene(
            stream,
            reach=settings.reach,
            load_scale=settings.load_scale,
            end_scale=settings.end_force_scale,
            wake_scale=settings.wake_scale,
        )
        self._torque, self._force, self._curvature = (
            ProfilePlot(stream, path, names=names, unit=unit, limit=limit, palette=colours.AXIS[3 - len(names) :])
            for path, names, unit, limit in (
                (entities.TORQUE, ("C1", "C2", "C3"), "N m", settings.torque_limit),
                (entities.FORCE, ("N1", "N2", "N3"), "N", settings.force_limit),
                (entities.CURVATURE, ("K2", "K3"), "rad/m", settings.curvature_limit),
            )
        )
        self._colour_limit = Limit(settings.colour_limit, grows=not settings.colour_limit)
        self._heat_map = HeatMap(stream, limit=self._colour_limit)
        log_styles(stream)
        self._settings = settings
        self._log_look(None)
        parts = Parts(stream, self._due, numbers=self._number_period, drawings=self._drawing_period)
        self._targets: tuple[list[object], list[object]] = [self, parts], []  # what draws this run, the compared one
        if settings.compare:
            comparison = Comparison(
                stream,
                names=(name, settings.compare.strip("/") or "eel"),
                limit=settings.torque_limit,
                due=self._due,
                drawings=self._drawing_period,
            )
            self._targets[0].append(comparison.this)
            self._targets[1].append(comparison.other)

    def log(self, topic: str, stamp: int, *values: Any, compared: bool = False) -> None:
        """Log the `values` of `topic` at `stamp` [ns] by the method of that name; compared: of the compared run."""
        for target in self._targets[compared]:
            draw = getattr(target, topic, None)
            if draw is not None:
                draw(stamp, *values)

    def send_due(self) -> None:
        """Send the rows that have waited for a tick."""
        self._stream.send_due()

    def flush(self) -> None:
        """Send all rows, and what the diagnostics said last, before the recording is closed."""
        self._stream.flush()
        if self.summary.values:
            send_properties(self._recording, "diagnostics", self.summary.numbers())

    # --- the swimmer ---------------------------------------------------------------------------------------------
    def body(self, stamp: int, body: Body) -> None:
        """Log the geometry, valid at all times."""
        self._scene.body(body)
        self.summary.body = body
        if body.fins or body.joints:
            self._log_look(body)
        send_properties(self._recording, "body", {"length": float(body.length), "mass": float(body.mass)})
        values = {name: getattr(body, name) for name in ("length", "mass", "x", "half_width", "half_height")}
        self._stream.log_static(entities.BODY_NUMBERS, rr.DynamicArchetype("BodyGeometry", components=values))

    def goal(self, stamp: int, points: np.ndarray) -> None:
        """Log the way points (n, 3) [m] of a goal, valid at all times."""
        self._scene.course(points)

    def head_pose(self, stamp: int, pose: Pose) -> None:
        """Log path, attitude and depth of the head."""
        if self.summary.add_position(stamp, pose.position):
            self._summarise_if_due(stamp)
        if self._due("head_pose", stamp, self._number_period):
            scalars = self._stream.add_scalars
            scalars(stamp, entities.POSITION, pose.position)
            scalars(stamp, entities.ORIENTATION, pose.orientation)
            scalars(stamp, entities.ATTITUDE, self._attitude.continued(attitude(pose.orientation.tolist())))
            scalars(stamp, entities.DEPTH, -pose.position[2:])
        if self._due("track", stamp, self._drawing_period):
            self._scene.head(stamp, pose)

    def head_twist(self, stamp: int, twist: Twist) -> None:
        """Log the head's speed, and its velocities in base_link."""
        speed = float(np.linalg.norm(twist.linear))
        self._scene.speed(stamp, speed)
        if self._due("head_twist", stamp, self._number_period):
            self._stream.add_scalars(stamp, entities.SPEED, [speed])
            self._stream.add_scalars(stamp, entities.LINEAR, twist.linear)
            self._stream.add_scalars(stamp, entities.ANGULAR, twist.angular)

    def odom(self, stamp: int, pose: Pose, twist: Twist) -> None:
        """Log the numbers of odom; head_pose and head_twist draw the same."""
        if self._due("odom", stamp, self._number_period):
            values = {"position": pose.position, "orientation": pose.orientation}
            values |= {"linear": twist.linear, "angular": twist.angular}
            self._numbers(stamp, entities.ODOMETRY_NUMBERS, "Odometry", values)

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Log line, skin, water and cameras."""
        if self._due("backbone", stamp, self._number_period):
            self._scene.line(stamp, backbone)
        if self._due("skin", stamp, self._drawing_period):
            self._scene.backbone(stamp, backbone)

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        """Log torques and forces along the body; C3 colours the flanks and makes the heat map."""
        torque = wrench.together("torque_1", "torque_2", "torque_3")
        force = wrench.together("force_1", "force_2", "force_3")
        if self.summary.add_torque(stamp, wrench.x, torque[:, 2]):
            self._summarise_if_due(stamp)
        self._torque.include(stamp, wrench.x, torque)
        self._force.include(stamp, wrench.x, force)
        if self._due("wrench", stamp, self._number_period):
            self._numbers(stamp, entities.WRENCH_NUMBERS, "InternalWrench", wrench.values, wrench.x)
        k = int(np.argmax(np.abs(torque[:, 2])))
        self._colour_limit.include(stamp, abs(float(torque[k, 2])), float(wrench.x[k]))
        self._heat_map.include(stamp, wrench.x, torque[:, 2])
        if self._due("profiles", stamp, self._drawing_period):
            self._torque.draw(stamp, wrench.x, torque)
            self._force.draw(stamp, wrench.x, force)
            recent = self._colour_limit.recent
            self._scene.torque(stamp, wrench.x, torque[:, 2], self._colour_limit.value, (recent.place, recent.value))
        if self._due("envelope", stamp, ENVELOPE_PERIOD):
            self._torque.draw_envelope(stamp)
            self._force.draw_envelope(stamp)
        if self._due("heat_map", stamp, HEAT_MAP_PERIOD):
            self._heat_map.draw(stamp)

    def curvature(self, stamp: int, curvature: Profiles) -> None:
        """Log the body's curvatures K2 and K3."""
        values = curvature.together("pitch", "yaw")
        self._curvature.include(stamp, curvature.x, values)
        if self._due("curvature", stamp, self._number_period):
            self._numbers(stamp, entities.CURVATURE_NUMBERS, "Curvature", curvature.values, curvature.x)
        if self._due("curvature drawn", stamp, self._drawing_period):
            self._curvature.draw(stamp, curvature.x, values)
        if self._due("curvature envelope", stamp, ENVELOPE_PERIOD):
            self._curvature.draw_envelope(stamp)

    def hydrodynamic_load(self, stamp: int, load: Load) -> None:
        """Log the fluid's force on the body, as arrows in the world, and what the tail leaves in the wake."""
        if self._due("load", stamp, self._number_period):
            values = {**load.profiles.values, "tail_force": load.tail, "nose_force": load.nose}
            if load.wake is not None:
                values["wake_momentum_rate"] = load.wake
            if len(load.fins):
                values["fin_force"] = load.fins
            self._numbers(stamp, entities.LOAD_NUMBERS, "HydrodynamicLoad", values, load.profiles.x)
        if self._due("arrows", stamp, self._drawing_period):
            self._scene.load(stamp, load)

    def flow_vectors(self, stamp: int, position: np.ndarray, velocity: np.ndarray) -> None:
        """Log how the water moves around the swimmer."""
        if self._due("flow", stamp, self._drawing_period):
            self._scene.flow(stamp, position, velocity)

    def energy(self, stamp: int, energy: dict[str, float]) -> None:
        """Log the terms of the energy ledger [W], [J]."""
        if self._due("energy", stamp, self._number_period):
            powers = [energy[f"{name}_power"] for name in ("actuator", "wake", "nose", "drag")]
            self._stream.add_scalars(stamp, entities.POWER, powers)
            self._stream.add_scalars(stamp, entities.KINETIC, [energy["kinetic_body"], energy["kinetic_fluid"]])
            self._stream.add_scalars(stamp, entities.RESIDUAL, [energy["residual"]])
            for path, names in BESIDES.items():
                values = [energy[name] for name in names]
                if any(values) or path in self._besides:  # a swim without fins has no line for them
                    self._besides.add(path)
                    self._stream.add_scalars(stamp, path, values)

    # --- the run -------------------------------------------------------------------------------------------------
    def curvature_law(self, stamp: int, name: str) -> None:
        """Log the name of the published law."""
        self.summary.law = name
        send_properties(self._recording, "swim", {"gait": SHORT.repr(name).strip("'")})
        self._event(stamp, f"law {SHORT.repr(name)} published", "INFO")

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Log each status whose level or message has changed; the values go into the summary."""
        for status in statuses:
            if self.summary.add_status(stamp, status.message, status.values):
                self._summarise()
            if self._statuses.get(status.name) != (status.level, status.message):
                self._statuses[status.name] = (status.level, status.message)
                self._event(stamp, f"{status.name}: {status.message}", LEVELS[min(status.level, len(LEVELS) - 1)])

    # --- logging ----------------------------------------------------------------------------------------
    def _numbers(
        self, stamp: int, path: str, name: str, values: dict[str, np.ndarray], x: np.ndarray | None = None
    ) -> None:
        """Log arrays as components; the stations only when they change."""
        known = self._stations.get(path)
        if x is not None and (known is None or not same(known, x)):
            self._stations[path] = x
            values = {"x": x, **values}
        self._stream.add_arrays(stamp, path, name, values)

    def _log_look(self, body: Body | None) -> None:
        text = rr.TextDocument(look_text(self._settings, body), media_type="text/markdown")
        self._stream.log_static(entities.LOOK, text)

    def _event(self, stamp: int, text: str, level: str) -> None:
        self._stream.log(stamp, entities.LOG, rr.TextLog(text, level=level))

    def _summarise_if_due(self, stamp: int) -> None:
        if self._due("summary", stamp, self._drawing_period):
            self._summarise()

    def _summarise(self) -> None:
        text = rr.TextDocument(self.summary.text(), media_type="text/markdown")
        self._stream.log(self.summary.stamp, entities.RUN, text)
