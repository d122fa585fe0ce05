# SPDX-License-Identifier: Apache-2.0
"""Subscriptions that the node polls itself: many messages at once, instead of one executor call per message.

An executor collects and waits on all entities of a node before each message. With eight topics that costs more than
logging them. The callback group here is never executed, so messages stay in the KEEP_ALL histories until `take`.
"""

import time
from collections.abc import Callable, Hashable

from eel_ros.deliveries import Deliveries
from eel_ros.run_node import is_from_before
from eel_ros.serving import PolledGroup, log_dropped, read_message
from rclpy.node import Node
from rclpy.qos import QoSProfile

from eel_viz.ros.publisher_change import PublisherChange

BATCH = 64  # messages taken from one subscription before the next one
TURN = 0.2  # s after which `take` returns, so that the node hears calls and signals
PROCESS = 12  # bytes of an endpoint's identifier that all endpoints of a process share (RTPS: the GUID's prefix)


class PolledSubscriptions:
    """The subscriptions of `node`."""

    def __init__(self, node: Node) -> None:
        self._node, self._group = node, PolledGroup()
        self._subscriptions: list[tuple] = []

    def subscribe(self, kind: type, topic: str, show: Callable[..., None], *qualities: QoSProfile) -> None:
        """Subscribe to messages of `kind` on `topic`; `take` passes them to `show(message, new_publisher)`.

        new_publisher: whether the message is the first one of another publisher than before. There is one subscription
        for each of the `qualities`; a message that several of them receive is passed once.
        """
        deliveries = Deliveries()
        for quality in qualities:
            made = self._node.create_subscription(kind, topic, show, quality, callback_group=self._group)
            self._subscriptions.append((made, show, PublisherChange(lambda: self._publishers(topic)), deliveries))

    def _publishers(self, topic: str) -> set[Hashable]:
        """Identifiers of the processes that publish on `topic`. A node may replace one of its publishers."""
        return {tuple(info.endpoint_gid[:PROCESS]) for info in self._node.get_publishers_info_by_topic(topic)}

    def note_publishers(self) -> None:
        """Note the present publishers of all topics, for messages that are not yet taken."""
        for _, _, publisher_change, _ in self._subscriptions:
            publisher_change.note_publishers()

    def take(self, before: int = 0) -> int:
        """Take the waiting messages, at most `BATCH` per subscription, and pass them on; returns the number of those
        from `before` [ns]; 0: all.

        After a `TURN` it returns, and the next call begins with the next subscription. A message that raises an error
        is logged and left out. Messages are taken as bytes: otherwise rclpy would build a message object even if none
        has come.
        """
        count, end = 0, time.monotonic() + TURN
        for place, each in enumerate(self._subscriptions, start=1):
            count += self._take_from(*(*each, end, before))
            if time.monotonic() > end:
                self._subscriptions = [*self._subscriptions[place:], *self._subscriptions[:place]]
                break
        return count

    def _take_from(self, subscription, show, publisher_change, deliveries, end: float, before: int) -> int:
        """Take messages of one subscription until `end` [s, steady clock]; returns how many are from `before`."""
        count = 0
        with subscription.handle:  # keeps it from being destroyed meanwhile
            for _ in range(BATCH):
                if time.monotonic() > end:
                    break
                taken = subscription.handle.take_message(subscription.msg_type, True)
                if taken is None:
                    break
                data, about = taken
                count += not before or is_from_before(about, before)
                new_publisher = publisher_change.changes(
                    about["publication_sequence_number"], about["source_timestamp"]
                )
                if new_publisher:
                    self.note_publishers()
                if not deliveries.repeats(about):
                    try:
                        show(read_message(data, subscription.msg_type), new_publisher)
                    except Exception as error:
                        log_dropped(self._node, error, f"a message of {subscription.topic_name}")
        return count
