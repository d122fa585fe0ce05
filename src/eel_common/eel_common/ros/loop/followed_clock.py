# SPDX-License-Identifier: Apache-2.0
"""The pace of a run that follows the /clock of another node: each sample is due once /clock has come to its time.

A run that begins late, or that is slower than the other node, is behind /clock, and goes as fast as it can until it has
caught up. If /clock goes back, the run stands until /clock has come to its time again, or until it is reset too.
"""

import math
import time

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

from eel_common.ros.headers import seconds_of
from eel_common.ros.loop.pacing import Pace
from eel_common.ros.loop.requests import RequestQueue
from eel_common.ros.serving import ServedNode

LITTLE = 1.0  # s of simulated time, by which a run may be behind
STILL = 1.0  # s of wall time in which /clock does not move, after which this is said


class FollowedClock(Pace):
    """The pace of a followed /clock, with the methods of `Pace`.

    factor: 0: the run also waits for controllers and subscribers. The value is of no further use.
    """

    def __init__(self, period: float, factor: float) -> None:
        super().__init__(period, factor)
        self._shown = -math.inf  # s: the newest time on /clock
        self._went_back_to: float | None = None  # s: an earlier one
        self._moved = -math.inf  # s, steady clock: when /clock moved last

    def show(self, shown: float, now: float) -> None:
        """Take the time `shown` [s] on /clock, received at `now` [s, steady clock]."""
        if shown < self._shown:
            self._went_back_to = shown
        if shown != self._shown:
            self._shown, self._moved = shown, now

    def restart(self, sample: int, now: float, factor: float | None = None) -> None:
        """Begin with `sample`."""
        super().restart(sample, now, factor)
        if sample == 0:
            self._went_back_to = None

    def due(self, sample: int) -> float:
        """-inf where `sample` is due, inf where /clock has not come to its time."""
        if self.lost(sample) < 0.0:
            return math.inf
        self._went_back_to = None
        return -math.inf

    def lost(self, sample: int) -> float:
        """Time [s] by which `sample` is behind /clock; below 0 where it lies ahead."""
        return self._shown - sample * self.period + 1e-9

    def is_late(self, sample: int) -> bool:
        """Whether `sample` is more than a little behind /clock, which goes by steps."""
        return self.lost(sample) > LITTLE

    def give_up_delay(self, sample: int, now: float) -> float:
        """The time [s] by which `sample` is behind /clock, or 0 if that is little."""
        return self.lost(sample) if self.is_late(sample) else 0.0

    def held_by(self, sample: int) -> str:
        """Why `sample` is not due, as text, where that is not only a matter of moments."""
        if self.due(sample) < 0.0:
            return ""
        if self._went_back_to is not None:
            return (
                f"waiting for /clock, which went back to t = {self._went_back_to:g} s: reset starts this run again too"
            )
        if self._shown == -math.inf:
            return "waiting for /clock"
        still = time.monotonic() - self._moved > STILL
        return f"waiting for /clock, which stands at t = {self._shown:g} s" if still else ""


class ClockSubscription:
    """Passes the newest time on /clock to the `pace` of a run, by its `requests`.

    It is reliable, because the last message of a run that ends comes once, unless a publisher is best-effort.
    """

    def __init__(self, node: ServedNode, pace: FollowedClock, requests: RequestQueue) -> None:
        self._node, self._pace, self._requests = node, pace, requests
        self._reliability = ReliabilityPolicy.RELIABLE
        self._subscribe()

    def look(self) -> None:
        """Look the publishers up, and subscribe as they offer; call this a few times a second."""
        offers = [each.qos_profile.reliability for each in self._node.get_publishers_info_by_topic("/clock")]
        unreliable = ReliabilityPolicy.BEST_EFFORT in offers
        wanted = ReliabilityPolicy.BEST_EFFORT if unreliable else ReliabilityPolicy.RELIABLE
        if offers and wanted != self._reliability:
            self._node.destroy_subscription(self._subscription)
            self._reliability = wanted
            self._subscribe()

    def receive_clock(self, message: Clock) -> None:
        """Pass on the time in a `message`."""
        self._requests.put(self._pace.show, seconds_of(message.clock, "clock"), time.monotonic(), newest=True)

    def _subscribe(self) -> None:
        quality = QoSProfile(depth=1, reliability=self._reliability)
        quiet = SubscriptionEventCallbacks(use_default_callbacks=False)  # `look` finds what does not match
        make = self._node.create_subscription
        self._subscription = make(Clock, "/clock", self.receive_clock, quality, event_callbacks=quiet)
