# SPDX-License-Identifier: Apache-2.0
"""Publishes the samples of a run, and checks each: its totals, the model's limits, and the estimate of its error.

While a run waits at its start, sample 0 is repeated. When the run starts, sample 0 is not published again if all
subscribers have received it.
"""

import math

from eel_common.ros.loop.clock_ticks import ClockTicks
from eel_common.ros.loop.diagnostics import Report

from eel_dynamics.ros.declaration import Declaration
from eel_dynamics.ros.loop.error_monitor import ErrorMonitor
from eel_dynamics.ros.loop.limits_monitor import LimitsMonitor
from eel_dynamics.ros.loop.run_totals import RunTotals, check_finite
from eel_dynamics.ros.loop.saturation_monitor import SaturationMonitor
from eel_dynamics.ros.publishers import Publishers
from eel_dynamics.simulation.simulation import Simulation

START_PERIOD = 0.1  # s of wall time between two messages of sample 0


class SampleOutput:
    """Publishes the samples of a `simulation` through `publishers`.

    Attributes:
        clock: ClockTicks.
        totals: RunTotals since the start.
        errors: ErrorMonitor.
        saturation: SaturationMonitor of a robot; None without.
    """

    def __init__(self, simulation: Simulation, parameters: Declaration, publishers: Publishers, report: Report) -> None:
        self._simulation, self._parameters = simulation, parameters
        self._publishers, self._report = publishers, report
        self.clock, self.totals = ClockTicks(parameters.values.clock_rate, publishers), RunTotals()
        self.errors, self._limits = ErrorMonitor(simulation, report), LimitsMonitor(simulation, report)
        self.saturation = self._watch()
        self._whole_snapshot_due = True
        self._start_shown = -math.inf  # s, steady clock: when sample 0 was last published
        self._start_audience: dict[str, int] | None = None  # its subscribers

    def _watch(self) -> SaturationMonitor | None:
        return None if self._simulation.robot is None else SaturationMonitor(self._simulation, self._report)

    def request_whole_snapshot(self) -> None:
        """Let the next snapshot hold all inputs of the totals, even without subscribers."""
        self._whole_snapshot_due = True

    def publish(self, sample: int, last: bool) -> None:
        """Publish the `sample` of the present time. last: whether it ends the run. `SimulationStopped` if it is not
        finite."""
        whole, self._whole_snapshot_due = self._whole_snapshot_due or last, False
        self._publish(sample, whole)

    def _publish(self, sample: int, whole: bool) -> None:
        """With `whole`, check all inputs of the totals."""
        parts, limit = self._publishers.wanted_parts(), self._parameters.values.torque_limit
        snapshot = self._simulation.observe(
            wrench=whole or parts["wrench"] or limit > 0.0,
            load=whole or parts["load"],
        )
        check_finite(snapshot)
        stamp = nanoseconds(sample, self._parameters.values.rate)
        self.clock.reach(stamp)
        self._publishers.publish(snapshot, stamp)  # first: a controller waits for it
        self.totals.add(snapshot)
        if self.saturation is not None:
            self.saturation.add(snapshot)
        self._limits.add(snapshot, check=whole)
        self._limits.check_torque(snapshot, limit)
        if whole:
            self.errors.check()

    def end(self) -> None:
        """Make the last reports of the run."""
        self._limits.report_torque()

    # -- sample 0

    def start_is_due(self, now: float) -> bool:
        """Whether sample 0 may be repeated at `now` [s, steady clock]."""
        return now - self._start_shown >= START_PERIOD

    def show_start(self, now: float) -> None:
        """Publish sample 0, at `now` [s, steady clock]."""
        self._publish(0, whole=True)
        self._start_shown, self._start_audience = now, self._publishers.audience()

    @property
    def start_is_known(self) -> bool:
        """Whether all subscribers have received the present sample 0."""
        return self._start_audience is not None and self._start_audience == self._publishers.audience()

    def forget_start(self) -> None:
        """Sample 0 may differ from the published one."""
        self._start_audience = None

    # -- another state

    def change_state(self) -> None:
        """Restart the checks of the limits, because the head has been moved."""
        self.forget_start()
        self._limits.end()
        self._limits = LimitsMonitor(self._simulation, self._report)

    def restart(self, simulation: Simulation) -> None:
        """Restart at time 0 of a `simulation`, perhaps a new one."""
        self._simulation = simulation
        self.totals, self.errors = RunTotals(), ErrorMonitor(simulation, self._report)
        if self.saturation is not None:
            self.saturation.end()
        self.saturation = self._watch()
        self.clock.restart(self._parameters.values.clock_rate)
        self.change_state()


def nanoseconds(sample: int, rate: float) -> int:
    """Simulation time [ns] of a sample at `rate` [Hz]."""
    return round(sample * 1e9 / rate)
