# SPDX-License-Identifier: Apache-2.0
"""The modes of a robot on the grid, for the compiled mechanics: their rows of the law's tables, and what drives them.

A body with modes follows a law of more rows: those of the imposed law, masked where it is not imposed, and one for each
mode, whose factor is its coordinate. The coordinates are those of the modes and, behind series springs, the motors'.
"""

from typing import NamedTuple

import numpy as np
from eel_model.body.grid import Grid
from eel_model.robot.compiled import HINGE, ModeTable

import eel_core
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.curvature.tabulated_law import TabulatedLaw, Tabulation


class ModesOnGrid:
    """The M modes of `table` on a `grid`, whose panels end at their edges. C coordinates: modes, then motors.

    Attributes, as `eel_core.Modes` takes them:
        axis, first, last: (M,) 0 pitch, 1 yaw; first node of the support, and the node behind its last.
        continuous: (M,) 1 for a mode of a tail or muscle, 0 for a joint.
        span, moment: (M,) integral of |B| [1, or m]; internal torque for a unit of the mode's force [1, or 1/m].
        inertia, rest: (C,). stiffness, damping: (C, C).
        servos: (coordinate, kp, kd, torque limit, speed limit) each.
        stops: (mode, low, high, stiffness, damping) each.
        torques: (coordinate, function of the time), or (coordinate, knots [s], cubics).
    """

    def __init__(self, table: ModeTable, grid: Grid):
        self.table = table
        joints = table.degree == HINGE
        self.axis = (table.axis - 1).astype(np.uint64)
        self.first = np.searchsorted(grid.x, table.start, side="right").astype(np.uint64)
        self.last = np.searchsorted(grid.x, table.end, side="right").astype(np.uint64)
        self.continuous = (~joints).astype(np.uint64)
        self.span = np.where(joints, 1.0, table.end - table.start)
        self.moment = np.where(joints, 1.0, (2 * table.degree + 1) / self.span)  # P_n has the norm span / (2 n + 1)
        drives, count = table.actuators, len(table)
        motors = np.flatnonzero(drives.series)
        size = count + len(motors)
        self.inertia = np.concatenate((table.armature, drives.inertia[motors])).astype(float)
        self.rest = np.concatenate((table.rest, np.zeros(len(motors)))).astype(float)
        self.stiffness, self.damping = np.zeros((size, size)), np.zeros((size, size))
        self.stiffness[:count, :count], self.damping[:count, :count] = table.stiffness, table.damping
        self.coordinate = drives.mode.astype(int).copy()  # (A,) that each actuator drives
        for place, index in enumerate(motors):
            mode, motor = drives.mode[index], count + place
            self.coordinate[index] = motor
            for matrix, value in (
                (self.stiffness, drives.series_stiffness[index]),
                (self.damping, drives.series_damping[index]),
            ):
                matrix[np.ix_((mode, motor), (mode, motor))] += value * np.array(((1.0, -1.0), (-1.0, 1.0)))
            self.damping[motor, motor] += drives.friction[index]
        # the rest angle is the joint's own spring's: a series spring has none between joint and motor
        self.rest[count:] = self.rest[drives.mode[motors]] if len(motors) else []
        servos = [index for index, kind in enumerate(drives.kind) if kind == "servo"]
        self.servo_modes = drives.mode[servos].astype(int)
        gains = np.stack((drives.kp, drives.kd, drives.torque_limit, drives.speed_limit), axis=1)
        self.servos = [(int(self.coordinate[index]), *_four(gains[index])) for index in servos]
        ends = np.column_stack((table.limits, table.stop_stiffness, table.stop_damping)).reshape(count, 4)
        limited = np.flatnonzero(np.isfinite(table.limits).any(axis=1))
        self.stops = [(int(mode), *_four(ends[mode])) for mode in limited]
        self.torques = [
            _given(int(mode), float(table.sign[mode]), torque)
            for mode, torque in zip(drives.mode, drives.torque, strict=True)
            if torque is not None
        ]


def _four(row: np.ndarray) -> tuple[float, float, float, float]:
    first, second, third, fourth = row.tolist()
    return first, second, third, fourth


def _given(coordinate: int, sign: float, torque) -> tuple:
    """A torque over time for the compiled mechanics."""
    if torque.spline is None:
        return coordinate, lambda time: sign * float(torque.at(time))
    cubics = np.ascontiguousarray(sign * torque.spline.c.T)
    return coordinate, np.array(torque.spline.x, dtype=float), cubics


class RobotTables(NamedTuple):
    """What does not change with the law: on one grid."""

    modes: eel_core.Modes
    on_grid: ModesOnGrid
    rows: np.ndarray  # (M, width) of the modes
    mask: np.ndarray  # (2, width) 1 where the law is imposed in pitch, yaw
    drive: eel_core.LawOnGrid | None  # of muscles
    push: np.ndarray  # (C, rows of `drive`)

    @staticmethod
    def of(table: ModeTable, grid: Grid, tabulation: Tabulation) -> "RobotTables":
        """The tables of a robot on a grid and the points of a `tabulation`."""
        on_grid, x = ModesOnGrid(table, grid), tabulation.x
        behind = x > table.start[:, None]  # a node at a support's start belongs to the panel ahead
        rows = tabulation.columns(np.where(behind, table.shape(x), 0.0))
        imposed = np.ones((2, len(x)))
        for axis, start, end in table.free:
            imposed[axis - 1, (x > start) & (x <= end)] = 0.0
        n, s = tabulation.nodes, tabulation.stations
        nodes, stations = imposed[:, :n], imposed[:, n : n + s]
        mask = np.concatenate(
            (nodes, np.tile(nodes, 3), stations, np.tile(stations, 3), np.ones((2, tabulation.further))), axis=1
        )
        drive, push = _muscles(table, len(on_grid.inertia))
        return RobotTables(eel_core.Modes(on_grid), on_grid, rows, mask, drive, push)

    def law(self, follower: LawFollower, tabulation: Tabulation) -> tuple[eel_core.LawOnGrid, np.ndarray]:
        """The law in force with the modes' rows, and what the servos follow: (servos, rows of the law)."""
        rows, axis = follower.rows()
        table = self.on_grid.table
        bent = np.concatenate((rows * self.mask[axis], self.rows))
        tables = tabulation.law_tables(bent, np.concatenate((axis, table.axis - 1)))
        at_points = rows[:, tabulation.width - tabulation.further :]
        modes = self.on_grid.servo_modes
        same = (table.axis[modes] - 1)[:, None] == axis
        reference = np.where(same, table.projection[modes] @ at_points.T, 0.0)
        return follower.on_tables(tables), np.ascontiguousarray(reference)


def _muscles(table: ModeTable, coordinates: int) -> tuple[eel_core.LawOnGrid | None, np.ndarray]:
    """The law of the muscles' moments, and the rows that make the coordinates' forces of its factors."""
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
