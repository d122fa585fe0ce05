# SPDX-License-Identifier: Apache-2.0
"""What a robot's joints, motors and bending parts do at instants, from the coordinates of the march.

`JOINT_ARRAYS` is the one description of these quantities, as `OBSERVED` is of the swimmer's own. Joints are those of
`Robot.joints`, in their order and in their sign; modes are those of its tails and muscles, in section axes.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from eel_model.robot.compiled import HINGE
from eel_model.robot.joint import Joint
from eel_model.robot.robot import Robot

from eel_dynamics.simulation.bending.modes_on_grid import ModesOnGrid
from eel_dynamics.simulation.observations import Variable

JOINT = ("time", "joint")
JOINT_ARRAYS = {
    "joint_angle": Variable(JOINT, "rad", "angles of the robot's joints"),
    "joint_rate": Variable(JOINT, "rad/s", "rates of the angles"),
    "joint_torque": Variable(JOINT, "N m", "torque of motor and gear, or of the series spring, on the joint"),
    "motor_angle": Variable(JOINT, "rad", "angle of the motor behind its gear; the joint's where no spring is between"),
    "motor_torque": Variable(JOINT, "N m", "torque of the motor behind its gear"),
    "motor_power": Variable(JOINT, "W", "power of the motor"),
    "mode_amplitude": Variable(("time", "mode"), "rad/m", "curvature of the modes of tails and muscles"),
    "mode_rate": Variable(("time", "mode"), "rad/m/s", "its rate"),
}
ELASTIC, DAMPING_POWER, DAMPING_WORK = "elastic", "damping_power", "damping_work"


class KeptMotion(NamedTuple):
    """The motion of one robot's joints as a batch keeps it; as `JointMotion` otherwise."""

    kept: dict[str, np.ndarray]  # of JOINT_ARRAYS
    robot: np.ndarray  # (T, 3)

    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays of `JOINT_ARRAYS`."""
        return self.kept

    def ledger(self) -> np.ndarray:
        """As of `JointMotion`."""
        return self.robot


class MotionOfMany(NamedTuple):
    """The motion of the robots of B swimmers; of fewer joints or modes than the most, 0 fills the rest."""

    arrays: dict[str, np.ndarray]  # of JOINT_ARRAYS, (B, T, J) or (B, T, N)
    ledger: np.ndarray  # (B, T, 3)

    @staticmethod
    def of(motions: Sequence["JointMotion | None"], samples: np.ndarray, times: int) -> "MotionOfMany":
        """Those of `motions`, None without a robot, of which the first `samples` (B,) of T `times` are valid."""
        found = [{} if each is None else each.arrays() for each in motions]
        arrays = {}
        for name in JOINT_ARRAYS:
            most = max((each[name].shape[1] for each in found if each), default=0)
            arrays[name] = np.zeros((len(motions), times, most))
            for row, each, count in zip(arrays[name], found, samples.tolist(), strict=True):
                if each:
                    row[:count, : each[name].shape[1]] = each[name][:count]
        ledger = np.zeros((len(motions), times, 3))
        for row, motion, count in zip(ledger, motions, samples.tolist(), strict=True):
            if motion is not None:
                row[:count] = motion.ledger()[:count]
        return MotionOfMany(arrays, ledger)

    def one(self, index: int, robot: Robot) -> KeptMotion:
        """That of swimmer `index`."""
        modes = sum(part.modes for part in robot.parts if not isinstance(part, Joint))
        sizes = {"joint": len(robot.joints), "mode": modes}
        cut = {name: sizes[about.dimensions[1]] for name, about in JOINT_ARRAYS.items()}
        return KeptMotion({name: self.arrays[name][index, :, :most] for name, most in cut.items()}, self.ledger[index])


class JointMotion:
    """The motion of a robot's coordinates at T instants.

    rows: (T, R), as the core writes them at the `places` of their names. on_grid: the robot's modes.
    """

    def __init__(self, on_grid: ModesOnGrid, places: dict[str, tuple[int, int]], rows: np.ndarray):
        self._on_grid, self._places, self._rows = on_grid, places, rows

    def every(self, count: int) -> "JointMotion":
        """That at every so many of the instants."""
        return JointMotion(self._on_grid, self._places, self._rows[::count])

    def _of(self, name: str) -> np.ndarray:
        return self._rows[:, slice(*self._places[name])]

    def ledger(self) -> np.ndarray:
        """(T, 3): elastic energy [J], power [W] and work [J] of the dampers."""
        return np.concatenate([self._of(name) for name in (ELASTIC, DAMPING_POWER, DAMPING_WORK)], axis=1)

    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays of `JOINT_ARRAYS`."""
        table, x, rate = self._on_grid.table, self._of("x"), self._of("rate")
        joints = np.flatnonzero(table.degree == HINGE)
        motor = joints.copy()  # the coordinate of each joint's motor
        torque = self._of("pushing")[:, joints].copy()
        drives = table.actuators
        place = {int(mode): index for index, mode in enumerate(joints)}
        for index, mode in enumerate(drives.mode):
            motor[place[int(mode)]] = self._on_grid.coordinate[index]
        for column, mode in enumerate(self._on_grid.servo_modes):
            torque[:, place[int(mode)]] += self._of("torque")[:, column]
        on_joint = torque.copy()
        for index in np.flatnonzero(drives.series).tolist():
            at, own = place[int(drives.mode[index])], int(self._on_grid.coordinate[index])
            between, slip = x[:, own] - x[:, joints[at]], rate[:, own] - rate[:, joints[at]]
            on_joint[:, at] = drives.series_stiffness[index] * between + drives.series_damping[index] * slip
        sign = table.sign[joints]
        return {
            "joint_angle": x[:, joints] * sign + 0.0,
            "joint_rate": rate[:, joints] * sign + 0.0,
            "joint_torque": on_joint * sign + 0.0,
            "motor_angle": x[:, motor] * sign + 0.0,
            "motor_torque": torque * sign + 0.0,
            "motor_power": torque * rate[:, motor],
            "mode_amplitude": x[:, np.flatnonzero(table.degree != HINGE)].copy(),
            "mode_rate": rate[:, np.flatnonzero(table.degree != HINGE)].copy(),
        }
