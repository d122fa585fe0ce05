# SPDX-License-Identifier: Apache-2.0
"""A topic that loses no message while its subscribers keep up, and the time spent waiting for them."""

from collections.abc import Callable
from typing import Any

from rclpy.qos import QoSProfile

from eel_common.ros.qos import keep_all, matches
from eel_common.ros.serving import ServedNode

LIVE_DEPTH = 100  # samples: history of a paced run
LONG_DEPTH = 5000  # samples: history after a subscriber got stuck, enough for those that keep up
APART = 1.0  # s: waits further apart count separately


class Channel:
    """One topic of `node` with its publisher. Only one thread may use it.

    Attributes:
        subscribers: counts them. It bypasses rclpy's guard against a concurrent close, which takes four times as long
            as the count.
    """

    def __init__(self, node: ServedNode, kind: type, topic: str, lossless: bool) -> None:
        self._node, self._kind, self.topic, self.lossless = node, kind, topic, lossless
        self._open(keep_all() if lossless else LIVE_DEPTH)

    def _open(self, quality: QoSProfile | int) -> None:
        self.publisher: Any = self._node.create_publisher(self._kind, self.topic, quality)
        self.subscribers: Callable[[], int] = self.publisher.handle.get_subscription_count

    def close(self) -> None:
        """Destroy the publisher."""
        self._node.destroy_publisher(self.publisher)

    def drop_oldest(self) -> None:
        """Change to a KEEP_LAST history, long enough for subscribers that are not stuck."""
        self.close()
        self.lossless = False
        self._open(LONG_DEPTH)

    def count_known(self) -> int:
        """The number of matching subscribers on the network."""
        wanted = self._node.get_subscriptions_info_by_topic(self.publisher.topic_name)
        return sum(matches(each.qos_profile, self.publisher.qos_profile) for each in wanted)


class WaitBudget:
    """The time spent waiting for subscribers: one budget for all topics, as a stuck subscriber blocks all of them."""

    def __init__(self) -> None:
        self._since: float | None = None  # s, steady clock
        self._last = 0.0

    def begin(self, now: float) -> None:
        """Note a failed publish. Waits that ended more than `APART` ago no longer count."""
        if self._since is None or now - self._last > APART:
            self._since = now
        self._last = now

    def over(self, now: float, timeout: float) -> bool:
        """Whether the waiting has reached `timeout` [s]."""
        self._last = now
        return self._since is not None and now - self._since >= timeout

    def renew(self) -> None:
        """Reset it: a subscriber has caught up."""
        self._since = None
