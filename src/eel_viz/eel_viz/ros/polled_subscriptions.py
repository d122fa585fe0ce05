# SPDX-License-Identifier: Apache-2.0
"""Subscriptions that a node polls itself: many messages at once, instead of one executor call per message.

An executor collects and waits on all entities of a node before each message. With eight topics that costs more than
logging. A `PolledGroup` is never executed, so messages stay in the KEEP_ALL histories until they are taken.
"""

import time
from collections.abc import Callable, Hashable, Mapping
from functools import partial
from typing import Any

from eel_common.ros.qos import Deliveries
from eel_common.ros.run_node import is_from_before
from eel_common.ros.serving import PolledGroup, log_dropped, read_message
from eel_common.topics import SWIMMER
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

TAKE_LIMIT = 0.2  # s: then `take` returns, so that the node answers calls and signals
DROP_LIMIT = 0.5  # s: then `drop` returns, as the node ends
PROCESS = 12  # bytes of an endpoint's identifier shared by all endpoints of a process (RTPS: the GUID's prefix)
PAUSE = 0.3  # s: after a longer pause the publishers are looked up; no node starts faster
GONE = 0.5  # s without publishers and messages, after which a swimmer has gone

Receive = Callable[[bytes, Mapping[str, Any]], None]  # the serialised message, and the message info
Show = Callable[[Any, bool, int], None]  # the message, whether it is the first of a new publisher, time of sending [ns]


class PolledSubscriptions:
    """The subscriptions of `node`. Messages are taken as bytes: rclpy would otherwise build one even if none has
    come."""

    def __init__(self, node: Node) -> None:
        self._node, self._group = node, PolledGroup()
        self._receivers: dict[Subscription, Receive] = {}
        self._changes: list[PublisherChange] = []

    def add(self, kind: type[Any], topic: str, quality: QoSProfile, receive: Receive) -> Subscription:
        """Subscribe to messages of `kind` on `topic`; `take` passes them to `receive`."""
        made = self._node.create_subscription(kind, topic, unused, quality, raw=True, callback_group=self._group)
        self._receivers[made] = receive
        return made

    def remove(self, subscription: Subscription) -> None:
        del self._receivers[subscription]
        self._node.destroy_subscription(subscription)

    def show(self, kind: type[Any], topic: str, show: Show, *qualities: QoSProfile) -> None:
        """Subscribe likewise, once for each of the `qualities`. A message that several receive goes to `show` once."""
        deliveries = Deliveries()

        def receive(change: PublisherChange, data: bytes, about: Mapping[str, Any]) -> None:
            sent = about["source_timestamp"]
            new_publisher = change.changes(about["publication_sequence_number"], sent)
            if new_publisher:
                self.note_publishers()
            if not deliveries.repeats(about):
                show(read_message(data, kind), new_publisher, sent)

        for quality in qualities:
            self._changes.append(PublisherChange(lambda: self._publishers(topic)))
            self.add(kind, topic, quality, partial(receive, self._changes[-1]))

    def note_publishers(self) -> None:
        """Note the present publishers of all topics, for messages not yet taken."""
        for change in self._changes:
            change.note_publishers()

    def take(self, before: int = 0) -> int:
        """Pass on waiting messages, one of each subscription in turn. Returns the number from `before` [ns]; 0: of all.

        So no topic falls behind: neither one that is slow to show, nor one whose message comes a little after the
        others'. It returns when nothing waits, or after `TAKE_LIMIT`. The next call begins with the next subscription.
        Messages that cause an error are logged and left out.
        """
        count, end, empty = 0, time.monotonic() + TAKE_LIMIT, 0
        while empty < len(self._receivers) and time.monotonic() <= end:
            subscription = next(iter(self._receivers))
            self._receivers[subscription] = receive = self._receivers.pop(subscription)  # moved to the end
            taken = _take_one(subscription)
            empty += 1
            if taken is None:
                continue
            empty = 0
            count += not before or is_from_before(taken[1], before)
            try:
                receive(*taken)
            except Exception as error:
                log_dropped(self._node, error, f"a message of {subscription.topic_name}")
        return count

    def drop(self, before: int) -> tuple[int, bool]:
        """Drop waiting messages. Returns the number from `before` [ns], and whether `DROP_LIMIT` sufficed for all."""
        count, end = 0, time.monotonic() + DROP_LIMIT
        for subscription in self._receivers:
            while (taken := _take_one(subscription)) is not None:
                count += is_from_before(taken[1], before)
                if time.monotonic() > end:
                    return count, False
        return count, True

    def _publishers(self, topic: str) -> set[Hashable]:
        """Identifiers of the processes that publish on `topic`. A node may replace one of its publishers."""
        return {tuple(info.endpoint_gid[:PROCESS]) for info in self._node.get_publishers_info_by_topic(topic)}


class PublisherChange:
    """Detects that a message comes from a new publisher, such as a restarted node.

    Stamps are not enough: the new node's may lie beyond the last stamp of the old one. A message does not name its
    publisher, but each publisher counts its messages, and discovery lists the publishers of a topic: `publishers()`
    returns the present ones. After a gap in the count or a pause they are looked up: a new one has taken over. Messages
    may wait until their publisher has gone, so `note_publishers` must be called regularly.
    """

    def __init__(self, publishers: Callable[[], set[Hashable]]) -> None:
        self._publishers = publishers
        self._seen: set[Hashable] = set()
        self._known: set[Hashable] = set()  # publishers seen when messages came
        self._last: tuple[int | None, int] | None = None  # count of the last message, and its time of sending [ns]

    def note_publishers(self) -> None:
        self._seen |= self._publishers()

    def changes(self, count: int | None, sent: int) -> bool:
        """Whether a message is the first of a new publisher. count: its number there. sent: wall time [ns]."""
        last, self._last = self._last, (count, sent)
        if last is None:
            self.note_publishers()
            self._known = set(self._seen)
            return False
        # None: the middleware does not count
        follows = count is None or (last[0] is not None and count == last[0] + 1)
        if follows and 0 <= sent - last[1] < PAUSE * 1e9:
            return False
        self.note_publishers()
        newcomers = self._seen - self._known
        self._known |= newcomers
        return bool(newcomers)


class SwimmerPresence:
    """Whether the swimmer in the namespace of `node` is present, by its publishers or its messages."""

    def __init__(self, node: Node) -> None:
        self._node, self._topic = node, node.resolve_topic_name(SWIMMER)
        self._present = False
        self._last_seen = self._looked = time.monotonic()

    def heard(self, topic: str) -> None:
        """Note a message on `topic`. A law alone does not make a swimmer."""
        self._present |= topic == self._topic

    def look(self, taken: int) -> None:
        """Note that `taken` messages have just been taken. Until the next call, others may be waiting."""
        self._looked = time.monotonic()
        if taken:
            self._last_seen = self._looked

    def has_gone(self) -> bool:
        """Whether the swimmer was present and has gone, with all of its publishers and messages."""
        if self._node.count_publishers(SWIMMER):
            self._present, self._last_seen = True, time.monotonic()
        return self._present and self._looked - self._last_seen >= GONE


def _take_one(subscription: Subscription) -> Any:
    """The next waiting message, and its message info; None without one."""
    with subscription.handle:  # keeps it from being destroyed meanwhile
        return subscription.handle.take_message(subscription.msg_type, True)


def unused(message: Any) -> None:
    """The callback of a subscription that no executor runs."""
