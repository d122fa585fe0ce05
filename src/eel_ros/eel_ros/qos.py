# SPDX-License-Identifier: Apache-2.0
"""Quality-of-service profiles: KEEP_ALL, transient local, and profiles that match the publishers' offers."""

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


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
