# SPDX-License-Identifier: Apache-2.0
"""The march of a swimmer whose joints, tails and muscles bend by themselves: a robot."""

from typing import Any

import numpy as np
from eel_base.wording import shown

import eel_core
from eel_dynamics.accuracy.error_estimate import TORQUE_FLOOR
from eel_dynamics.accuracy.grid_settings import GridSettings
from eel_dynamics.simulation.bending.joint_motion import JointMotion
from eel_dynamics.simulation.bending.modes_on_grid import RobotTables
from eel_dynamics.simulation.discretisation import Discretisation, discretise
from eel_dynamics.simulation.march import SINGULAR, March
from eel_dynamics.simulation.observations import Observations, Snapshot
from eel_dynamics.simulation.simulation_setup import SimulationSetup
from eel_dynamics.simulation.stopping import SimulationStopped


class BentMarch(March):
    """A `March` of a robot. Its steps are those of eel_core/bending/rosenbrock.hpp, at any `Accuracy.method`."""

    def __init__(self, *arguments):
        self._rows: np.ndarray | None = None
        super().__init__(*arguments)

    def _discretise(self, settings: GridSettings) -> Discretisation:
        setup, table = self.setup, self.setup.modes
        assert table is not None
        here = discretise(setup.body, setup.scene, settings, setup.x.tobytes(), table.points.tobytes(), setup.fins)
        self.robot = RobotTables.of(table, here.grid, here.tabulation)
        return here

    def _new_core(self) -> Any:
        return eel_core.BentMarch(self.discretisation.swimmer, self.robot.modes, bool(self.setup.scene.planar))

    def _start(self, *state) -> float:
        on_grid, factors = self.robot.on_grid, np.array(self.law_on_grid.factors(0.0))
        first, given = on_grid.rest.copy(), on_grid.table.initial
        rate = np.zeros(len(first))
        first[: len(given)] = np.where(np.isnan(given), first[: len(given)], given)
        for (coordinate, *_), mode, row in zip(on_grid.servos, on_grid.servo_modes, self._reference, strict=True):
            there = factors[:2, : len(row)] @ row if np.isnan(given[mode]) else (given[mode], 0.0)
            first[[coordinate, mode]], rate[[coordinate, mode]] = there
        return float(self.core.start(*state, first, rate))

    def _step_bounds(self) -> eel_core.StepBounds:
        bounds = super()._step_bounds()
        return with_tolerance(bounds, np.inf) if self.setup.settings.method == "classical" else bounds

    def _change_core(self) -> None:
        self.core.change(self.discretisation.swimmer, self.robot.modes, bool(self.setup.scene.planar))

    def _hand_over_law(self, smoothly: bool = False):
        setup = self.setup
        self.law_on_grid, self._bounds = self.follower.law_on_grid, self._step_bounds()
        bent, self._reference = self.robot.law(self.follower, self.discretisation.tabulation)
        scale = min(self.follower.time_scale, self._time_scale, 1.0)
        floor = TORQUE_FLOOR * self.discretisation.mass * (setup.body.length / scale) ** 2
        self.core.follow(
            bent,
            self._reference,
            self.robot.drive,
            self.robot.push,
            self._breakpoints,
            self._bounds,
            floor,
            bool(setup.scene.ledger),
            *self._water(smoothly),
        )

    def _stopped(self, status: int) -> SimulationStopped:
        """As of `March`, with the part that is to blame, and what would help."""
        stopped, table = super()._stopped(status), self.robot.on_grid.table
        singular = self.core.singular_mode() if status == SINGULAR else None
        place = self.core.hardest if singular is None else singular
        mode = (
            place
            if place < len(table)
            else int(table.actuators.mode[np.flatnonzero(table.actuators.series)][place - len(table)])
        )
        part = shown(table.name[mode])
        if status == SINGULAR:
            hint = f"{part} has no inertia of its own: give it an armature, or a support apart from the others"
        else:
            hint = f"{part} asks for the shortest steps: give it damping or an armature; or {stopped.hint}"
        return SimulationStopped(stopped.time, stopped.quantity, stopped.value, hint)

    def record(self, times: np.ndarray, *arguments) -> tuple:
        """As `March.record`; `joints` has the coordinates."""
        self._rows = self._empty(len(times))
        return super().record(times, *arguments)

    def _record(self, times: np.ndarray, first: int, out: Observations, works: np.ndarray, *rest) -> tuple[int, int]:
        return self.core.record(times, first, out.whole, works, self._rows, *rest)

    def _observe(self, snapshot: Snapshot, wrench: bool, load: bool) -> bool:
        row = self._empty(1)
        snapshot.keep_joints(self._motion(row))
        return bool(self.core.observe(snapshot.whole, row, wrench, load))

    @property
    def joints(self) -> JointMotion | None:
        """The motion of the joints at the samples of the last `record`."""
        return None if self._rows is None else self._motion(self._rows)

    def _empty(self, samples: int) -> np.ndarray:
        return np.zeros((samples, max(end for _, end in self.core.row.values())))

    def _motion(self, rows: np.ndarray) -> JointMotion:
        return JointMotion(self.robot.on_grid, self.core.row, rows)

    def command(self, joint: str, kind: str, value: float) -> None:
        """As `Simulation.command`."""
        table = self.robot.on_grid.table
        mode = table.name.index(joint)
        servo = list(self.robot.on_grid.servo_modes).index(mode)
        self.core.command(servo, kind, float(table.sign[mode] * value))


def with_tolerance(bounds: eel_core.StepBounds, tolerance: float) -> eel_core.StepBounds:
    """The same `bounds` with another tolerance; infinite: steps of one length."""
    names = ["longest", "smallest", "length", "momentum_floor", "part_of_span", "most_steps", "spare_steps"]
    return eel_core.StepBounds(tolerance=tolerance, **{name: getattr(bounds, name) for name in names})


def march_of(setup: SimulationSetup) -> type[March]:
    """The kind of march that a `setup` needs."""
    return March if setup.robot is None else BentMarch
