# SPDX-License-Identifier: Apache-2.0
"""One swimmer in its water as one value: everything that a simulation starts from."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from eel_common.cached import cached_property
from eel_common.quantity import checked_instance, checked_row, number, positive
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw
from numpy.typing import ArrayLike

import eel_core
from eel_dynamics.accuracy.accuracy import STANDARD, Accuracy
from eel_dynamics.accuracy.grid_settings import GridSettings, ShapeNeeds
from eel_dynamics.accuracy.law_waves import check_law, knots_of_law, waves_of_rows
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS, check_cost
from eel_dynamics.accuracy.sudden_changes import UNSEEN, given_torques, sudden_changes
from eel_dynamics.curvature.curvature_samples import check_points
from eel_dynamics.curvature.law_follower import DEFAULT_TRANSITION
from eel_dynamics.model.body.body import Body, checked_body
from eel_dynamics.model.equality import EqualByFields
from eel_dynamics.model.fins.fins import Fin, checked_fins, edges_of, knots_of, servo_time
from eel_dynamics.model.flow.flow import Flow, check_covers, checked_flow, core_flow
from eel_dynamics.model.initial_state import AT_REST, InitialState, checked_state, time_scale
from eel_dynamics.model.robot.compiled import ModeTable, mode_table
from eel_dynamics.model.robot.robot import Robot, checked_robot
from eel_dynamics.model.scene import OF_PAPER, Scene, checked_scene
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench, checked_wrenches, instants_of

OF_STANDARD = Accuracy.of(STANDARD)
FITTING = 1e-6  # of the body's length: tolerance for the length of a law's rows


@dataclass(frozen=True, eq=False)
class Swimmer(EqualByFields):
    """A swimmer, its water and its start, checked when it is made. It never changes.

    `ValueError` names a bad field. World and head have REP-103 axes.
    """

    law: Any = None  #: a `Law` or `SampledLaw`, the first that it follows, and what servos follow; None: straight
    body: Body = None  # type: ignore[assignment]  #: None: the robot's, or that of the paper
    scene: Scene = OF_PAPER  #: the physics and the water
    accuracy: Accuracy = OF_STANDARD  #: or a preset's name, or a target relative error
    start: InitialState = AT_REST  #: of the head
    flow: Flow | None = None  #: the water's own motion, besides the scene's current
    robot: Robot | None = None  #: None: the law is imposed
    fins: tuple[Fin, ...] = ()  #: may be given as a list of fins and of pairs of them
    stations: Any = 51  #: number of equidistant ones, or X (M,) [m]; None: no profiles along the body
    wrenches: tuple[ExternalWrench, ...] = ()  #: from outside
    sensors: tuple[float, ...] = ()  #: X [m] of the stations whose motion is observed; then rising, each once
    default_transition: float = DEFAULT_TRANSITION  #: s, of a blend if the law gives none
    most_evaluations: float = MOST_EVALUATIONS  #: of the head's dynamics per simulated second
    until: float = 0.0  #: s, until which functions of time are sampled beforehand; 0: not at all

    def __post_init__(self) -> None:
        robot = checked_robot(self.robot)
        body = checked_body(robot.body if self.body is None and robot is not None else self.body)
        scene = checked_scene(self.scene)
        self._set(robot=robot, body=body, scene=scene, accuracy=Accuracy.of(self.accuracy))
        if np.iterable(self.stations):
            self._set(stations=tuple(checked_stations(self.stations, body.length).tolist()))
        else:
            checked_stations(self.stations, body.length)
        self._set(start=_checked_start(scene, self.start, self.flow), fins=checked_fins(self.fins, body, scene))
        self._set(wrenches=checked_wrenches(self.wrenches, body, bool(scene.planar)))
        if robot is not None:
            mode_table(robot, body, bool(scene.planar))  # it fits the body
        self._set(most_evaluations=positive("most_evaluations", self.most_evaluations, "per simulated second"))
        self._set(default_transition=positive("default_transition", self.default_transition, "s"))
        number("until", self.until, "s", minimum=0.0)
        self._set(sensors=checked_sensors(self.sensors, body.length), law=self._checked_law())

    def _set(self, **fields: Any) -> None:
        self.__dict__.update(fields)

    def _checked_law(self) -> Any:
        law = self.law
        if law is not None:
            check_planar_law(checked_instance("law", law, (Law, SampledLaw)), self.scene)
        return law

    @classmethod
    def of(
        cls,
        *,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        twist: ArrayLike | None = None,
        start: InitialState = AT_REST,
        **others: Any,
    ) -> Self:
        """The swimmer of these fields. The parts of the `start` may be given one by one."""
        start = _as_start(start)
        given = {"position": position, "orientation": orientation, "twist": twist}
        parts: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
        return cls(start=start._replace(**parts), **others)

    def changed(self, **fields: Any) -> Self:
        """The same with other fields, as in `of`. All are checked again."""
        return self.of(**self._fields | fields)

    def unchecked(self, **fields: Any) -> Self:
        """The same with other fields, which are not checked: they fit, or the whole is checked later (`changed`)."""
        if unknown := fields.keys() - self.__dataclass_fields__.keys():
            raise TypeError(f"{type(self).__name__} has no field {', '.join(sorted(unknown))}")
        made = object.__new__(type(self))
        made._set(**self._fields | fields)
        return made

    @property
    def _fields(self) -> dict[str, Any]:
        return {name: self.__dict__[name] for name in self.__dataclass_fields__}

    def starting(self, start: InitialState, flow: Flow | None) -> Self:
        """The same with another start and flow. `ValueError` for one that the scene does not allow."""
        return self.unchecked(start=_checked_start(self.scene, start, flow), flow=flow)

    def with_robot(self, robot: Robot | None) -> Self:
        """The same with other numbers of the robot. `ValueError` for other parts, or at other places."""
        changed = self.unchecked(robot=checked_robot(robot))
        parts = changed.robot.parts if changed.robot and changed.modes else ()  # they fit the body
        if [each.geometry for each in parts] != [each.geometry for each in (self.robot.parts if self.robot else ())]:
            raise ValueError("robot must have the same parts at the same places to go on")
        return changed

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __getstate__(self) -> dict[str, Any]:  # without cached values
        return self._fields

    @cached_property
    def x(self) -> np.ndarray:
        """X (M,) [m] of the stations."""
        return checked_stations(self.stations, self.body.length)

    def check_stations(self) -> None:
        """`ValueError` without stations, which only a swimmer of a batch may lack."""
        if self.stations is None:
            raise ValueError("stations must be a number of them, or their X in m, got None: only a batch takes it")

    @property
    def has_internal_wrench(self) -> bool:
        """Whether the internal wrench along the body is computed."""
        return self.scene.internal_wrench and self.stations is not None

    @cached_property
    def current(self) -> np.ndarray:
        """Velocity (3,) [m/s] of the water, in the world frame."""
        return np.array(self.scene.current)

    @cached_property
    def core_flow(self) -> eel_core.Flow | None:
        """The flow for the core."""
        return None if self.flow is None else core_flow(self.flow, bool(self.scene.planar))

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Times [s] at which a derivative of the flow, of the fins' angles, of muscles' moments or of a wrench from
        outside jumps, or data given over time change suddenly."""
        of_flow = () if self.flow is None else self.flow.traits.breakpoints
        of_robot = () if self.robot is None else self.robot.ramp_ends
        return *of_flow, *knots_of(self.fins), *of_robot, *instants_of(self.wrenches), *self.sudden_changes

    @cached_property
    def sudden_changes(self) -> frozenset[float]:
        """As `sudden_changes`."""
        place, turn, _ = (tuple(each.tolist()) for each in self.start)
        return sudden_changes(self.robot, self.flow, place, turn, self.body.length, self.until, self.wrenches)

    @property
    def longest_step(self) -> float:
        """The longest step [s] that resolves functions of torques and wrenches; infinite if these are sampled
        beforehand."""
        functions = any(torque.time is None for torque in given_torques(self.robot))
        unseen = not self.until and (functions or any(wrench.is_function for wrench in self.wrenches))
        return UNSEEN if unseen else np.inf

    @property
    def time_scale_of_surroundings(self) -> float:
        """Shortest time scale [s] of flow and fins; inf if they have none."""
        return min(servo_time(self.fins), np.inf if self.flow is None else self.flow.traits.time_scale)

    def grid_for(self, needs: ShapeNeeds) -> GridSettings:
        """The settings of the grid for the `needs` of a law and the flow's, with panels that end at fins and
        at wrenches from outside."""
        if self.flow is not None:
            needs = needs._replace(waves=max(needs.waves, self.body.length / self.flow.traits.shortest_wave))
        of_modes = () if self.modes is None else self.modes.edges
        stations = [*(fin.station for fin in self.fins), *(wrench.station for wrench in self.wrenches)]
        edges = tuple(sorted({*of_modes, *edges_of(self.body, stations, of_modes)}))
        return GridSettings(self.settings.points_per_length(needs.waves), self.settings.kinks, needs.knots, edges)

    @cached_property
    def modes(self) -> ModeTable | None:
        """The modes of the robot on the body; None without one."""
        return None if self.robot is None else mode_table(self.robot, self.body, bool(self.scene.planar))

    @cached_property
    def initial_twist(self) -> np.ndarray:
        """Initial twist (6,) [rad/s, m/s] of the head relative to the current, in the head's axes."""
        return self.start.in_water(self.current)

    @cached_property
    def time_scale(self) -> float:
        """Time scale [s] of the initial velocity."""
        return time_scale(self.initial_twist, self.body.length)

    def shape_needs(self, law: Law | SampledLaw | None) -> ShapeNeeds:
        """The needs of `law` for a grid.

        `ValueError` for a law that the scene or the limit of evaluations does not allow.
        """
        check_cost("flow or fins change within", self.time_scale_of_surroundings, self.most_evaluations)
        if law is None:
            return ShapeNeeds()
        checked_instance("law", law, (Law, SampledLaw))
        check_planar_law(law, self.scene)
        length = self.body.length
        if isinstance(law, Law):
            period = min((term.period for term in law.waves), default=np.inf)
            check_cost(f"law {shown(law.name)} has a period of", period, self.most_evaluations)
            return ShapeNeeds(check_law(law, length), knots_of_law(law))
        if abs(law.length - length) > FITTING * length:
            raise ValueError(f"law {shown(law.name)} is for a body of {law.length:g} m, the body has {length:g} m")
        check_points(len(law.x))
        return ShapeNeeds(waves_of_rows(law))

    @cached_property
    def settings(self) -> Accuracy:
        """The settings of the accuracy in this scene."""
        settings = self.accuracy.in_scene(self.scene)
        if self.robot is None:
            return settings
        return settings.for_robot(any(servo and servo.has_spring for servo in self.robot.servos))


