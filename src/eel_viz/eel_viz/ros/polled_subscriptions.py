# SPDX-License-Identifier: Apache-2.0
"""Subscriptions that a node polls itself: many messages at once, instead of one executor call per message.

An executor collects and waits on all entities of a node before each message. With eight topics that costs more than
logging them. A `PolledGroup` is never executed, so messages stay in the KEEP_ALL histories until they are taken.
"""

import math
import time
from collections.abc import Callable, Hashable, Mapping
from functools import partial
from typing import Any

from eel_base.topics import SWIMMER
from eel_ros.deliveries import Deliveries
from eel_ros.run_node import is_from_before
from eel_ros.serving import PolledGroup, log_dropped, read_message
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from eel_viz.ros.publisher_change import PublisherChange

BATCH = 64  # messages taken from one subscription before the next one
TAKE_LIMIT = 0.2  # s after which `take` returns, so that the node hears calls and signals
PROCESS = 12  # bytes of an endpoint's identifier that all endpoints of a process share (RTPS: the GUID's prefix)
GONE = 0.5  # s without publishers and messages, after which a swimmer has gone

Receive = Callable[[bytes, Mapping[str, Any]], None]  # the serialised message, and the message info
Show = Callable[[Any, bool], None]  # the message, and whether it is the first of another publisher


def take_waiting(
    node: Node, subscription: Subscription, receive: Receive, before: int = 0, end: float = math.inf
) -> int:
    """Pass the waiting messages of a subscription to `receive`, at most `BATCH`, until `end` [s, steady clock].

    Returns the number of those from `before` [ns]; 0: all. A message that raises an error is logged and left out.
    Messages are taken as bytes: otherwise rclpy would build a message object even if none has come.
    """
    count = 0
    with subscription.handle:  # keeps it from being destroyed meanwhile
        for _ in range(BATCH):
            taken = subscription.handle.take_message(subscription.msg_type, True)
            if taken is None:
                break
            data, about = taken
            count += not before or is_from_before(about, before)
            try:
                receive(data, about)
            except Exception as error:
                log_dropped(node, error, f"a message of {subscription.topic_name}")
            if time.monotonic() > end:
                break
    return count


class PolledSubscriptions:
    """The subscriptions of `node`."""

    def __init__(self, node: Node) -> None:
        self._node, self._group = node, PolledGroup()
        self._subscriptions: list[tuple[Subscription, Receive]] = []
        self._changes: list[PublisherChange] = []

    def subscribe(self, kind: type[Any], topic: str, show: Show, *qualities: QoSProfile) -> None:
        """Subscribe to messages of `kind` on `topic`; `take` passes them to `show`.

        There is one subscription for each of the `qualities`; a message that several of them receive is passed once.
        """
        deliveries = Deliveries()

        def receive(change: PublisherChange, data: bytes, about: Mapping[str, Any]) -> None:
            new_publisher = change.changes(about["publication_sequence_number"], about["source_timestamp"])
            if new_publisher:
                self.note_publishers()
            if not deliveries.repeats(about):
                show(read_message(data, kind), new_publisher)

        for quality in qualities:
            change = PublisherChange(lambda: self._publishers(topic))
            made = self._node.create_subscription(kind, topic, unused, quality, callback_group=self._group)
            self._subscriptions.append((made, partial(receive, change)))
            self._changes.append(change)

    def note_publishers(self) -> None:
        """Note the present publishers of all topics, for messages that are not yet taken."""
        for change in self._changes:
            change.note_publishers()

    def take(self, before: int = 0) -> int:
        """Take the waiting messages of all subscriptions, and pass them on; returns as `take_waiting`.

        After a `TAKE_LIMIT` it returns, and the next call begins with the next subscription.
        """
        count, end = 0, time.monotonic() + TAKE_LIMIT
        for place, (subscription, receive) in enumerate(self._subscriptions, start=1):
            count += take_waiting(self._node, subscription, receive, before, end)
            if time.monotonic() > end:
                self._subscriptions = [*self._subscriptions[place:], *self._subscriptions[:place]]
                break
        return count

    def _publishers(self, topic: str) -> set[Hashable]:
        """Identifiers of the processes that publish on `topic`. A node may replace one of its publishers."""
        return {tuple(info.endpoint_gid[:PROCESS]) for info in self._node.get_publishers_info_by_topic(topic)}


class SwimmerPresence:
    """Whether the swimmer of the namespace of `node` is there: its publishers, or its messages."""

    def __init__(self, node: Node) -> None:
        self._node, self._topic = node, node.resolve_topic_name(SWIMMER)
        self._present = False
        self._last_seen = time.monotonic()

    def heard(self, topic: str) -> None:
        """A message has come on `topic`; a law alone is not a swimmer."""
        self._last_seen = time.monotonic()
        self._present |= topic == self._topic

    def has_gone(self) -> bool:
        """Whether the swimmer was there and has gone, with all of its publishers and messages."""
        if self._node.count_publishers(SWIMMER):
            self._present, self._last_seen = True, time.monotonic()
        return self._present and time.monotonic() - self._last_seen >= GONE


def unused(message: Any) -> None:
    """The callback of a subscription that no executor runs."""
