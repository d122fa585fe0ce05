# SPDX-License-Identifier: Apache-2.0
"""Reports an error of a run above its target: once in the log, and in /diagnostics until a reset."""

from eel_common.ros.loop.diagnostics import Report

from eel_dynamics.simulation.simulation import Simulation

OFF = "off"  # if no error is estimated
TARGET, LOST = "accuracy target", "lost accuracy"  # kinds of conditions


class ErrorMonitor:
    """Watches the error estimate of a `simulation` from its start on, if it has one.

    Attributes:
        values: figures for /diagnostics by name, as of the last check; "off" if no error is estimated.
    """

    def __init__(self, simulation: Simulation, report: Report) -> None:
        self._simulation, self._report = simulation, report
        self.values: dict[str, float | str] = {"error_position": OFF} if simulation.error_estimate is None else {}
        report.end(TARGET)
        report.end(LOST)

    def check(self) -> None:
        """Report a missed target, and a motion whose errors have grown without bound."""
        simulation, error = self._simulation, self._simulation.error_estimate
        if error is None:
            return
        missed = error.over_target(simulation.accuracy.target, simulation.time - (simulation.measured_since or 0.0))
        if missed and not self._report.lasts(TARGET):
            self._report.begin(TARGET, f"at t = {simulation.time:g} s {missed}")
        if simulation.lost_at is not None and not self._report.lasts(LOST):
            speed = f" (by a factor of e in {1.0 / error.growth_rate:.2g} s)" if error.growth_rate else ""
            self._report.begin(
                LOST,
                f"at t = {simulation.lost_at:g} s the errors have grown so far{speed} that the position is no longer "
                "known. From then on they are measured anew",
            )
        named = {
            "error_position": error.position,
            "error_torque": error.torque,
            "error_growth_rate": error.growth_rate,
            "error_since": simulation.measured_since,
        }
        self.values = {name: value for name, value in named.items() if value is not None}
