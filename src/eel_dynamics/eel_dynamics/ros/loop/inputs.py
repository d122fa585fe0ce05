# SPDX-License-Identifier: Apache-2.0
"""What comes to a swimmer besides laws: commands of joints and fins, and currents; and which of it a run waits for."""

from eel_ros.loop.diagnostics import Report

from eel_dynamics.ros.command_messages import interfaces_of
from eel_dynamics.ros.loop.command_queue import FinCommands, JointCommands
from eel_dynamics.ros.loop.current_taker import CurrentTaker
from eel_dynamics.simulation.simulation import Simulation


class Inputs:
    """The inputs of a `simulation` whose joints are driven by `interfaces`: one for all, or one for each.

    Attributes:
        joints: JointCommands. fins: FinCommands. current: CurrentTaker.
        acted: the number of times that commands have taken effect since the last sample.
    """

    def __init__(self, simulation: Simulation, interfaces: tuple[str, ...], report: Report) -> None:
        self.joints, self.fins, self.current = JointCommands(report), FinCommands(report), CurrentTaker(report)
        self._queues = self.joints, self.fins
        self._awaited = self.joints.awaited, self.fins.awaited, self.current.awaited
        self.begin(simulation, interfaces)

    def begin(self, simulation: Simulation, interfaces: tuple[str, ...]) -> None:
        """Begin at time 0 of a `simulation`, which may be another one, without commands and currents so far."""
        self.joints.begin(simulation, interfaces_of(simulation.robot, interfaces))
        self.fins.begin(simulation)
        self.current.reset()
        self.acted = 0

    def missing(self, time: float, now: float, timeout: float) -> list[str]:
        """The topics to wait for at the sample of `time` [s], for `timeout` [s] at most. now: [s, steady clock]."""
        return [each.topic for each in self._awaited if each.waits(time, now, timeout)]

    def next_instant(self, before: float) -> float:
        """The time [s] of the next command, or of the next sample, `before` [s], if none comes first."""
        return min(queue.next_instant(before) for queue in self._queues)

    def act(self) -> None:
        """Give the commands of the present time."""
        for queue in self._queues:
            self.acted += queue.act()
