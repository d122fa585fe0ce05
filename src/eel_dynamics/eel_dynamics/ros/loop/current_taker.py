# SPDX-License-Identifier: Apache-2.0
"""Passes samples of the topic `current` to the simulation; logs refusals, and when samples stop and return."""

import numpy as np
from eel_ros.loop.diagnostics import ERROR, Report

from eel_dynamics.ros.loop.awaited import Awaited, Echo
from eel_dynamics.simulation.simulation import Simulation

NAMES = ("current",)


class CurrentTaker:
    """Passes samples to a simulation, which may be another one after a reset. For the run loop's thread.

    Attributes:
        awaited: Awaited.
    """

    def __init__(self, report: Report) -> None:
        self._report, self._taken = report, False
        self.awaited, self._echo = Awaited("current", "current", report), Echo()

    def take(self, simulation: Simulation, stamp: float, velocity: np.ndarray) -> None:
        """Add the `velocity` (3,) [m/s], world, of the time `stamp` [s], 0: the present one; log a refusal."""
        time = simulation.time
        if self._echo.holds(stamp - time):
            self._report.note("echo", f"current of {stamp:g} s left out: sent before the reset")
            return
        try:
            simulation.add_current(stamp or time, velocity)
        except ValueError as error:
            self._report.event("current", f"{error}: left out", ERROR)
        else:
            self._echo.take(stamp - time)
            self.awaited.come(NAMES, stamp, time)

    def reset(self) -> None:
        """The run begins again."""
        self.awaited.reset(NAMES)
        self._echo.reset()

    def look(self, simulation: Simulation) -> None:
        """Log when samples are adopted, have stopped, or are back."""
        stream, time, reported = simulation.currents, simulation.time, self._report.lasts("current held")
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
