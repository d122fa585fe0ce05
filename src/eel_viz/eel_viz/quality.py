"""Quality of service of a subscriber that wants everything, fitted to what publishers offer."""

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


def keep_all(*, reliable: bool = True, latched: bool = False) -> QoSProfile:
    """Keep all, as reliable as the publishers are; `latched` asks for what was published before, too."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        depth=1,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def fitting(offers: list[QoSProfile]) -> QoSProfile:
    """The most that all of `offers` can serve."""
    return keep_all(
        reliable=all(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers),
        latched=all(offer.durability == DurabilityPolicy.TRANSIENT_LOCAL for offer in offers),
    )


def hears(profile: QoSProfile, offer: QoSProfile) -> bool:
    """Whether a subscription of `profile` matches a publisher's `offer`."""
    reliable = profile.reliability == ReliabilityPolicy.RELIABLE and offer.reliability != ReliabilityPolicy.RELIABLE
    latched = (
        profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and offer.durability != DurabilityPolicy.TRANSIENT_LOCAL
    )
    return not reliable and not latched
