# SPDX-License-Identifier: Apache-2.0
"""Quality of service: KEEP_ALL, transient local, profiles that match the publishers' offers; two for one topic."""

from collections.abc import Mapping
from typing import Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

REMEMBERED = 4096  # deliveries: one of two subscriptions may be so far behind the other


def latched(depth: int) -> QoSProfile:
    """Reliable and transient local: later subscribers get the newest `depth` messages."""
    return QoSProfile(depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def keep_all(*, reliable: bool = True, latched: bool = False) -> QoSProfile:
    """KEEP_ALL history: no message is dropped. `latched`: transient local, a subscriber also gets earlier messages."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        depth=1,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def fitting(offers: list[QoSProfile]) -> QoSProfile:
    """The strictest subscription profile that all of the publishers' `offers` match."""
    return keep_all(
        reliable=all(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers),
        latched=all(offer.durability == DurabilityPolicy.TRANSIENT_LOCAL for offer in offers),
    )


def matches(profile: QoSProfile, offer: QoSProfile) -> bool:
    """Whether a subscription with `profile` gets the messages of a publisher with `offer`."""
    unreliable = profile.reliability == ReliabilityPolicy.RELIABLE and offer.reliability != ReliabilityPolicy.RELIABLE
    volatile = (
        profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and offer.durability != DurabilityPolicy.TRANSIENT_LOCAL
    )
    return not unreliable and not volatile


class Deliveries:
    """The messages of one topic, by the time at which they were sent and their publisher's count of messages.

    A topic may need two subscriptions, because one quality of service does not match all publishers. A publisher that
    both match then delivers each message twice.
    """

    def __init__(self) -> None:
        self._known: dict[tuple[Any, ...], None] = {}  # the oldest first

    def repeats(self, info: Mapping[str, Any]) -> bool:
        """Whether the message with this message `info` has come before; from now on it has.

        A message without a time of sending is never a repetition.
        """
        delivery = info.get("source_timestamp"), info.get("publication_sequence_number")
        if delivery in self._known:
            return True
        if delivery[0]:
            self._known[delivery] = None
            if len(self._known) > REMEMBERED:
                del self._known[next(iter(self._known))]
        return False
