# SPDX-License-Identifier: Apache-2.0
"""The modes of a robot on the grid, for the compiled mechanics: their rows of the law's tables, and what drives them.

A body with modes follows a law of more rows: those of the imposed law, masked where it is not imposed, and one for each
mode, whose factor is its coordinate. The coordinates are those of the modes and, behind series springs, the motors'.
"""

from typing import Any

import numpy as np

import eel_core
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.curvature.tabulated_law import TabulatedLaw, Tabulation
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.robot.actuators import Torque
from eel_dynamics.model.robot.compiled import ModeTable


class ModesOnGrid:
    """The M modes of `table` on a `grid`, whose panels end at their edges, and at the points of a `tabulation`.

    It never changes.

    Attributes:
        modes: for the compiled mechanics.
        rows: (M, width) of the modes.
        mask: (2, width) 1 where the law is imposed in pitch, yaw.
    """

    def __init__(self, table: ModeTable, grid: Grid, tabulation: Tabulation):
        self.table = table
        self.modes = eel_core.Modes(table, grid.x, [_given(table, *each) for each in table.torques], *_muscles(table))
        self.rows = tabulation.columns(table.shape(tabulation.x))
        imposed, n, s = table.imposed(tabulation.x).astype(float), tabulation.nodes, tabulation.stations
        nodes, stations, further = imposed[:, :n], imposed[:, n : n + s], np.ones((2, tabulation.further))
        self.mask = np.concatenate((nodes, np.tile(nodes, 3), stations, np.tile(stations, 3), further), axis=1)

    def __deepcopy__(self, memo: dict[int, Any]) -> "ModesOnGrid":
        return self

    def at_start(self, law: eel_core.LawOnGrid, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates (C,) and rates under a `law`: as given, as the servos' `reference` is, or where springs rest.

        Those of a joint lie within its limits.
        """
        factors, given = np.array(law.factors(0.0)), self.table.initial
        first, rate = self.table.rest.copy(), np.zeros(len(self.table.rest))
        first[: len(given)] = np.where(np.isnan(given), first[: len(given)], given)
        for (_, mode, coordinate), row in zip(self.table.motors, reference, strict=True):
            there = factors[:2, : len(row)] @ row if np.isnan(given[mode]) else (given[mode], 0.0)
            first[[coordinate, mode]], rate[[coordinate, mode]] = there
        inside = np.clip(first[: len(given)], *self.table.limits.T)
        for stopped in np.flatnonzero(inside != first[: len(given)]):
            own: list[Any] = [stopped, *(motor.coordinate for motor in self.table.motors if motor.mode == stopped)]
            first[own], rate[own] = inside[stopped], 0.0
        return first, rate

    def law(self, follower: LawFollower, tabulation: Tabulation) -> tuple[eel_core.LawOnGrid, np.ndarray]:
        """The law in force with the modes' rows, and what the servos follow: (servos, rows of the law)."""
        rows, axis = follower.rows()
        table = self.table
        bent = np.concatenate((rows * self.mask[axis], self.rows))
        tables = tabulation.law_tables(bent, np.concatenate((axis, table.axis - 1)))
        at_points = rows[:, tabulation.width - tabulation.further :]
        modes = [motor.mode for motor in table.motors]
        same = (table.axis[modes] - 1)[:, None] == axis
        reference = np.where(same, table.projection[modes] @ at_points.T, 0.0)
        return follower.on_tables(tables), np.ascontiguousarray(reference)


def _given(table: ModeTable, mode: int, torque: Torque) -> tuple[Any, ...]:
    """A torque over time for the compiled mechanics."""
    sign = float(table.sign[mode])
    if torque.spline is None:
        return mode, torque.called if sign > 0.0 else lambda time: -torque.called(time)
    return mode, np.array(torque.spline.x, dtype=float), np.ascontiguousarray(sign * torque.spline.c[::-1].T)


def _muscles(table: ModeTable) -> tuple[eel_core.LawOnGrid | None, np.ndarray]:
    """The law of the muscles' moments, and the rows that make the coordinates' forces of its factors."""
    coordinates = len(table.rest)
    if not table.muscles:
        return None, np.zeros((coordinates, 0))
    waves, axes, pushes = [], [], []
    count, none = 0, np.empty(0)
    for muscle in table.muscles:
        there = Tabulation(muscle.points, np.concatenate(([0.0], muscle.points[:-1])), none, none)
        source = TabulatedLaw.of_law(muscle.moment, 0.0, there)
        push = np.zeros((coordinates, len(source.rows)))
        push[muscle.modes] = muscle.projection @ source.rows[:, : len(muscle.points)].T
        waves += [(period, envelope, sine + count, cosine + count) for period, envelope, sine, cosine in source.waves]
        pushes.append(push)
        axes.append(source.axis)
        count += len(source.rows)
    empty = eel_core.LawTables(np.concatenate(axes).tolist(), np.zeros((count, 0)), 0, 0)
    return eel_core.LawOnGrid(empty, 0.0, waves, None, None), np.ascontiguousarray(np.concatenate(pushes, axis=1))


def motion_of_run(run: Any, table: ModeTable) -> np.ndarray:
    """(T, 2, M) coordinates of the modes of a robot's `run` at its samples, and their rates."""
    joints, sign = table.joints, table.sign[table.joints]
    motion = np.zeros((len(run.time), 2, len(table)))
    motion[:, 0, joints], motion[:, 1, joints] = run.joint_angle * sign, run.joint_rate * sign
    motion[:, 0, ~joints], motion[:, 1, ~joints] = run.mode_amplitude, run.mode_rate
    return motion
