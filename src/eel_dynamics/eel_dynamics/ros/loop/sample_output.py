# SPDX-License-Identifier: Apache-2.0
"""Publishes the samples of a run, and checks each: its totals, the model's limits, and the estimate of its error.

While a run stands at its start, sample 0 is repeated. It is not published once more if all subscribers have had it.
"""

import math

from eel_dynamics.accuracy.error_estimate import HeadErrors
from eel_dynamics.ros.loop.clock_ticks import ClockTicks
from eel_dynamics.ros.loop.error_monitor import ErrorMonitor
from eel_dynamics.ros.loop.limits_monitor import LimitsMonitor
from eel_dynamics.ros.loop.run_totals import RunTotals

START_PERIOD = 0.1  # s of wall time between two messages of sample 0 while the run stands at its start


class SampleOutput:
    """Publishes the samples of a `simulation`, `rate` [Hz] of them per simulated second, through `publishers`.

    Attributes:
        rate: may be replaced at a reset.
        torque_limit: [N m], above which the greatest torque is reported; 0: none.
        clock: ClockTicks.
        totals: RunTotals since the start.
    """

    def __init__(self, simulation, rate: float, clock_rate: float, publishers, report):
        self._simulation, self.rate, self._publishers, self._report = simulation, rate, publishers, report
        self._limits, self._errors = LimitsMonitor(simulation, report), ErrorMonitor(simulation, report)
        self.clock = ClockTicks(clock_rate, publishers)
        self.torque_limit = 0.0
        self._whole_snapshot_due = True
        self._start_shown, self._start_audience = -math.inf, None  # s, steady clock: last sample 0, and who had it
        self.totals = RunTotals()

    @property
    def errors(self) -> dict[str, float | str]:
        """Figures of the error estimate, by name; "off" where none is wanted."""
        return self._errors.values

    @property
    def head_errors(self) -> HeadErrors | None:
        """The errors of the head's motion; None where none are estimated."""
        return self._simulation.head_errors

    def request_whole_snapshot(self):
        """Let the next snapshot hold everything that the totals use, even without subscribers."""
        self._whole_snapshot_due = True

    def publish(self, sample: int, last: bool):
        """Publish `sample` of the simulation's present time; `last`: of the run. `SimulationStopped` for a bad one."""
        whole, self._whole_snapshot_due = self._whole_snapshot_due or last, False
        self._publish(sample, whole)

    def _publish(self, sample: int, whole: bool):
        """With `whole`, check everything that the totals use."""
        parts = self._publishers.wanted_parts()
        parts["wrench"] |= self.torque_limit > 0.0
        snapshot = self._simulation.observe(**{part: wanted or whole for part, wanted in parts.items()})
        self.totals.add(snapshot)
        self._limits.add(snapshot, check=whole)
        self._limits.check_torque(snapshot, self.torque_limit)
        if whole:
            self._errors.check()
        stamp = nanoseconds(sample, self.rate)
        self.clock.reach(stamp)
        self._publishers.publish(snapshot, stamp)

    def end(self):
        """Report what is left to report at the end of the run."""
        self._limits.report_torque()

    # -- sample 0

    def start_is_due(self, now: float) -> bool:
        """Whether sample 0 may be repeated at `now` [s, steady clock]."""
        return now - self._start_shown >= START_PERIOD

    def show_start(self, now: float):
        """Publish sample 0, at `now` [s, steady clock]."""
        self._publish(0, whole=True)
        self._start_shown, self._start_audience = now, self._publishers.audience()

    @property
    def start_is_known(self) -> bool:
        """Whether all subscribers have had sample 0 as it is."""
        return self._start_audience is not None and self._start_audience == self._publishers.audience()

    def forget_start(self):
        """Sample 0 may be another one than what was published."""
        self._start_audience = None

    # -- another state

    def change_state(self):
        """Begin to check anew: the head is elsewhere."""
        self.forget_start()
        self._limits.restart()

    def restart(self, simulation):
        """Begin again with the start of a `simulation`, which may be another one."""
        if simulation is not self._simulation:
            self._limits.end()
            self._simulation, report = simulation, self._report
            self._limits, self._errors = LimitsMonitor(simulation, report), ErrorMonitor(simulation, report)
        self.totals = RunTotals()
        self.clock.restart()
        self.change_state()
        self._errors.restart()


def nanoseconds(sample: int, rate: float) -> int:
    """Simulation time [ns] of a sample at `rate` [Hz]."""
    return round(sample * 1e9 / rate)
