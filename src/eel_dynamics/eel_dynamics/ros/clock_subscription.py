# SPDX-License-Identifier: Apache-2.0
"""Subscribes to the /clock of another node, for a run that follows it."""

from collections.abc import Callable

from eel_ros.stamps import seconds_of
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock


class ClockSubscription:
    """Passes the newest time [s] on /clock to `receive`.

    It is reliable, because the last message of a run that ends comes once, unless a publisher is best-effort.
    """

    def __init__(self, node, receive: Callable[[float], None]):
        self._node, self._receive = node, receive
        self._reliability = ReliabilityPolicy.RELIABLE
        self._subscription = self._subscribed()

    def look(self):
        """Look the publishers up, and subscribe as they offer; call this a few times a second."""
        offers = [each.qos_profile.reliability for each in self._node.get_publishers_info_by_topic("/clock")]
        unreliable = ReliabilityPolicy.BEST_EFFORT in offers
        wanted = ReliabilityPolicy.BEST_EFFORT if unreliable else ReliabilityPolicy.RELIABLE
        if offers and wanted != self._reliability:
            self._node.destroy_subscription(self._subscription)
            self._reliability = wanted
            self._subscription = self._subscribed()

    def _subscribed(self):
        def take(message):
            self._receive(seconds_of(message.clock, "clock"))

        quality = QoSProfile(depth=1, reliability=self._reliability)
        quiet = SubscriptionEventCallbacks(use_default_callbacks=False)  # `look` finds what does not match
        return self._node.create_subscription(Clock, "/clock", take, quality, event_callbacks=quiet)
