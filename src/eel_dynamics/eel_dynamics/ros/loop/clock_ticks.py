# SPDX-License-Identifier: Apache-2.0
"""When /clock is published: with each sample or at a rate of its own, and again and again while the run stands."""

import math
import time

from eel_dynamics.ros.declaration import Declaration
from eel_dynamics.ros.publishers import Publishers

TICK = 0.05  # s of wall time between two messages while the simulation stands


class ClockTicks:
    """Publishes /clock through `publishers`: messages k = 0, 1, ... at the simulation times k/clock_rate.

    With a clock_rate of 0 there is one with each sample. The time that it shows goes back at a reset alone.
    """

    def __init__(self, parameters: Declaration, publishers: Publishers) -> None:
        self._parameters, self._publishers = parameters, publishers
        self._sent = -math.inf  # s, steady clock: the last message
        self.restart()

    def restart(self) -> None:
        """Begin again at simulation time 0."""
        self._count = self._shown = 0  # messages at k/rate so far; simulation time [ns] of the last message

    @property
    def next(self) -> float:
        """Simulation time [s] of the next message between two samples; infinite if there are none."""
        rate = self._parameters.values.clock_rate
        return self._count / rate if rate > 0.0 else math.inf

    def reach(self, stamp: int) -> None:
        """Publish what is due with the sample at simulation time `stamp` [ns]."""
        if self.next == math.inf:
            self._send(stamp)
        self._catch_up(stamp)

    def go_on(self, present: int, stamp: int, now: float) -> None:
        """Publish what is due at simulation time `present` [ns], before the next sample; otherwise as `repeat`."""
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
        self._publishers.tick(nanoseconds)
        self._shown, self._sent = nanoseconds, time.monotonic()
