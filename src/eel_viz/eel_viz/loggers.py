"""The swimmer's messages into one Rerun stream: one method for each message, each called at the message's own time.

Geometry is drawn in single precision at one rate; scalars and profiles go in as they are, in double precision, at
another (see `Rates`). What belongs together has the same time, and that is all that ties it: the skin takes its shape
from the backbone and its colour from the torque, whichever comes first.
"""

from dataclasses import dataclass

import numpy as np
import rerun as rr

from eel_viz import colours, entities
from eel_viz.arrows import Arrows
from eel_viz.heat_map import HeatMap
from eel_viz.messages import Backbone, Body, Load, Pose, Profiles, Status, Twist
from eel_viz.orientation import attitude
from eel_viz.profile_plot import ProfilePlot
from eel_viz.scene import Track, Water, log_legend
from eel_viz.series import log_styles
from eel_viz.settings import Settings
from eel_viz.skin import Skin
from eel_viz.summary import Summary

ENVELOPE_PERIOD = 500_000_000  # ns
HEAT_MAP_PERIOD = 160_000_000
SUMMARY_PERIOD = 500_000_000
LEVELS = ("INFO", "WARN", "ERROR", "WARN")


@dataclass(frozen=True, kw_only=True)
class Rates:
    """How often [Hz of simulation time] numbers and drawings go in; 0: with every message."""

    numbers: float = 0.0
    drawings: float = 25.0


