"""The swimmer's messages into one Rerun stream: one method for each message, each called at the message's own time.

Geometry is drawn in single precision at one rate; scalars and profiles go in as they are, in double precision, at
another (see `Rates`). What belongs together has the same time, and that is all that ties it: the skin takes its shape
from the backbone and its colour from the torque, whichever comes first. Rows are sent together (see `outlet`): call
`attend` now and then, and `send` at the end.
"""

import reprlib
from dataclasses import dataclass

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.messages import Backbone, Body, Load, Pose, Profiles, Status, Twist
from eel_viz.outlet import Outlet
from eel_viz.plots.comparison import Comparison
from eel_viz.plots.heat_map import HeatMap
from eel_viz.plots.profile_plot import ProfilePlot
from eel_viz.plots.series import log_styles
from eel_viz.plots.state_text import Summary
from eel_viz.scene3d import colours
from eel_viz.scene3d.arrows import Arrows
from eel_viz.scene3d.camera import Steady
from eel_viz.scene3d.orientation import attitude
from eel_viz.scene3d.skin import Skin
from eel_viz.scene3d.surroundings import Water, log_legend
from eel_viz.scene3d.track import Track
from eel_viz.settings import Settings
from eel_viz.stations import same

ENVELOPE_PERIOD = 500_000_000  # ns
HEAT_MAP_PERIOD = 200_000_000
SUMMARY_PERIOD = 500_000_000
LOG_NAMES = reprlib.Repr()
LOG_NAMES.maxstring = 220  # characters of a law's name, which is not yet checked here
LEVELS = ("INFO", "WARN", "ERROR", "WARN")


@dataclass(frozen=True, kw_only=True)
class Rates:
    """How often [Hz of simulation time] numbers and drawings go in; 0: with every message.

    `tick` [s of wall time] is how long they may wait to be sent together.
    """

    numbers: float = 0.0
    drawings: float = 25.0
    tick: float = 0.2


