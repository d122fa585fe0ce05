"""Quality of service: keep all messages, get those published before, and match what publishers offer."""

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


def latched(depth: int) -> QoSProfile:
    """Reliable; the newest `depth` messages are kept for subscribers that come later."""
    return QoSProfile(depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def keep_all(*, reliable: bool = True, latched: bool = False) -> QoSProfile:
    """No message is dropped for want of room. `latched`: a subscriber also gets what was published before."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        depth=1,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def fitting(offers: list[QoSProfile]) -> QoSProfile:
    """The most that all of the publishers' `offers` can serve."""
    return keep_all(
        reliable=all(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers),
        latched=all(offer.durability == DurabilityPolicy.TRANSIENT_LOCAL for offer in offers),
    )


def matches(profile: QoSProfile, offer: QoSProfile) -> bool:
    """Whether a subscription of `profile` gets the messages of a publisher's `offer`."""
    unreliable = profile.reliability == ReliabilityPolicy.RELIABLE and offer.reliability != ReliabilityPolicy.RELIABLE
    volatile = (
        profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and offer.durability != DurabilityPolicy.TRANSIENT_LOCAL
    )
    return not unreliable and not volatile