class Loggers:
    """Everything about one run, into one `stream`."""

    def __init__(self, stream: rr.RecordingStream, settings: Settings, rates: Rates) -> None:
        self._stream = stream
        self._settings = settings
        self._number_period = _period(rates.numbers)
        self._drawing_period = _period(rates.drawings)
        self._slots: dict[str, int] = {}
        self._stations: dict[str, np.ndarray] = {}
        self._skin: Skin | None = None
        self._statuses: dict[str, tuple[int, str]] = {}
        self.summary = Summary()
        stream.log(entities.WORLD, rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._water = Water(stream)
        self._track = Track(stream)
        self._torque = ProfilePlot(
            stream, entities.TORQUE, names=("C1", "C2", "C3"), unit="N m", limit=settings.torque_limit
        )
        self._force = ProfilePlot(
            stream, entities.FORCE, names=("N1", "N2", "N3"), unit="N", limit=settings.force_limit
        )
        self._curvature = ProfilePlot(
            stream,
            entities.CURVATURE,
            names=("K2", "K3"),
            unit="rad/m",
            limit=settings.curvature_limit,
            palette=colours.AXIS[1:],
        )
        self._heat_map = HeatMap(stream, limit=settings.colour_limit)
        log_legend(stream, limit=settings.colour_limit, unit="N m", name="C3")
        self._arrows = Arrows(stream, load_scale=settings.load_scale, end_scale=settings.end_force_scale)
        log_styles(stream)
        stream.log(entities.BACKBONE, rr.LineStrips3D.from_fields(colors=[colours.LABEL], radii=[0.0004]), static=True)
        for path in (entities.HEAD, entities.TAIL):
            stream.log(path, rr.TransformAxes3D(0.12), static=True)

    # --- the swimmer ---------------------------------------------------------------------------------------------
    def body(self, body: Body) -> None:
        """The geometry, valid at all times."""
        self._skin = Skin(body.x, body.half_width, body.half_height)
        self.summary.body = body
        self._stream.log(
            entities.SKIN,
            rr.Mesh3D.from_fields(triangle_indices=self._skin.triangles),
            static=True,
        )
        values = {name: getattr(body, name) for name in ("length", "mass", "x", "half_width", "half_height")}
        self._stream.log(entities.BODY_NUMBERS, rr.DynamicArchetype("BodyGeometry", components=values), static=True)

    def head_pose(self, stamp: int, pose: Pose) -> None:
        """Path, attitude and depth of the head."""
        self.summary.move(stamp, pose.position)
        if self._due("head_pose", stamp, self._number_period):
            heading, pitch, roll = attitude(pose.orientation)
            self._scalars(entities.POSITION, pose.position)
            self._scalars(entities.ORIENTATION, pose.orientation)
            self._scalars(entities.ATTITUDE, np.degrees([heading, pitch, roll]))
            self._scalars(entities.DEPTH, [-pose.position[2]])
        if self._due("track", stamp, self._drawing_period):
            self._track.draw(pose.position)
            self._stream.log(
                entities.HEAD,
                rr.Transform3D(translation=pose.position, quaternion=rr.Quaternion(xyzw=pose.orientation)),
            )
        if self._due("summary", stamp, SUMMARY_PERIOD):
            self._summarise(stamp)

    def head_twist(self, stamp: int, twist: Twist) -> None:
        """Speed, and the velocities of the head in its own axes."""
        if self._due("head_twist", stamp, self._number_period):
            self._scalars(entities.SPEED, [np.linalg.norm(twist.linear)])
            self._scalars(entities.LINEAR, twist.linear)
            self._scalars(entities.ANGULAR, twist.angular)

    def odom(self, stamp: int, pose: Pose, twist: Twist) -> None:
        """The numbers of odom; what they show is drawn from head_pose and head_twist."""
        if self._due("odom", stamp, self._number_period):
            values = {"position": pose.position, "orientation": pose.orientation}
            values |= {"linear": twist.linear, "angular": twist.angular}
            self._numbers(entities.ODOMETRY_NUMBERS, "Odometry", values)

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Line, skin, floor and camera."""
        if self._due("backbone", stamp, self._number_period):
            self._at(stamp)
            self._stream.log(
                entities.BACKBONE, rr.LineStrips3D.from_fields(strips=[backbone.position.astype(np.float32)])
            )
        if not self._due("skin", stamp, self._drawing_period):
            return
        self._at(stamp)
        position = backbone.position
        self._stream.log(entities.FOLLOW, rr.Transform3D(translation=position.mean(axis=0)))
        self._stream.log(
            entities.TAIL,
            rr.Transform3D(translation=position[-1], quaternion=rr.Quaternion(xyzw=backbone.orientation[-1])),
        )
        self._water.draw(position)
        if self._skin is not None:
            vertices, normals = self._skin.place(backbone.x, position, backbone.orientation)
            self._stream.log(entities.SKIN, rr.Mesh3D.from_fields(vertex_positions=vertices, vertex_normals=normals))
        self._arrows.backbone(stamp, backbone)

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        """Torques and forces along the body; C3 colours the skin and makes the heat map."""
        torque, force = (
            wrench.together("torque_1", "torque_2", "torque_3"),
            wrench.together("force_1", "force_2", "force_3"),
        )
        self.summary.strain(stamp, wrench.x, torque[:, 2])
        self._torque.include(wrench.x, torque)
        self._force.include(wrench.x, force)
        if self._due("wrench", stamp, self._number_period):
            self._numbers(entities.WRENCH_NUMBERS, "InternalWrench", wrench.values, wrench.x)
        self._at(stamp)
        self._heat_map.include(stamp, wrench.x, torque[:, 2])
        if self._due("profiles", stamp, self._drawing_period):
            self._torque.draw(wrench.x, torque)
            self._force.draw(wrench.x, force)
            if self._skin is not None:
                shades = colours.diverging(self._skin.spread(wrench.x, torque[:, 2]), self._settings.colour_limit)
                self._stream.log(entities.SKIN, rr.Mesh3D.from_fields(vertex_colors=shades))
        if self._due("envelope", stamp, ENVELOPE_PERIOD):
            self._torque.draw_envelope()
            self._force.draw_envelope()
        if self._due("heat_map", stamp, HEAT_MAP_PERIOD):
            self._heat_map.draw()

    def curvature(self, stamp: int, curvature: Profiles) -> None:
        """K2 and K3 as the body has them."""
        values = curvature.together("pitch", "yaw")
        self._curvature.include(curvature.x, values)
        if self._due("curvature", stamp, self._number_period):
            self._numbers(entities.CURVATURE_NUMBERS, "Curvature", curvature.values, curvature.x)
        self._at(stamp)
        if self._due("curvature drawn", stamp, self._drawing_period):
            self._curvature.draw(curvature.x, values)
        if self._due("curvature envelope", stamp, ENVELOPE_PERIOD):
            self._curvature.draw_envelope()

    def hydrodynamic_load(self, stamp: int, load: Load) -> None:
        """The fluid's force on the body, as arrows in the world."""
        if self._due("load", stamp, self._number_period):
            values = {**load.profiles.values, "tail_force": load.tail, "nose_force": load.nose}
            self._numbers(entities.LOAD_NUMBERS, "HydrodynamicLoad", values, load.profiles.x)
        if self._due("arrows", stamp, self._drawing_period):
            self._arrows.load(stamp, load)

    def energy(self, stamp: int, energy: dict[str, float]) -> None:
        """The ledger's terms."""
        if self._due("energy", stamp, self._number_period):
            self._scalars(entities.POWER, [energy[f"{name}_power"] for name in ("actuator", "wake", "nose", "drag")])
            self._scalars(entities.KINETIC, [energy["kinetic_body"], energy["kinetic_fluid"]])
            self._scalars(entities.RESIDUAL, [energy["residual"]])

    # --- the run -------------------------------------------------------------------------------------------------
    def law(self, stamp: int, name: str) -> None:
        """The law that was published, by name."""
        self.summary.law = name
        self._text(stamp, f"law {name!r} published", "INFO")

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Each status whose level or words have changed, as text; the values go into the summary."""
        for status in statuses:
            if self.summary.status(stamp, status.message, status.values):
                self._summarise(self.summary.stamp)
            if self._statuses.get(status.name) != (status.level, status.message):
                self._statuses[status.name] = (status.level, status.message)
                self._text(stamp, f"{status.name}: {status.message}", LEVELS[min(status.level, 3)])

    # --- how it is logged ----------------------------------------------------------------------------------------
    def _due(self, what: str, stamp: int, period: int) -> bool:
        """Whether `stamp` [ns] lies in a new slot of `period` [ns]; sets the stream's time if so."""
        if period:
            slot = (stamp + 1000) // period  # stamps are rounded to ns
            if self._slots.get(what) == slot:
                return False
            self._slots[what] = slot
        self._at(stamp)
        return True

    def _at(self, stamp: int) -> None:
        self._stream.set_time(entities.TIMELINE, duration=np.timedelta64(stamp, "ns"))

    def _scalars(self, path: str, values) -> None:
        self._stream.log(path, rr.Scalars(values))

    def _numbers(self, path: str, name: str, values: dict[str, np.ndarray], x: np.ndarray | None = None) -> None:
        """Arrays as components of their own; the stations only when they are new."""
        known = self._stations.get(path)
        if x is not None and (known is None or not np.array_equal(known, x)):
            self._stations[path] = x
            values = {"x": x, **values}
        self._stream.log(path, rr.DynamicArchetype(name, components=values))

    def _summarise(self, stamp: int) -> None:
        self._at(stamp)
        self._stream.log(entities.RUN, rr.TextDocument(self.summary.text(), media_type="text/markdown"))

    def _text(self, stamp: int, text: str, level: str) -> None:
        self._at(stamp)
        self._stream.log(entities.LOG, rr.TextLog(text, level=level))


def _period(rate: float) -> int:
    return round(1e9 / rate) if rate else 0
