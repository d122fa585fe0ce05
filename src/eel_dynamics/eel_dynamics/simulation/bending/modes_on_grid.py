# SPDX-License-Identifier: Apache-2.0
"""The modes of a robot on the grid, for the compiled mechanics: their rows of the law's tables, and what drives them.

A body with modes follows a law of more rows: those of the imposed law, masked where it is not imposed, and one for each
mode, whose factor is its coordinate. The coordinates are those of the modes and, behind series springs, the motors'.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from eel_model.body.grid import Grid
from eel_model.robot.actuators import Servo, Torque
from eel_model.robot.compiled import HINGE, ModeTable

import eel_core
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.curvature.tabulated_law import SEGMENT_AXES, TabulatedLaw, Tabulation
from eel_dynamics.simulation.discretisation import Discretisation

BETWEEN = np.array(((1.0, -1.0), (-1.0, 1.0)))  # what a spring between two coordinates does to each, by the other


class Motor(NamedTuple):
    """A servo, the mode of its joint, and the coordinate that it drives: behind a spring its own, else the mode's."""

    servo: Servo
    mode: int
    coordinate: int


class ModesOnGrid:
    """The M modes of `table` on a `grid`, whose panels end at their edges, and at the points of a `tabulation`.

    C coordinates: modes, then motors. It never changes.

    Attributes:
        motors: the servos.
        rows: (M, width) of the modes.
        mask: (2, width) 1 where the law is imposed in pitch, yaw.
        modes: the following for the compiled mechanics.
        axis, first, last: (M,) 0 pitch, 1 yaw; first node of the support, and the node behind its last.
        continuous: (M,) 1 for a mode of a tail or muscle, 0 for a joint.
        span, moment: (M,) integral of |B| [1, or m]; internal torque for a unit of the mode's force [1, or 1/m].
        inertia, rest: (C,). stiffness, damping: (C, C).
        servos: (coordinate, kp, kd, torque limit, speed limit) each.
        stops: (mode, low, high, stiffness, damping) each.
        torques: (coordinate, function of the time), or (coordinate, knots [s], cubics).
        drive, push: the law of the muscles' moments, and (C, its rows) what it does to the coordinates.
    """

    def __init__(self, table: ModeTable, grid: Grid, tabulation: Tabulation):
        self.table = table
        joints = table.degree == HINGE
        self.axis = (table.axis - 1).astype(np.uint64)
        self.first = np.searchsorted(grid.x, table.start, side="right").astype(np.uint64)
        self.last = np.searchsorted(grid.x, table.end, side="right").astype(np.uint64)
        self.continuous = (~joints).astype(np.uint64)
        self.span = np.where(joints, 1.0, table.end - table.start)
        self.moment = np.where(joints, 1.0, (2 * table.degree + 1) / self.span)  # P_n has the norm span / (2 n + 1)
        self.motors, size = [], len(table)
        for mode, actuator in table.motors:
            if isinstance(actuator, Servo):
                self.motors.append(Motor(actuator, mode, size if actuator.has_spring else mode))
                size += actuator.has_spring
        sprung = self.sprung
        self.inertia = np.array([*table.armature, *(motor.servo.inertia for motor in sprung)])
        # the rest angle is the joint's own spring's: a series spring has none between joint and motor
        self.rest = np.array([*table.rest, *(table.rest[motor.mode] for motor in sprung)])
        self.stiffness, self.damping = (
            np.pad(matrix, (0, size - len(table))) for matrix in (table.stiffness, table.damping)
        )
        for servo, *pair in sprung:
            self.stiffness[np.ix_(pair, pair)] += servo.series_stiffness * BETWEEN
            self.damping[np.ix_(pair, pair)] += servo.series_damping * BETWEEN
            self.damping[pair[1], pair[1]] += servo.friction
        self.servos = [
            (coordinate, servo.kp, servo.kd, servo.torque_limit or np.inf, servo.speed_limit or np.inf)
            for servo, _, coordinate in self.motors
        ]
        ends = np.column_stack((table.limits, table.stop_stiffness, table.stop_damping))
        limited = np.flatnonzero(np.isfinite(table.limits).any(axis=1)).tolist()
        self.stops = [(mode, *ends[mode].tolist()) for mode in limited]
        self.torques = [
            _given(mode, float(table.sign[mode]), actuator)
            for mode, actuator in table.motors
            if isinstance(actuator, Torque)
        ]
        self.drive, self.push = _muscles(table, size)
        self.modes = eel_core.Modes(self)
        self.rows = tabulation.columns(table.shape(tabulation.x))
        imposed, n, s = table.imposed(tabulation.x).astype(float), tabulation.nodes, tabulation.stations
        nodes, stations, further = imposed[:, :n], imposed[:, n : n + s], np.ones((2, tabulation.further))
        self.mask = np.concatenate((nodes, np.tile(nodes, 3), stations, np.tile(stations, 3), further), axis=1)

    def __deepcopy__(self, memo: dict[int, Any]) -> "ModesOnGrid":
        return self

    @property
    def sprung(self) -> list[Motor]:
        """The motors behind series springs, in the order of their coordinates."""
        return [motor for motor in self.motors if motor.servo.has_spring]

    def servo_of(self, joint: str) -> tuple[int, float]:
        """The number of the servo that drives a `joint`, and the joint's sign."""
        mode = self.table.name.index(joint)
        return [motor.mode for motor in self.motors].index(mode), float(self.table.sign[mode])

    def part_of(self, coordinate: int) -> str:
        """The name of the part that has a `coordinate`."""
        count = len(self.table)
        return self.table.name[coordinate if coordinate < count else self.sprung[coordinate - count].mode]

    def at_start(self, law: eel_core.LawOnGrid, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates (C,) and rates under a `law`: as given, as the servos' `reference` is, or where springs rest."""
        factors, given = np.array(law.factors(0.0)), self.table.initial
        first, rate = self.rest.copy(), np.zeros(len(self.rest))
        first[: len(given)] = np.where(np.isnan(given), first[: len(given)], given)
        for (_, mode, coordinate), row in zip(self.motors, reference, strict=True):
            there = factors[:2, : len(row)] @ row if np.isnan(given[mode]) else (given[mode], 0.0)
            first[[coordinate, mode]], rate[[coordinate, mode]] = there
        return first, rate

    def law(self, follower: LawFollower, tabulation: Tabulation) -> tuple[eel_core.LawOnGrid, np.ndarray]:
        """The law in force with the modes' rows, and what the servos follow: (servos, rows of the law)."""
        rows, axis = follower.rows()
        table = self.table
        bent = np.concatenate((rows * self.mask[axis], self.rows))
        tables = tabulation.law_tables(bent, np.concatenate((axis, table.axis - 1)))
        at_points = rows[:, tabulation.width - tabulation.further :]
        modes = [motor.mode for motor in self.motors]
        same = (table.axis[modes] - 1)[:, None] == axis
        reference = np.where(same, table.projection[modes] @ at_points.T, 0.0)
        return follower.on_tables(tables), np.ascontiguousarray(reference)


def _given(coordinate: int, sign: float, torque: Torque) -> tuple[Any, ...]:
    """A torque over time for the compiled mechanics."""
    if torque.spline is None:
        return coordinate, lambda time: sign * float(torque.at(time))
    cubics = np.ascontiguousarray(sign * torque.spline.c[::-1].T)
    return coordinate, np.array(torque.spline.x, dtype=float), cubics


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


def shapes_of_run(run: Any, table: ModeTable, here: Discretisation) -> Iterator[eel_core.LawOnGrid]:
    """For each sample of a robot's `run` a law whose curvature and rate at that time are the run's, on the grid `here`:
    for what is evaluated after the run."""
    tabulation = here.tabulation
    robot = ModesOnGrid(table, here.grid, tabulation)
    joints, sign = table.degree == HINGE, table.sign[table.degree == HINGE]
    motion = np.zeros((2, len(run.time), len(table)))  # coordinates, and their rates
    motion[0][:, joints], motion[1][:, joints] = run.joint_angle * sign, run.joint_rate * sign
    motion[0][:, ~joints], motion[1][:, ~joints] = run.mode_amplitude, run.mode_rate
    follower, now = LawFollower(tabulation, law=run.law), 0.0
    for sample, time in enumerate(run.time.tolist()):
        follower.pass_events(now, now := time)
        rows, axis = follower.rows()
        factors = np.array(follower.law_on_grid.factors(time))
        ends = np.zeros((2, 6, tabulation.width))  # for pitch and yaw: value, rate and acceleration at two instants
        for each in (0, 1):
            imposed, own = axis == each, table.axis - 1 == each
            for derivative in (0, 1):
                ends[each, derivative] = (
                    factors[derivative, imposed] @ rows[imposed] * robot.mask[each]
                    + motion[derivative, sample, own] @ robot.rows[own]
                )
        law_tables = tabulation.law_tables(ends.reshape(12, -1), SEGMENT_AXES)
        yield eel_core.LawOnGrid(law_tables, 0.0, [], (0, time, time + 1.0), None)
