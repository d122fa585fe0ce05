# SPDX-License-Identifier: Apache-2.0
"""Passes wrenches of the topic `external_wrench` to the simulation at their times. Each holds until the next one in its
frame."""

from typing import Any

from eel_common.ros.loop.diagnostics import Report

from eel_dynamics.ros.inputs.awaited import WRENCH, Awaited
from eel_dynamics.ros.inputs.command_messages import Values, wrench_from_message
from eel_dynamics.ros.inputs.command_queue import CommandQueue
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.wrench_frames import Frames, wrench_frames
from eel_dynamics.simulation.simulation import Simulation


class ExternalWrenches(CommandQueue):
    """External wrenches on the sections of `wrench_frames`."""

    topic, parts = WRENCH, "wrenches"

    def __init__(self, awaited: Awaited, lockstep: bool, report: Report) -> None:
        super().__init__(awaited, lockstep, report)
        self._frames: Frames = {}
        self._head = ""

    def begin(self, simulation: Simulation, values: DynamicsParameters) -> None:
        """Begin at time 0 of a `simulation`, without wrenches."""
        self._frames, self._head = wrench_frames(values), values.head_frame
        self._begin(simulation, tuple(self._frames))

    def read(self, message: Any) -> tuple[float, Values]:
        stamp, frame, wrench = wrench_from_message(message, self._frames, self._head, self.simulation.time)
        self.simulation.check_wrench(self._frames[frame], wrench[:3], wrench[3:])
        return stamp, {frame: wrench}

    def give(self, values: Values) -> None:
        for frame, wrench in values.items():
            self.simulation.apply_wrench(self._frames[frame], wrench[:3], wrench[3:])
