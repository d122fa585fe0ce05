# SPDX-License-Identifier: Apache-2.0
"""The set-up of a simulation: its checked arguments, and the accuracy and grid that follow from them."""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from eel_common.cached import cached_property
from eel_common.quantity import checked_instance, checked_row, positive
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

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
from eel_dynamics.model.initial_state import InitialState, checked_state, time_scale
from eel_dynamics.model.robot.compiled import ModeTable, mode_table
from eel_dynamics.model.robot.robot import Robot, checked_robot
from eel_dynamics.model.scene import Scene, checked_scene
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench, checked_wrenches, instants_of

FITTING = 1e-6  # of the body's length: tolerance for the length of a law's rows


@dataclass(frozen=True, eq=False)
class SimulationSetup(EqualByFields):
    """The constant part of a simulation, which marches and resets keep. `of` checks the arguments."""

    body: Body
    scene: Scene
    accuracy: Accuracy  # as given
    x: np.ndarray  # (M,) m, stations
    initial_state: InitialState
    default_transition: float  # s
    most_evaluations: float  # per simulated second
    flow: Flow | None
    robot: Robot | None
    fins: tuple[Fin, ...]
    wrenches: tuple[ExternalWrench, ...] = ()
    sensors: tuple[float, ...] = ()  # m, X of the observed ones, rising
    until: float = 0.0  # s, until which functions of time are sampled beforehand; 0: not at all

    @staticmethod
    def of(
        *,
        body=None,
        scene=None,
        accuracy=STANDARD,
        stations=51,
        position=(0.0, 0.0, 0.0),
        orientation=(0.0, 0.0, 0.0, 1.0),
        twist=(0.0,) * 6,
        flow=None,
        robot=None,
        fins=None,
        sensors=(),
        wrenches=None,
        most_evaluations=MOST_EVALUATIONS,
        default_transition=DEFAULT_TRANSITION,
    ) -> "SimulationSetup":
        """The set-up from the arguments of `Simulation`. `ValueError` names an unsuitable one."""
        robot = checked_robot(robot)
        body = checked_body(robot.body if body is None and robot is not None else body)
        scene, accuracy, x = checked_scene(scene), Accuracy.of(accuracy), checked_stations(stations, body.length)
        start = _checked_start(scene, position, orientation, twist, flow)
        fins, wrenches = checked_fins(fins, body, scene), checked_wrenches(wrenches, body, bool(scene.planar))
        if robot is not None:
            mode_table(robot, body, bool(scene.planar))
        most_evaluations = positive("most_evaluations", most_evaluations, "per simulated second")
        transition = positive("default_transition", default_transition, "s")
        where = checked_sensors(sensors, body.length)
        how = start, transition, most_evaluations
        return SimulationSetup(body, scene, accuracy, x, *how, flow, robot, fins, wrenches, where)

    def starting(self, position, orientation, twist, flow) -> "SimulationSetup":
        """The same with another start and flow. `ValueError` as in `of`."""
        start = _checked_start(self.scene, position, orientation, twist, flow)
        return replace(self, initial_state=start, flow=flow)

    def with_robot(self, robot: Robot | None) -> "SimulationSetup":
        """The same with other numbers of the robot. `ValueError` for other parts, or at other places."""
        changed = replace(self, robot=checked_robot(robot))
        parts = changed.robot.parts if changed.robot and changed.modes else ()  # they fit the body
        if [*map(_place, parts)] != [*map(_place, self.robot.parts if self.robot else ())]:
            raise ValueError("robot must have the same parts at the same places to go on")
        return changed

    def __hash__(self) -> int:  # type: ignore[override]
        water, parts = (self.scene, self.flow), (self.robot, self.fins, self.wrenches, self.sensors)
        return hash((self.body, self.accuracy, self.x.tobytes(), *water, *parts))

    def __deepcopy__(self, memo: dict) -> "SimulationSetup":
        return self

    def __getstate__(self) -> dict[str, Any]:  # without cached values
        return {each.name: getattr(self, each.name) for each in fields(self)}

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
        place, turn, _ = (tuple(each.tolist()) for each in self.initial_state)
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
        return self.initial_state.in_water(self.current)

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


def _place(part: Any) -> tuple[Any, ...]:
    """Kind and place of a part of a robot, and whether it has its own coordinates."""
    where = (getattr(part, name, None) for name in ("position", "start", "end", "width", "modes", "axis"))
    return type(part), *where, getattr(getattr(part, "actuator", None), "has_spring", False)


def _checked_start(scene: Scene, position, orientation, twist, flow) -> InitialState:
    """The start. `ValueError` for a start or flow that `scene` does not allow, or for a head out of the water."""
    start = checked_state(scene.planar, position, orientation, twist)
    flow = checked_flow(flow, scene.planar)
    check_covers(flow, 0.0)
    if flow is not None and (out := flow.outside(0.0, start.position)):
        raise ValueError(f"position must lie in the grid of the flow, {out[0]}, got {shown(start.position.tolist())}")
    if flow is not None and start.position[2] > flow.traits.surface_height:
        raise ValueError(f"flow surface must be above the head, at z = {start.position[2]:g} m, got {flow!r}")
    return start


def checked_stations(stations, length: float) -> np.ndarray:
    """X (M,) [m] of the stations: a number of equidistant ones, or X that rise within 0 to `length` [m]."""
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
