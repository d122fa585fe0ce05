# SPDX-License-Identifier: Apache-2.0
"""The motion of a robot's joints, motors and bending parts at instants, from the coordinates of the march.

`JOINT_ARRAYS` is the one description of these quantities, as `OBSERVED` is of the swimmer's own. Joints are those of
`Robot.joints`, in their order and in their sign; modes are those of its tails and muscles, in section axes.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from eel_dynamics.model.robot.compiled import ModeTable, mode_table
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
OF_LEDGER = "elastic", "damping_power", "damping_work"  # a robot's part of the ledger [J, W, J]


class JointMotion:
    """The motion of a robot's coordinates at T instants, computed on request.

    rows: (T, R), as the core writes them at the `places` of their names.
    """

    def __init__(self, table: ModeTable, places: dict[str, tuple[int, int]], rows: np.ndarray):
        self._table, self._places, self._rows = table, places, rows

    def _of(self, name: str) -> np.ndarray:
        return self._rows[:, slice(*self._places[name])]

    @property
    def ledger(self) -> np.ndarray:
        """(T, 3): of `OF_LEDGER`."""
        return np.concatenate([self._of(name) for name in OF_LEDGER], axis=1)

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays of `JOINT_ARRAYS`."""
        table, x, rate = self._table, self._of("x"), self._of("rate")
        coordinate = np.arange(len(table))  # of each mode's motor
        torque = self._of("pushing")[:, coordinate]
        on_joint = torque.copy()
        for column, (servo, mode, own) in enumerate(table.motors):
            coordinate[mode] = own
            torque[:, mode] += self._of("torque")[:, column]
            on_joint[:, mode] = torque[:, mode]
            if servo.has_spring:
                between, slip = x[:, own] - x[:, mode], rate[:, own] - rate[:, mode]
                on_joint[:, mode] = servo.series_stiffness * between + servo.series_damping * slip
        joints, soft = np.flatnonzero(table.joints), np.flatnonzero(~table.joints)
        sign, motors, torque = table.sign[joints], coordinate[joints], torque[:, joints]
        return {
            "joint_angle": x[:, joints] * sign + 0.0,
            "joint_rate": rate[:, joints] * sign + 0.0,
            "joint_torque": on_joint[:, joints] * sign + 0.0,
            "motor_angle": x[:, motors] * sign + 0.0,
            "motor_torque": torque * sign + 0.0,
            "motor_power": torque * rate[:, motors],
            "mode_amplitude": x[:, soft],
            "mode_rate": rate[:, soft],
        }


def bends(swimmer: Any, joints: Mapping[str, Any]) -> np.ndarray:
    """(2, ..., M): angles [rad] of joints, and of modes times their length; and the rates of both [rad/s].

    swimmer: has the robot, its body and the scene. joints: arrays of `JOINT_ARRAYS`; M = 0 without them.
    """
    if swimmer.robot is None or joints.get("joint_angle") is None:
        return np.zeros((2, 0))
    table = mode_table(swimmer.robot, swimmer.body, swimmer.scene.planar)
    length = (table.end - table.start)[~table.joints]
    pairs = ("joint_angle", "mode_amplitude"), ("joint_rate", "mode_rate")
    return np.array([np.concatenate([joints[one], joints[other] * length], axis=-1) for one, other in pairs])


def stops_met(robot: Any, angles: np.ndarray) -> np.ndarray:
    """(J,) bool: which joints of a `robot` were beyond their limits at any of their `angles` (T, J) [rad]."""
    limits = [joint.limits or (-np.inf, np.inf) for joint in robot.joints]
    low, high = np.array(limits).reshape(-1, 2).T
    return np.asarray(((angles < low) | (angles > high)).any(axis=0))


def torque_at_stops(robot: Any, met: np.ndarray, apart: np.ndarray) -> float:
    """[N m]: what the greatest distances `apart` (J,) [rad] of two runs' joints are as torques of the stops that were
    `met` (J,), at most.

    A joint's angle in its free flight tells when it meets its stop. At that instant two runs may be alike by chance,
    but hardly at all instants before.
    """
    stiffness = np.array([joint.stop_stiffness for joint in robot.joints])
    return float((stiffness * apart)[met].max(initial=0.0))
