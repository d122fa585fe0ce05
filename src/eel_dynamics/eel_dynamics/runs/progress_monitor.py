# SPDX-License-Identifier: Apache-2.0
"""How far a run has come, told once a second."""

import math
import time
import warnings
from collections.abc import Callable

from eel_common.command.progress import Forecast

REPORT_PERIOD = 1.0  # s of wall time between two reports, and before the first
LONG = 60.0  # s of wall time: a longer run causes a warning


class ProgressMonitor:
    """Reports once a second how far a run of `duration` [s] has come, and the remaining wall time (`Forecast`).

    progress: as in `simulate`; without it, a run longer than `LONG` causes one warning, with this `stacklevel`.
    """

    def __init__(self, duration: float, progress: Callable[[float, float], None] | None, stacklevel: int):
        self._duration, self._progress, self._stacklevel = duration, progress, stacklevel
        self._began: float | None = None  # s, of the wall clock
        self._forecast, self._last_report, self._warned = Forecast(), -math.inf, False

    def update(self, reached: float) -> None:
        """Report that the run has reached simulation time `reached` [s]."""
        now = time.monotonic()
        if self._began is None:
            self._began = self._last_report = now
        self._forecast.add(now, reached)
        if now - self._last_report < REPORT_PERIOD:
            return
        self._last_report, took, left = now, now - self._began, self._forecast.left(self._duration)
        if self._progress is not None:
            self._progress(reached, math.nan if left is None else left)
        elif left is not None and took + left > LONG and not self._warned:
            self._warned, minutes = True, (took + left) / 60.0
            warnings.warn(
                f"this swim of {self._duration:g} s is going to take about {minutes:.2g} minutes: it has come to "
                f"{reached:.3g} s in {took:.0f} s; a coarser accuracy, a slower law or a shorter duration takes less",
                stacklevel=self._stacklevel,
            )
