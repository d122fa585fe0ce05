# SPDX-License-Identifier: Apache-2.0
"""Reports a late run: in the log when it begins and when it is over, and in /diagnostics while it lasts."""

import math

from eel_common.ros.loop.diagnostics import Report
from eel_common.ros.loop.pacing import Pace

LATE = "late"  # kind of the condition
QUIET = 3.0  # s of wall time without lateness, until it counts as over: a busy machine is late repeatedly


class Lateness:
    """Watches the pace of a run."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._since, self._last = 0.0, -math.inf  # s, steady clock: first and last time the run was late
        self._most = 0.0  # s

    def check(self, pace: Pace, sample: int, time: float, now: float) -> None:
        """Look at the `pace` after `sample`, of simulation time `time` [s], at `now` [s, steady clock]."""
        if pace.give_up_delay(sample, now) > 0.0:
            if not self._report.lasts(LATE):
                self._since, self._most = now, 0.0
            lost, given_up = pace.lost(sample), pace.given_up
            self._most = max(self._most, lost)
            more = f"; {given_up:.3g} s more are given up" if given_up > 0.0 else ""
            text = f"late by {lost:.3g} s at t = {time:g} s: accuracy is kept, not the pace{more}"
            self._report.begin(LATE, text)
        if pace.is_late(sample):
            self._last = now
        elif now - self._last > QUIET:
            self.end(time)

    def end(self, time: float) -> None:
        """End the report of a late run, at simulation time `time` [s]."""
        lasted = f"it was for {self._last - self._since:.3g} s, by {self._most:.3g} s at most"
        self._report.end(LATE, f"no longer late at t = {time:g} s: {lasted}")
