# SPDX-License-Identifier: Apache-2.0
"""The inputs of a run besides laws: commands of joints and fins, currents, external wrenches; and which are awaited."""

from eel_common.ros.loop.diagnostics import Report

from eel_dynamics.model.fins.fins import commanded_names
from eel_dynamics.ros.inputs.awaited import FINS, JOINTS, WRENCH, Awaited, wanted_inputs
from eel_dynamics.ros.inputs.command_messages import interfaces_of
from eel_dynamics.ros.inputs.command_queue import STAND_IN, FinCommands, JointCommands
from eel_dynamics.ros.inputs.current_taker import Currents
from eel_dynamics.ros.inputs.wrench_taker import ExternalWrenches
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.wrench_frames import wrench_frames
from eel_dynamics.simulation.simulation import Simulation


class Inputs:
    """The inputs of a `simulation` with the parameters `values`.

    Attributes:
        joints: JointCommands. fins: FinCommands. current: Currents. wrenches: ExternalWrenches.
        queues: these four.
        awaited: Awaited.
        acted: the number of times since the last sample that commands took effect.
    """

    def __init__(self, simulation: Simulation, values: DynamicsParameters, report: Report) -> None:
        self.awaited, lockstep = Awaited(report), values.real_time_factor == 0.0
        self.joints = JointCommands(self.awaited, lockstep, report)
        self.fins = FinCommands(self.awaited, lockstep, report)
        self.current = Currents(self.awaited, lockstep, report, values.world_frame)
        self.wrenches = ExternalWrenches(self.awaited, lockstep, report)
        self.queues = self.joints, self.fins, self.current, self.wrenches
        self.begin(simulation, values)

    def begin(self, simulation: Simulation, values: DynamicsParameters) -> None:
        """Begin at time 0 of a `simulation`, perhaps a new one, without any input so far."""
        self.joints.begin(simulation, interfaces_of(simulation.robot, values.command_interfaces))
        self.fins.begin(simulation)
        self.current.begin(simulation)
        self.wrenches.begin(simulation, values)
        self.awaited.begin(values.wait_for, parts_of(simulation, values), 1.0 / values.rate)
        if self.awaited.names(JOINTS) and not simulation.ready:
            simulation.adopt(STAND_IN)  # a controller manager sends its first command after time has begun
        self.acted = 0

    def next_instant(self, before: float) -> float:
        """The time [s] of the next command, or `before` [s] if no command comes earlier."""
        return min(queue.next_instant(before) for queue in self.queues)

    def act(self) -> None:
        """Let the commands of the present time act."""
        for queue in self.queues:
            self.acted += queue.act()


def parts_of(simulation: Simulation, values: DynamicsParameters) -> dict[str, tuple[str, ...]]:
    """Names of the joints and fins of a `simulation` that can be commanded, and of frames of wrenches, by topic."""
    robot, fins = simulation.robot, commanded_names(simulation.fins)
    joints = () if robot is None else robot.driven_names
    return {JOINTS: joints, FINS: fins, WRENCH: tuple(wrench_frames(values))}


def check_inputs(simulation: Simulation, values: DynamicsParameters) -> None:
    """`ValueError` if the parameters of inputs among `values` do not fit a `simulation`."""
    interfaces_of(simulation.robot, values.command_interfaces)
    wanted_inputs(values.wait_for, parts_of(simulation, values))
