# SPDX-License-Identifier: Apache-2.0
"""The pace of a run that follows another node's /clock: each sample is due when /clock reaches its time.

A run that starts late or is slower than /clock runs as fast as it can until it has caught up. If /clock goes back, the
run stands until /clock has reached its time again, or until it is reset too.
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

LITTLE = 1.0  # s of simulated time: a smaller lag is not late
STILL = 1.0  # s of wall time: a longer halt of /clock is reported


class FollowedClock(Pace):
    """The pace of a followed /clock, with the methods of `Pace`.

    factor: 0: the run also waits for controllers and subscribers. Other values have no effect.
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
        """-inf if `sample` is due, inf while /clock has not reached its time."""
        if self.lost(sample) < 0.0:
            return math.inf
        self._went_back_to = None
        return -math.inf

    def lost(self, sample: int) -> float:
        """Time [s] by which `sample` is behind /clock; negative if it is ahead."""
        return self._shown - sample * self.period + 1e-9

    def is_late(self, sample: int) -> bool:
        """Whether `sample` is more than a little behind /clock, which goes by steps."""
        return self.lost(sample) > LITTLE

    def give_up_delay(self, sample: int, now: float) -> float:
        """The time [s] by which `sample` is behind /clock; 0 for a small lag."""
        return self.lost(sample) if self.is_late(sample) else 0.0

    def held_by(self, sample: int) -> str:
        """The reason, as text, why `sample` is not due, unless it will be in a moment."""
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
    """Passes the newest time on /clock to the `pace` of a run, through its `requests`.

    It is reliable unless a publisher is best-effort: the last message of a run that ends is sent once.
    """

    def __init__(self, node: ServedNode, pace: FollowedClock, requests: RequestQueue) -> None:
        self._node, self._pace, self._requests = node, pace, requests
        self._reliability = ReliabilityPolicy.RELIABLE
        self._subscribe()

    def look(self) -> None:
        """Look up the publishers, and subscribe with a matching profile; call this a few times a second."""
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
        quiet = SubscriptionEventCallbacks(use_default_callbacks=False)  # `look` finds mismatches
        make = self._node.create_subscription
        self._subscription = make(Clock, "/clock", self.receive_clock, quality, event_callbacks=quiet)
