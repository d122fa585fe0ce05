# SPDX-License-Identifier: Apache-2.0
"""Reports the progress of a run and its remaining wall time, once a second."""

import time
import warnings
from collections.abc import Callable

REPORT_PERIOD = 1.0  # s of wall time between two reports, and before the first
LONG = 60.0  # s of wall time: a longer run gives a warning


class ProgressMonitor:
    """Estimates the remaining wall time of a run of `duration` [s].

    progress(time, left): called with the simulation time reached [s] and the remaining wall time [s]; without it, a run
    longer than `LONG` gives one warning.
    """

    def __init__(self, duration: float, progress: Callable[[float, float], None] | None):
        self._duration, self._progress = duration, progress
        self._began = self._last_report = time.monotonic()
        self._warned = False

    def update(self, reached: float):
        """Report that the run has reached simulation time `reached` [s]."""
        now = time.monotonic()
        if now - self._last_report < REPORT_PERIOD:
            return
        self._last_report = now
        took = now - self._began
        left = took * (self._duration - reached) / reached if reached > 0.0 else float("inf")
        if self._progress is not None:
            self._progress(reached, left)
        elif took + left > LONG and not self._warned:
            self._warned = True
            warnings.warn(
                f"this swim of {self._duration:g} s is going to take {_minutes(took + left)}: it has come to "
                f"{reached:.3g} s in {took:.0f} s; a coarser accuracy, a slower law or a shorter duration takes less",
                stacklevel=7,  # the caller of `simulate`, behind `swim_to_end`, `swim` and two `record`
            )


def _minutes(seconds: float) -> str:
    return "for ever" if seconds == float("inf") else f"about {seconds / 60.0:.2g} minutes"
