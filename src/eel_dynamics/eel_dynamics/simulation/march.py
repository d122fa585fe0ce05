# SPDX-License-Identifier: Apache-2.0
"""The march in time of a swimmer: under one law after another, on a grid that fits the law.

A robot, whose joints, tails and muscles bend by themselves, takes the steps of eel_core/bending/rosenbrock.hpp, at any
`Accuracy.method`.
"""

import math
import threading
from collections.abc import Callable
from copy import copy, deepcopy
from typing import Any

import numpy as np
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

import eel_core
from eel_dynamics.accuracy.grid_settings import GridSettings, ShapeNeeds
from eel_dynamics.accuracy.step_bounds import step_bounds_of
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.model.fins.fins import given_angles
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.initial_state import InitialState, time_scale
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench, core_wrenches, next_jump
from eel_dynamics.simulation.bending.joint_motion import JointMotion
from eel_dynamics.simulation.bending.modes_on_grid import ModesOnGrid
from eel_dynamics.simulation.discretisation import discretise
from eel_dynamics.simulation.energy import WORKS
from eel_dynamics.simulation.observations import Observations, Snapshot
from eel_dynamics.simulation.stopping import (
    SimulationStopped,
    by_part,
    first_bad_sample,
    left_grid,
    outside_flow,
    remedy,
    stopped_by,
    stopped_in_flow,
)
from eel_dynamics.simulation.swimmer import Swimmer

UNCUT = 2**62  # nodes that a march evaluates before it returns: all
MARCHED, SINGULAR, UNFINISHED = (eel_core.STATUSES.index(name) for name in ("marched", "singular", "unfinished"))


