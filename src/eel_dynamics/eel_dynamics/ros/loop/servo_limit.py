# SPDX-License-Identifier: Apache-2.0
"""Applies the parameter servo_torque_limit to the simulation, between two samples, in place of the servos' own
limits."""

from eel_common.ros.loop.diagnostics import Report

from eel_dynamics.ros.simulation_from_parameters import has_servos
from eel_dynamics.simulation.simulation import Simulation


class ServoLimit:
    """The torque limit of all servos of the robot of a `simulation`. For the run loop's thread.

    Attributes:
        present: the limit in force [N m]; 0: each servo has its own.
    """

    def __init__(self, simulation: Simulation, report: Report) -> None:
        self._report = report
        self.begin(simulation)

    def begin(self, simulation: Simulation) -> None:
        """Begin with a new `simulation`, whose servos have their own limits."""
        self._simulation, self._own, self.present = simulation, simulation.robot, 0.0

    def change(self, limit: float) -> None:
        """Limit each servo's torque at rest to `limit` [N m] from now on; 0: to its own limit."""
        self.present = limit
        if self._own is None or not has_servos(self._own):
            return  # the next reset may bring a robot with servos
        limited = self._own.changed("servos", torque_limit=limit) if limit > 0.0 else self._own
        self._simulation.change_robot(limited)
        most = f"is {limit:g} N m" if limit > 0.0 else "is its own"
        self._report.info(f"the torque limit of each servo {most} from t = {self._simulation.time:g} s on")
