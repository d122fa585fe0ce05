# SPDX-License-Identifier: Apache-2.0
"""The instants for which a controller in the loop gives the curvature: some time ahead of the sample it answers."""

import math

MOST_SKIPPED = 1000  # instants in a gap between two samples; after a longer gap the controller restarts


class Lead:
    """Instants `period` [s] apart, up to `lead` [s] after each sample, or one period if that is more.

    Times are simulation time [s]. A run begins when the stamp goes back, or after a long gap.
    """

    def __init__(self, period: float, lead: float) -> None:
        self._period, self._lead = period, max(lead, period)
        self._last, self._first, self._count = math.inf, 0.0, 0

    def begins(self, now: float) -> bool:
        """Whether the sample at `now`, which is not the last one again, begins a run."""
        return not now > self._last or now > self._instant(self._count + MOST_SKIPPED)

    def begin(self, now: float) -> float:
        """The first instant of the run that begins with the sample at `now`: 0 before the simulation has begun; `lead`
        ahead in a simulation that is under way."""
        self._first, self._count = (now if now == 0.0 else now + self._lead), 0
        return self._first

    def after(self, now: float) -> list[float]:
        """The instants to answer for the sample at `now`. Instants up to `now` are left out: they are too late."""
        self._last, found = now, []
        while self._instant(self._count + 1) <= now + self._lead + 1e-9:
            self._count += 1
            found.append(self._instant(self._count))
        return found

    def _instant(self, count: int) -> float:
        return self._first + count * self._period
