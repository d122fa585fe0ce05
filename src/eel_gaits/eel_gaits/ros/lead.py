# SPDX-License-Identifier: Apache-2.0
"""The instants at which a controller in the loop gives the curvature: some time ahead of the sample that it answers."""

import math

MOST_SKIPPED = 1000  # instants that a gap between two samples may hold; after a longer one the controller begins anew


class Lead:
    """Instants `period` [s] apart, up to `lead` [s] after each sample, or one period if that is more.

    The times are simulation time [s]. A run begins with a stamp that goes back, or after a long gap.
    """

    def __init__(self, period: float, lead: float) -> None:
        self._period, self._lead = period, max(lead, period)
        self._last, self._first, self._count = math.inf, 0.0, 0

    def begins(self, now: float) -> bool:
        """Whether the sample of `now`, another time than the last one, begins a run."""
        return not now > self._last or now > self._instant(self._count + MOST_SKIPPED)

    def begin(self, now: float) -> float:
        """The first instant of the run that begins with the sample of `now`: 0 before the simulation has begun. In one
        that is under way it lies `lead` ahead."""
        self._first, self._count = (now if now == 0.0 else now + self._lead), 0
        return self._first

    def after(self, now: float) -> list[float]:
        """The instants that the sample of `now` asks for. Those that are not later than `now` come too late."""
        self._last, found = now, []
        while self._instant(self._count + 1) <= now + self._lead + 1e-9:
            self._count += 1
            found.append(self._instant(self._count))
        return found

    def _instant(self, count: int) -> float:
        return self._first + count * self._period
