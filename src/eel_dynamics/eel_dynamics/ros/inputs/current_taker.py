# SPDX-License-Identifier: Apache-2.0
"""Passes samples of the topic `current` to the simulation at their times; logs when samples stop and return."""

from typing import Any

import numpy as np
from eel_common.ros.loop.diagnostics import Report

from eel_dynamics.ros.inputs.awaited import ALL, CURRENT, Awaited
from eel_dynamics.ros.inputs.command_messages import Values, current_from_message
from eel_dynamics.ros.inputs.command_queue import CommandQueue
from eel_dynamics.simulation.simulation import Simulation


class Currents(CommandQueue):
    """Samples of a current in the frame `world_frame`. The water changes to it from its time on (`CurrentStream`)."""

    topic, hold = CURRENT, False

    def __init__(self, awaited: Awaited, lockstep: bool, report: Report, world_frame: str) -> None:
        super().__init__(awaited, lockstep, report)
        self._world_frame, self._taken = world_frame, False

    def begin(self, simulation: Simulation) -> None:
        """Begin at time 0 of a `simulation`."""
        self._begin(simulation, (ALL,))

    def read(self, message: Any) -> tuple[float, Values]:
        stamp, velocity = current_from_message(message, self.simulation.time, self._world_frame)
        return stamp, {ALL: tuple(velocity.tolist())}

    def give(self, values: Values) -> None:
        self.simulation.add_current(self.simulation.time, np.array(values[ALL]))

    def values(self) -> dict[str, Any]:
        return {}

    def look(self) -> None:
        """Log when samples are adopted, have stopped, or are back."""
        stream, time, reported = self.simulation.currents, self.simulation.time, self._report.lasts("current held")
        if stream.course is None:
            self._taken = False
            self._report.end("current held")
        elif not self._taken:
            self._taken = True
            self._report.note("current adopted", f"a current is adopted at t = {time:g} s")
        silent = stream.is_silent(time)
        if silent and not reported:
            x, y, z = stream.velocity
            held = f"({x:.3g}, {y:.3g}, {z:.3g}) m/s is held"
            self._report.begin("current held", f"no current since t = {stream.last:g} s: {held}")
        elif reported and not silent:
            self._report.end("current held", f"current is back at t = {time:g} s")
