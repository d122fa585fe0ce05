# SPDX-License-Identifier: Apache-2.0
"""Quality of service: KEEP_ALL, transient local, profiles that match publishers' offers; messages delivered twice."""

from collections.abc import Mapping
from typing import Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

REMEMBERED = 4096  # deliveries: the largest lag between two subscriptions


def latched(depth: int) -> QoSProfile:
    """Reliable and transient local: later subscribers get the newest `depth` messages."""
    return QoSProfile(depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def keep_all(*, reliable: bool = True, latched: bool = False) -> QoSProfile:
    """KEEP_ALL history: no message is dropped. `latched`: transient local; later subscribers get earlier messages."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        depth=1,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def fitting(offers: list[QoSProfile]) -> QoSProfile:
    """The strictest subscription profile that matches all of the publishers' `offers`."""
    return keep_all(
        reliable=all(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers),
        latched=all(offer.durability == DurabilityPolicy.TRANSIENT_LOCAL for offer in offers),
    )


def matches(profile: QoSProfile, offer: QoSProfile) -> bool:
    """Whether a subscription with `profile` matches a publisher with `offer`."""
    unreliable = profile.reliability == ReliabilityPolicy.RELIABLE and offer.reliability != ReliabilityPolicy.RELIABLE
    volatile = (
        profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and offer.durability != DurabilityPolicy.TRANSIENT_LOCAL
    )
    return not unreliable and not volatile


class Deliveries:
    """The messages received on one topic, told apart by time of sending and the publisher's count.

    One quality of service may not match all publishers, so that a topic needs two subscriptions. A publisher that
    matches both then delivers each message twice.
    """

    def __init__(self) -> None:
        self._known: dict[tuple[Any, ...], None] = {}  # the oldest first

    def repeats(self, info: Mapping[str, Any]) -> bool:
        """Whether a message with this `info` has come before. It is remembered.

        A message without a time of sending never counts as repeated.
        """
        delivery = info.get("source_timestamp"), info.get("publication_sequence_number")
        if delivery in self._known:
            return True
        if delivery[0]:
            self._known[delivery] = None
            if len(self._known) > REMEMBERED:
                del self._known[next(iter(self._known))]
        return False
