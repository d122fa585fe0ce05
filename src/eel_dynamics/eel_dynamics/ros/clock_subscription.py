# SPDX-License-Identifier: Apache-2.0
"""Subscribes to the /clock of another node, for a run that follows it."""

import time

from eel_ros.serving import ServedNode
from eel_ros.stamps import seconds_of
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

from eel_dynamics.ros.loop.run_loop import RunLoop


class ClockSubscription:
    """Passes the newest time on /clock to the `run`.

    It is reliable, because the last message of a run that ends comes once, unless a publisher is best-effort.
    """

    def __init__(self, node: ServedNode, run: RunLoop) -> None:
        self._node, self._run, self._reliability = node, run, ReliabilityPolicy.RELIABLE
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
        shown, requests = seconds_of(message.clock, "clock"), self._run.requests
        requests.put(self._run.show_clock, shown, time.monotonic(), newest=True)

    def _subscribe(self) -> None:
        quality = QoSProfile(depth=1, reliability=self._reliability)
        quiet = SubscriptionEventCallbacks(use_default_callbacks=False)  # `look` finds what does not match
        make = self._node.create_subscription
        self._subscription = make(Clock, "/clock", self.receive_clock, quality, event_callbacks=quiet)
