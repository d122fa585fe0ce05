# SPDX-License-Identifier: Apache-2.0
"""When /clock is published: with each sample or at a rate of its own, and again and again while the run stands."""

import math
import time

TICK = 0.05  # s of wall time between two messages while the simulation stands


class ClockTicks:
    """Publishes /clock through `publishers`: messages k = 0, 1, ... at the simulation times k/rate.

    The time that it shows goes back at a reset alone.

    Attributes:
        rate: [Hz], messages per simulated second; 0: one with each sample. May be replaced at a reset.
    """

    def __init__(self, rate: float, publishers):
        self.rate, self._publishers = rate, publishers
        self._count = self._shown = 0  # messages at k/rate so far; simulation time [ns] of the last message
        self._sent = -math.inf  # s, steady clock: the last message

    def restart(self):
        """Begin again at simulation time 0."""
        self._count = self._shown = 0

    @property
    def next(self) -> float:
        """Simulation time [s] of the next message between two samples; infinite if there are none."""
        return self._count / self.rate if self.rate > 0.0 else math.inf

    def reach(self, stamp: int):
        """Publish what is due with the sample at simulation time `stamp` [ns]."""
        if self.rate > 0.0:
            self._catch_up(stamp)
        else:
            self._send(stamp)

    def go_on(self, present: int, stamp: int, now: float):
        """Publish what is due at simulation time `present` [ns], before the next sample; otherwise as `repeat`."""
        if self.rate > 0.0:
            self._catch_up(present)
        else:
            self.repeat(stamp, now)

    def repeat(self, stamp: int, now: float):
        """Publish the time `stamp` [ns] of the last sample at `now` [s, steady clock], unless one came just before.

        If /clock has gone on since that sample, it shows the later time.
        """
        if now - self._sent >= TICK:
            self._send(max(stamp, self._shown))

    def _catch_up(self, nanoseconds: int):
        while (due := round(self._count * 1e9 / self.rate)) <= nanoseconds:
            self._count += 1
            self._send(due)

    def _send(self, nanoseconds: int):
        self._publishers.tick(nanoseconds)
        self._shown, self._sent = nanoseconds, time.monotonic()