class Loggers:
    """Everything about one run, into one `stream`.

    With `settings.compare`, `other` takes the messages of the other run, by the same methods; `name` is this run's.
    """

    def __init__(self, stream: rr.RecordingStream, settings: Settings, rates: Rates, name: str = "eel") -> None:
        self._outlet = outlet = Outlet(stream, tick=rates.tick)
        self._settings = settings
        self._number_period = _period(rates.numbers)
        self._drawing_period = _period(rates.drawings)
        self._slots: dict[str, int] = {}
        self._stations: dict[str, np.ndarray] = {}
        self._skin: Skin | None = None
        self._statuses: dict[str, tuple[int, str]] = {}
        self.summary = Summary()
        outlet.fixed(entities.WORLD, rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        self._camera = Steady()
        self._water = Water(outlet)
        self._track = Track(outlet)
        self._torque = ProfilePlot(
            outlet, entities.TORQUE, names=("C1", "C2", "C3"), unit="N m", limit=settings.torque_limit
        )
        self._force = ProfilePlot(
            outlet, entities.FORCE, names=("N1", "N2", "N3"), unit="N", limit=settings.force_limit
        )
        self._curvature = ProfilePlot(
            outlet,
            entities.CURVATURE,
            names=("K2", "K3"),
            unit="rad/m",
            limit=settings.curvature_limit,
            palette=colours.AXIS[1:],
        )
        self._heat_map = HeatMap(outlet, limit=settings.colour_limit)
        log_legend(outlet, limit=settings.colour_limit, unit="N m", name="C3")
        self._arrows = Arrows(outlet, load_scale=settings.load_scale, end_scale=settings.end_force_scale)
        log_styles(outlet)
        outlet.fixed(entities.BACKBONE, rr.LineStrips3D.from_fields(colors=[colours.LABEL], radii=[0.0004]))
        for path in (entities.HEAD, entities.TAIL):
            outlet.fixed(path, rr.TransformAxes3D(0.12))
        self._comparison: Comparison | None = None
        if settings.compare:
            self._comparison = Comparison(
                outlet,
                names=(name, settings.compare.strip("/") or "eel"),
                limit=settings.torque_limit,
                due=self._due,
                drawings=self._drawing_period,
            )

    @property
    def other(self):
        """What takes the messages of the run that this one is compared with."""
        if self._comparison is None:
            raise ValueError("there is no other run: settings.compare is empty")
        return self._comparison.other

    def attend(self) -> None:
        """Now and then: send what has waited long enough."""
        self._outlet.attend()

    def send(self) -> None:
        """Send all that waits, before the stream ends."""
        self._outlet.send()

    # --- the swimmer ---------------------------------------------------------------------------------------------
    def body(self, body: Body) -> None:
        """The geometry, valid at all times."""
        self._skin = Skin(body.x, body.half_width, body.half_height)
        self.summary.body = body
        if self._comparison:
            self._comparison.this.summary.body = body
        self._outlet.fixed(entities.SKIN, rr.Mesh3D.from_fields(triangle_indices=self._skin.triangles))
        values = {name: getattr(body, name) for name in ("length", "mass", "x", "half_width", "half_height")}
        self._outlet.fixed(entities.BODY_NUMBERS, rr.DynamicArchetype("BodyGeometry", components=values))

    def head_pose(self, stamp: int, pose: Pose) -> None:
        """Path, attitude and depth of the head."""
        self.summary.move(stamp, pose.position)
        if self._comparison:
            self._comparison.this.head_pose(stamp, pose)
        if self._due("head_pose", stamp, self._number_period):
            scalars = self._outlet.scalars
            scalars(stamp, entities.POSITION, pose.position)
            scalars(stamp, entities.ORIENTATION, pose.orientation)
            scalars(stamp, entities.ATTITUDE, np.degrees(attitude(pose.orientation)))
            scalars(stamp, entities.DEPTH, -pose.position[2:])
        if self._due("track", stamp, self._drawing_period):
            self._track.draw(stamp, pose.position)
            self._place(stamp, entities.HEAD, pose.position, pose.orientation)
        if self._due("summary", stamp, SUMMARY_PERIOD):
            self._summarise(stamp)

    def head_twist(self, stamp: int, twist: Twist) -> None:
        """Speed, and the velocities of the head in its own axes."""
        if self._due("head_twist", stamp, self._number_period):
            self._outlet.scalars(stamp, entities.SPEED, [np.linalg.norm(twist.linear)])
            self._outlet.scalars(stamp, entities.LINEAR, twist.linear)
            self._outlet.scalars(stamp, entities.ANGULAR, twist.angular)

    def odom(self, stamp: int, pose: Pose, twist: Twist) -> None:
        """The numbers of odom; what they show is drawn from head_pose and head_twist."""
        if self._due("odom", stamp, self._number_period):
            values = {"position": pose.position, "orientation": pose.orientation}
            values |= {"linear": twist.linear, "angular": twist.angular}
            self._numbers(stamp, entities.ODOMETRY_NUMBERS, "Odometry", values)

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Line, skin, floor and camera."""
        position = backbone.position
        if self._due("backbone", stamp, self._number_period):
            line = position[None].astype(np.float32)
            self._outlet.row(stamp, entities.BACKBONE, rr.LineStrips3D, strips=line)
        if not self._due("skin", stamp, self._drawing_period):
            return
        middle = self._camera.follow(stamp, position.mean(axis=0))
        self._outlet.row(stamp, entities.FOLLOW, rr.Transform3D, translation=middle[None])
        self._place(stamp, entities.TAIL, position[-1], backbone.orientation[-1])
        self._water.draw(stamp, position, middle)
        if self._skin is not None:
            vertices, normals = self._skin.place(backbone.x, position, backbone.orientation)
            self._outlet.row(stamp, entities.SKIN, rr.Mesh3D, vertex_positions=vertices, vertex_normals=normals)
        self._arrows.backbone(stamp, backbone)

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        """Torques and forces along the body; C3 colours the skin and makes the heat map."""
        torque = wrench.together("torque_1", "torque_2", "torque_3")
        force = wrench.together("force_1", "force_2", "force_3")
        self.summary.strain(stamp, wrench.x, torque[:, 2])
        if self._comparison:
            self._comparison.this.internal_wrench(stamp, wrench)
        self._torque.include(wrench.x, torque)
        self._force.include(wrench.x, force)
        if self._due("wrench", stamp, self._number_period):
            self._numbers(stamp, entities.WRENCH_NUMBERS, "InternalWrench", wrench.values, wrench.x)
        self._heat_map.include(stamp, wrench.x, torque[:, 2])
        if self._due("profiles", stamp, self._drawing_period):
            self._torque.draw(stamp, wrench.x, torque)
            self._force.draw(stamp, wrench.x, force)
            if self._skin is not None:
                shades = colours.diverging(self._skin.spread(wrench.x, torque[:, 2]), self._settings.colour_limit)
                self._outlet.row(stamp, entities.SKIN, rr.Mesh3D, vertex_colors=shades)
        if self._due("envelope", stamp, ENVELOPE_PERIOD):
            self._torque.draw_envelope(stamp)
            self._force.draw_envelope(stamp)
        if self._due("heat_map", stamp, HEAT_MAP_PERIOD):
            self._heat_map.draw(stamp)

    def curvature(self, stamp: int, curvature: Profiles) -> None:
        """K2 and K3 as the body has them."""
        values = curvature.together("pitch", "yaw")
        self._curvature.include(curvature.x, values)
        if self._due("curvature", stamp, self._number_period):
            self._numbers(stamp, entities.CURVATURE_NUMBERS, "Curvature", curvature.values, curvature.x)
        if self._due("curvature drawn", stamp, self._drawing_period):
            self._curvature.draw(stamp, curvature.x, values)
        if self._due("curvature envelope", stamp, ENVELOPE_PERIOD):
            self._curvature.draw_envelope(stamp)

    def hydrodynamic_load(self, stamp: int, load: Load) -> None:
        """The fluid's force on the body, as arrows in the world."""
        if self._due("load", stamp, self._number_period):
            values = {**load.profiles.values, "tail_force": load.tail, "nose_force": load.nose}
            self._numbers(stamp, entities.LOAD_NUMBERS, "HydrodynamicLoad", values, load.profiles.x)
        if self._due("arrows", stamp, self._drawing_period):
            self._arrows.load(stamp, load)

    def energy(self, stamp: int, energy: dict[str, float]) -> None:
        """The ledger's terms."""
        if self._due("energy", stamp, self._number_period):
            powers = [energy[f"{name}_power"] for name in ("actuator", "wake", "nose", "drag")]
            self._outlet.scalars(stamp, entities.POWER, powers)
            self._outlet.scalars(stamp, entities.KINETIC, [energy["kinetic_body"], energy["kinetic_fluid"]])
            self._outlet.scalars(stamp, entities.RESIDUAL, [energy["residual"]])

    # --- the run -------------------------------------------------------------------------------------------------
    def law(self, stamp: int, name: str) -> None:
        """The law that was published, by name."""
        self.summary.law = name
        if self._comparison:
            self._comparison.this.law(stamp, name)
        self._text(stamp, f"law {LOG_NAMES.repr(name)} published", "INFO")

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Each status whose level or words have changed, as text; the values go into the summary."""
        if self._comparison:
            self._comparison.this.diagnostics(stamp, statuses)
        for status in statuses:
            if self.summary.status(stamp, status.message, status.values):
                self._summarise(self.summary.stamp)
            if self._statuses.get(status.name) != (status.level, status.message):
                self._statuses[status.name] = (status.level, status.message)
                self._text(stamp, f"{status.name}: {status.message}", LEVELS[min(status.level, 3)])

    # --- how it is logged ----------------------------------------------------------------------------------------
    def _due(self, what: str, stamp: int, period: int) -> bool:
        """Whether `stamp` [ns] lies in a new slot of `period` [ns]."""
        if period:
            slot = (stamp + 1000) // period  # stamps are rounded to ns
            if self._slots.get(what) == slot:
                return False
            self._slots[what] = slot
        return True

    def _place(self, stamp: int, path: str, position: np.ndarray, orientation: np.ndarray) -> None:
        self._outlet.row(stamp, path, rr.Transform3D, translation=position[None], quaternion=orientation[None])

    def _numbers(
        self, stamp: int, path: str, name: str, values: dict[str, np.ndarray], x: np.ndarray | None = None
    ) -> None:
        """Arrays as components of their own; the stations only when they are new."""
        known = self._stations.get(path)
        if x is not None and (known is None or not same(known, x)):
            self._stations[path] = x
            values = {"x": x, **values}
        self._outlet.numbers(stamp, path, name, values)

    def _summarise(self, stamp: int) -> None:
        self._outlet.once(stamp, entities.RUN, rr.TextDocument(self.summary.text(), media_type="text/markdown"))

    def _text(self, stamp: int, text: str, level: str) -> None:
        self._outlet.once(stamp, entities.LOG, rr.TextLog(text, level=level))


def _period(rate: float) -> int:
    return round(1e9 / rate) if rate else 0