class March:
    """A march of a `swimmer` from its start under its law, whose own t = 0 lies at `origin` [s].

    Without a law the body is straight.
    `ValueError` if the law cannot begin, `SimulationStopped` if the energy of the initial state is not finite.

    Attributes:
        core: the march of eel_core: state, works and counts.
        time: [s], the present.
        settings: of the grid.
        discretisation: body and scene on the grid.
        robot: its modes on the grid; None without one.
        joints: as of `Simulation.joints`.
        follower: what drives the shape, and its blends.
        law_on_grid: the law or the samples in force, on the grid.
        energy_at_start: [J], kinetic and potential.
    """

    @np.errstate(over="ignore", invalid="ignore")  # values that are not finite are reported
    def __init__(self, swimmer: Swimmer, origin: float = 0.0):
        law = swimmer.law
        self.swimmer, self.time, self._time_scale = swimmer, 0.0, swimmer.time_scale
        self._needs = swimmer.shape_needs(law)
        self._commands: dict[str, float] = {}  # rad, of fins
        self._held: dict[float, ExternalWrench] = {}  # by station [m]: applied wrenches
        self._next_jump = math.inf  # s, of an external wrench
        self._reference = np.zeros((0, 0))  # references of a robot's servos, from the law's factors
        self.core = eel_core.March(*self._on_grid(swimmer.grid_for(self._needs)))
        self._places = self.core.row
        self.joints: JointMotion | None = None
        self.follower = LawFollower(self.discretisation.tabulation, swimmer.default_transition, law, origin)
        self._hand_over_law()
        position, orientation, _ = swimmer.start
        shape = () if self.robot is None else self.robot.at_start(self.law_on_grid, self._reference)
        self.energy_at_start: float = self.core.start(position, orientation, swimmer.initial_twist, *shape)
        if not np.isfinite(self.energy_at_start):
            stopped = SimulationStopped(0.0, "kinetic energy", self.energy_at_start, "start slower")
            stopped = stopped_in_flow(swimmer.flow, self.core, 0.0) or stopped
            raise stopped if law is None else ValueError(f"law {shown(law.name)} cannot be begun: {stopped.quantity}")

    def __deepcopy__(self, memo: dict[int, Any]) -> "March":
        """Constant data are shared."""
        copied = object.__new__(type(self))
        copied.__dict__.update(self.__dict__)
        copied.core, copied.follower = copy(self.core), copy(self.follower)
        return copied

    def __getstate__(self) -> dict[str, Any]:
        """Without data that follow from others. The state of the core's march is in bytes."""
        left_out = "core", "discretisation", "robot", "law_on_grid", "_bounds", "_places"
        kept = {name: value for name, value in self.__dict__.items() if name not in left_out}
        return kept | {"core": self.core.state_as_bytes()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.core = eel_core.March(*self._on_grid(self.settings))
        self._places = self.core.row
        self.follower.tabulate(self.discretisation.tabulation)
        self._hand_over_law()
        self.core.set_state_from_bytes(state["core"])

    def copy_with(self, swimmer: Swimmer) -> "March":
        """A copy in the present state of a `swimmer` with another accuracy, on a grid for it, or with another robot."""
        copied, finer = deepcopy(self), swimmer.settings.resolution / self.swimmer.settings.resolution
        copied.swimmer, resolution = swimmer, max(1.0, finer * self.settings.resolution)
        copied._change_grid(self.settings._replace(resolution=resolution, kinks=swimmer.settings.kinks))
        return copied

    # -- law and grid

    def change_law(self, law: Law | SampledLaw, origin: float, transition: float, needs: ShapeNeeds):
        """Follow `law` from now on, with a blend over `transition` [s].

        origin [s]: the time of the law's own t = 0. The grid fits the `needs` of the law and of the last one.
        """
        both = ShapeNeeds(max(self._needs.waves, needs.waves), needs.knots)
        self._fit(both)
        self.follower.blend_into(law, origin=origin, time=self.time, transition=transition)
        self._hand_over_law()
        self._needs = needs

    def change_flow(self, flow: Flow | None):
        """Let the water move by `flow` from now on, at present with the same velocity as before."""
        self.swimmer = self.swimmer.unchecked(flow=flow)
        self._fit(self._needs)
        self._hand_over_law()

    def change_robot(self, robot: Robot | None):
        """Continue with a robot that differs only in its numbers."""
        self.swimmer = self.swimmer.unchecked(robot=robot)
        self._change_grid(self.settings)

    def command_fins(self, commands: dict[str, float]):
        """Have the servos of fins follow these angles [rad] from now on."""
        self._commands = self._commands | commands
        self._hand_over_law()

    def apply_wrench(self, wrench: ExternalWrench):
        """Hold a constant `wrench` from now on, instead of the previous one at its station."""
        if all(each.station != wrench.station for each in self.swimmer.wrenches):  # a panel must end there
            self.swimmer = self.swimmer.unchecked(wrenches=(*self.swimmer.wrenches, ExternalWrench(wrench.station)))
        self._held = self._held | {wrench.station: wrench}
        edges = self.swimmer.grid_for(self._needs).edges
        if edges == self.settings.edges:
            self._hand_over_law()
        else:
            self._change_grid(self.settings._replace(edges=edges))

    def command(
        self, joint: str, position: float | None = None, velocity: float | None = None, effort: float | None = None
    ) -> None:
        """As `Simulation.command`."""
        assert self.swimmer.modes is not None
        servo, sign, low, high = self.swimmer.modes.driven[joint]
        kind = "law" if effort is None else "effort"
        if position is not None or velocity is not None:
            kind = "velocity" if position is None else "position"
        angle, rate, torque = sign * (position or 0.0), sign * (velocity or 0.0), sign * (effort or 0.0)
        self.core.command(servo, kind, angle, rate, torque, low, high)

    def _fit(self, needs: ShapeNeeds, coarser: bool = False):
        """Make the grid fine enough for the `needs`. coarser: coarsen a grid that is much finer."""
        wanted = self.swimmer.grid_for(needs)
        settings = self.settings.fitted(wanted) if coarser else self.settings.at_least(wanted)
        if settings is not self.settings:
            self._change_grid(settings)

    def _change_grid(self, settings: GridSettings):
        """Continue on a grid of these `settings`. The head's motion does not change."""
        old, twist = self.discretisation.grid, self.twist
        self.core.change(*self._on_grid(settings))
        there = self.discretisation.tabulation
        self.follower.move(there, old.interpolation_at(there.x))
        self._hand_over_law()
        self.core.set_twist(twist)

    def _on_grid(self, settings: GridSettings) -> tuple[Any, ...]:
        """What the core's march is of, on a grid of these `settings`, which are in force from now on."""
        self.settings, self.discretisation = settings, discretise(self.swimmer, settings)
        grid, _, swimmer, *_, tabulation = self.discretisation
        table, by = self.swimmer.modes, self.swimmer.settings
        self.robot = None if table is None else ModesOnGrid(table, grid, tabulation)
        modes = None if self.robot is None else self.robot.modes
        return swimmer, by.method, by.order, bool(self.swimmer.scene.planar), modes

    def _hand_over_law(self, smoothly: bool = False):
        """Continue under the follower's law. The steps restart, unless the motion continues `smoothly`."""
        swimmer, follower = self.swimmer, self.follower
        law = self.law_on_grid = follower.law_on_grid
        scale, speed = min(follower.time_scale, self._time_scale), follower.speed(swimmer.body.length)
        self._bounds = step_bounds_of(swimmer, self.discretisation, follower.between_samples, scale, speed)
        breakpoints = sorted({*follower.breakpoints, *swimmer.breakpoints})
        if self.robot is not None:
            law, self._reference = self.robot.law(follower, self.discretisation.tabulation)
        steps, water = (breakpoints, self._bounds, bool(swimmer.scene.ledger)), (swimmer.current, swimmer.core_flow)
        angles = given_angles(swimmer.fins, self._commands)
        self.core.follow(law, *steps, *water, smoothly, angles, self._reference, self._wrenches())

    def _wrenches(self) -> list[Any]:
        """The external wrenches for the core, up to the next jump."""
        swimmer, wrenches = self.swimmer, (*self.swimmer.wrenches, *self._held.values())
        self._next_jump = next_jump(wrenches, self.time)
        where = swimmer.body, self.discretisation.grid, swimmer.x
        return core_wrenches(wrenches, *where, self.time, bool(swimmer.scene.planar)) if wrenches else []

    # -- march

    def advance(self, time: float, interrupted: Callable[[], bool] | None) -> bool:
        """As `Simulation.advance`."""
        while True:
            event = self._pass_event()
            while (status := self.core.advance(min(time, event))) == UNFINISHED:
                if interrupted is not None and interrupted():
                    self.time = self.core.time
                    return False
            self.time = self.core.time
            if status != MARCHED:
                raise self._stopped(status)
            if time <= event:
                break
        self.follower.end_blend(self.time)
        if self.follower.law_on_grid is not self.law_on_grid:
            self._hand_over_law(smoothly=True)
            if not self.follower.sampled and self.follower.law is not None:
                self._fit(self.swimmer.shape_needs(self.follower.law), coarser=not self.follower.blending)
        return True

    def _pass_event(self) -> float:
        """Make the changes of the source of curvature, and jumps of wrenches, that are due at present. Returns the time
        [s] of the next one.

        From one pair of samples to the next the curvature has two continuous derivatives, and the motion continues
        smoothly: the rate of the momentum depends on the curvature and its rate.
        """
        follower, before = self.follower, self.follower.between_samples
        follower.pass_event(self.time, lambda waves: self._fit(ShapeNeeds(waves), coarser=not follower.blending))
        if self.time >= self._next_jump:
            self._hand_over_law()
        elif follower.law_on_grid is not self.law_on_grid:
            self._hand_over_law(smoothly=before and follower.between_samples)
        return min(follower.next_event(self.time), self._next_jump)

    def record(self, times: np.ndarray, wrench: bool, load: bool, look=None, enough=None) -> tuple:
        """As `Simulation.record`. enough(out, works): called after each sample; whether to end."""
        out = Observations(
            len(times), len(self.swimmer.x), wrench, load, len(self.swimmer.fins), len(self.swimmer.sensors)
        )
        works, done, status = np.zeros((len(times), len(WORKS))), 0, MARCHED
        rows = self._empty_rows(len(times))
        self.joints = joints = self._joints(rows)
        alone = look is None and threading.current_thread() is not threading.main_thread()
        cut = self.core.set_slice(UNCUT) if alone else None  # no signal arrives, returns wait for Python's lock
        while status == MARCHED and done < len(times):
            event, status = self._pass_event(), UNFINISHED
            until = event if enough is None else min(event, times[done])
            while status == UNFINISHED:
                done, status = self.core.record(times, done, out.whole, works, rows, bool(wrench), bool(load), until)
                if status == MARCHED and done < len(times) and until == event:
                    status = self.core.advance(event)
                if look is not None and status == UNFINISHED:
                    look(self.core.time)
            self.time = self.core.time
            if enough is not None and enough(out, works[:done]):
                break
        if cut is not None:
            self.core.set_slice(cut)
        checked = bool(self.swimmer.scene.ledger) and self.swimmer.settings.method == "classical"
        still = self._bounds.momentum_floor
        floor = still * still / self.discretisation.mass if checked else np.inf
        ledger = None if joints is None else joints.ledger
        failure = first_bad_sample(out, works, done, self.energy_at_start, floor, ledger)
        done = failure[0] if failure else done
        if done:
            self.time = float(times[done - 1])
        if failure:
            bad = SimulationStopped(self.time, *failure[1:], remedy(self.swimmer.settings))
            return out, works, done, outside_flow(self.swimmer.flow, times[done], out.backbone[done]) or bad
        return out, works, done, None if status == MARCHED else self._stopped(status)

    def _stopped(self, status: int) -> SimulationStopped:
        """The error for the `status` of a march."""
        by_status = stopped_by(status, self.time, self._bounds, self.swimmer.settings)
        stopped = stopped_in_flow(self.swimmer.flow, self.core, self.time) or by_status
        return stopped if self.robot is None else by_part(stopped, self.core, self.robot.table, status == SINGULAR)

    # -- the present

    def _joints(self, rows: np.ndarray) -> JointMotion | None:
        return None if self.robot is None else JointMotion(self.robot.table, self._places, rows)

    def _empty_rows(self, samples: int) -> np.ndarray:
        return np.zeros((samples, self._places["damping_work"][1]))

    def observe(self, wrench: bool = True, load: bool = True) -> Snapshot:
        """As `Simulation.observe`."""
        scene = self.swimmer.scene
        wrench, load = bool(wrench and scene.internal_wrench), bool(load)
        rows = self._empty_rows(1)
        ledger = (np.array(self.core.works), self.energy_at_start) if scene.ledger else None
        joints = self._joints(rows)
        fins, sensors = len(self.swimmer.fins), len(self.swimmer.sensors)
        snapshot = Snapshot(self.time, self.swimmer.x, wrench, load, fins, ledger, joints, sensors)
        if not self.core.observe(snapshot.whole, rows, wrench, load):
            raise self._stopped(SINGULAR)
        if self.swimmer.flow is not None and self.core.outside is not None:
            raise left_grid(self.swimmer.flow, self.core.outside)
        return snapshot

    @property
    def twist(self) -> np.ndarray:
        """(6,) of the head in its axes at present, relative to the water."""
        try:
            return np.array(self.core.twist())
        except ValueError:
            raise self._stopped(SINGULAR) from None

    @property
    def head(self) -> InitialState:
        """As `Simulation.head`."""
        state = np.array(self.core.state)
        return InitialState(state[:3], state[3:7], self.twist).against_water(self.swimmer.current)

    def set_state(self, state: InitialState):
        """Set the `state` of the head at the present time; the steps restart.

        `ValueError` if its energy is not finite; the march is then unchanged.
        """
        before, twist, relative = np.array(self.core.state), self.twist, state.in_water(self.swimmer.current)
        with np.errstate(over="ignore", invalid="ignore"):
            energy = self.core.set_state(state.position, state.orientation, relative)
            present = self.core.set_state(before[:3], before[3:7], twist)
        if not np.isfinite(energy):
            raise ValueError(f"twist must give a finite kinetic energy, got {energy} J")
        self._time_scale = min(self.swimmer.time_scale, time_scale(relative, self.swimmer.body.length))
        self._hand_over_law()
        self.core.set_state(state.position, state.orientation, relative)
        self.energy_at_start += energy - present
