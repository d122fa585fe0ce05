# SPDX-License-Identifier: Apache-2.0
"""When /clock is published: with each sample or at its own rate, and repeatedly while the run stands."""

import math
import time
from typing import Protocol

TICK = 0.05  # s of wall time between two messages while the simulation stands


class ClockPublisher(Protocol):
    """The publisher of /clock."""

    def tick(self, nanoseconds: int) -> None:
        """Publish it, with simulation time `nanoseconds` [ns]."""


class ClockTicks:
    """Publishes /clock through a `publisher`: messages k = 0, 1, ... at the simulation times k/rate.

    With a `rate` [Hz] of 0 there is one with each sample. Its time goes backwards only at a reset.
    """

    def __init__(self, rate: float, publisher: ClockPublisher) -> None:
        self._publisher = publisher
        self._sent = -math.inf  # s, steady clock: the last message
        self.restart(rate)

    def restart(self, rate: float) -> None:
        """Begin again at simulation time 0, with a `rate` [Hz]."""
        self._rate = rate
        self._count = self._shown = 0  # messages at k/rate so far; simulation time [ns] of the last message

    @property
    def next(self) -> float:
        """Simulation time [s] of the next message between two samples; infinite if there are none."""
        return self._count / self._rate if self._rate > 0.0 else math.inf

    def reach(self, stamp: int) -> None:
        """Publish the messages up to the sample at simulation time `stamp` [ns]."""
        if self.next == math.inf:
            self._send(stamp)
        self._catch_up(stamp)

    def go_on(self, present: int, stamp: int, now: float) -> None:
        """Publish the messages up to simulation time `present` [ns], between two samples; without any, as `repeat`."""
        if self.next == math.inf:
            self.repeat(stamp, now)
        self._catch_up(present)

    def repeat(self, stamp: int, now: float) -> None:
        """Publish the time `stamp` [ns] of the last sample at `now` [s, steady clock], unless one came just before.

        If /clock has gone on since that sample, it shows the later time.
        """
        if now - self._sent >= TICK:
            self._send(max(stamp, self._shown))

    def _catch_up(self, nanoseconds: int) -> None:
        while 1e9 * self.next < nanoseconds + 0.5:
            due, self._count = round(1e9 * self.next), self._count + 1
            self._send(due)

    def _send(self, nanoseconds: int) -> None:
        self._publisher.tick(nanoseconds)
        self._shown, self._sent = nanoseconds, time.monotonic()
