"""When each sample is due on the steady clock.

Sample k is due at start + (k - first) * period / factor. A run that falls behind by more than a few periods gives the
lost time up rather than hurry after it: it keeps its accuracy, not its pace.
"""

import math
import threading

FEW_PERIODS = 5
SHORTEST_DELAY = 0.02  # s: below this the operating system's scheduling is heard, not the run


class Pace:
    """Due times of samples `period` [simulated s] apart at `factor` simulated seconds per second; 0: due at once."""

    def __init__(self, period: float, factor: float):
        self.period = period
        self.factor = factor
        self.lost = 0.0  # s of wall time given up so far
        self._first, self._start = 0, -math.inf

    def restart(self, sample: int, now: float, factor: float | None = None):
        """`sample` is due `now` [s, steady clock], and the ones after it from there on."""
        if factor is not None:
            self.factor = factor
        self._first, self._start = sample, now

    def due(self, sample: int) -> float:
        """Time [s, steady clock] at which `sample` is due."""
        if self.factor == 0.0:
            return -math.inf
        return self._start + (sample - self._first) * self.period / self.factor

    def settle(self, sample: int, now: float) -> float:
        """Delay [s] of `sample` where it is late by more than a few periods, else 0; the delay is given up."""
        if self.factor == 0.0:
            return 0.0
        delay = now - self.due(sample)
        if delay <= max(FEW_PERIODS * self.period / self.factor, SHORTEST_DELAY):
            return 0.0
        self.lost += delay
        self.restart(sample, now)
        return delay


class Bell:
    """Wakes one thread that waits; a lock and nothing else, as a node that wakes 100 times a second pays for every
    line of Python."""

    def __init__(self):
        self._silent = threading.Lock()
        self._silent.acquire()

    def ring(self):
        """Wakes who waits, or who waits next. Rings must not meet: the caller sees to that."""
        if self._silent.locked():
            self._silent.release()

    def hush(self):
        """Forgets that it rang."""
        self._silent.acquire(blocking=False)

    def wait(self, seconds: float) -> bool:
        """Sleeps until it rings, or for so long: whether it rang."""
        return self._silent.acquire(timeout=max(0.0, seconds))
