# SPDX-License-Identifier: Apache-2.0
"""Pacing on the steady clock: the due times of samples.

Sample k is due at start + (k - first) * period / factor. A run that is late by more than a period and `SHORTEST_DELAY`
does not hurry: it regains the lost time by running `CATCH_UP` faster, so that a controller can follow. At most
`MOST_REGAINED` is regained; the rest is given up. So a run that stood for hours is not faster for days. A late run
keeps its accuracy, not its pace.
"""

import math

SHORTEST_DELAY = 0.02  # s: shorter delays come from the operating system's scheduling
CATCH_UP = 0.1  # fraction of the pace by which a late run is faster
MOST_REGAINED = 10.0  # s: it is regained in 110 s


class Pace:
    """Due times of samples `period` [simulated s] apart at `factor` simulated seconds per second; 0: due at once.

    Attributes:
        given_up: lost time [s] that will not be regained.
    """

    def __init__(self, period: float, factor: float) -> None:
        self.period = period
        self.factor = factor
        self._first, self._start, self._lost = 0, -math.inf, 0.0  # _lost: s, by which the first one was late
        self.given_up = 0.0

    def restart(self, sample: int, now: float, factor: float | None = None) -> None:
        """Make `sample` due `now` [s, steady clock], and later samples relative to it. Lateness is forgotten."""
        if factor is not None:
            self.factor = factor
        self._first, self._start, self._lost = sample, now, 0.0
        self.given_up = 0.0

    def due(self, sample: int) -> float:
        """Time [s, steady clock] at which `sample` is due."""
        if self.factor == 0.0:
            return -math.inf
        return self._start + self._steps(sample) - (self._lost - self.lost(sample))

    def lost(self, sample: int) -> float:
        """Time [s] that the schedule has lost and not yet regained by `sample`."""
        return max(0.0, self._lost - self._steps(sample) * CATCH_UP / (1.0 + CATCH_UP))

    def is_late(self, sample: int) -> bool:
        """Whether the schedule has lost time that it has not regained by `sample`."""
        return self.lost(sample) > 0.0

    def give_up_delay(self, sample: int, now: float) -> float:
        """If `sample` is late at `now` [s, steady clock], delay it and later samples. Returns the delay [s], or 0."""
        if self.factor == 0.0:
            return 0.0
        delay = now - self.due(sample)
        if delay <= self.period / self.factor + SHORTEST_DELAY:
            return 0.0
        lost, given_up = self.lost(sample) + delay, self.given_up
        self.restart(sample, now)
        self._lost = min(lost, MOST_REGAINED)
        self.given_up = given_up + lost - self._lost
        return delay

    def held_by(self, sample: int) -> str:
        """The reason, as text, why `sample` must wait besides its due time. Always empty here."""
        return ""

    def _steps(self, sample: int) -> float:
        return (sample - self._first) * self.period / self.factor if self.factor > 0.0 else 0.0