def _as_start(start: Any) -> InitialState:
    if not isinstance(start, (tuple, list)) or len(start) != len(InitialState._fields):
        raise ValueError(f"start must be an InitialState, its position, orientation and twist, got {shown(start)}")
    return InitialState(*start)


def _checked_start(scene: Scene, start: Any, flow: Any) -> InitialState:
    """The start. `ValueError` for a start or flow that `scene` does not allow, or for a head out of the water."""
    start = checked_state(scene.planar, *_as_start(start))
    flow = checked_flow(flow, scene.planar)
    check_covers(flow, 0.0)
    if flow is not None and (out := flow.outside(0.0, start.position)):
        raise ValueError(f"position must lie in the grid of the flow, {out[0]}, got {shown(start.position.tolist())}")
    if flow is not None and start.position[2] > flow.traits.surface_height:
        raise ValueError(f"flow surface must be above the head, at z = {start.position[2]:g} m, got {flow!r}")
    return start


def checked_stations(stations, length: float) -> np.ndarray:
    """X (M,) [m] of the stations: a number of them, X that rise within 0 to `length` [m], or None: the head alone."""
    if stations is None:
        return np.zeros(1)
    if isinstance(stations, (int, np.integer)) and not isinstance(stations, bool):
        if not 2 <= stations <= 100_000:
            raise ValueError(f"stations must be 2 or more, or their X in m, got {shown(stations)}")
        return np.linspace(0.0, length, int(stations))
    x = checked_row("stations", stations, None)
    if len(x) < 1 or np.any(np.diff(x) <= 0.0) or x[0] < 0.0 or x[-1] > length * (1 + 1e-12):
        raise ValueError(f"stations must rise within 0 to {length} m, got {shown(stations)}")
    return np.minimum(x, length)


def checked_sensors(places: Any, length: float) -> tuple[float, ...]:
    """X [m] of sensors, rising and distinct, from `places`. `ValueError` for one outside 0 to `length` [m]."""
    x = checked_row("sensors", places, None)
    for each in x:
        if not 0.0 <= each <= length * (1 + 1e-12):
            raise ValueError(f"sensors must lie within 0 to {length:g} m, got {each:g} m")
    return tuple(np.unique(np.minimum(x, length)).tolist())


def check_planar_law(law: Law | SampledLaw, scene: Scene) -> None:
    """`ValueError` for a `law` that bends the body out of the plane of a planar `scene`."""
    if scene.planar and not law.in_plane:
        raise ValueError(f"law {shown(law.name)} has a pitch term: a planar scene cannot bend out of its plane")
