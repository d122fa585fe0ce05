"""Subscriptions that are read when there is time, all at once, instead of one call of the executor for each message.

An executor gathers and waits on everything a node has before each single message: with eight topics that is more work
than showing them. Here a group that never lets the executor run leaves the messages where they are, in histories that
keep all, until `take` fetches them.
"""

from collections import deque
from collections.abc import Callable

from eel_ros.serving import Unattended, leave_out
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message

from eel_viz.ros.publisher_change import Succession

BATCH = 64  # messages of one subscription before the next has its turn
PROCESS = 12  # bytes of an endpoint's identifier that its whole process has (RTPS: the GUID's prefix)
REMEMBERED = 1024  # deliveries to subscriptions of one topic, of which one may be some batches behind the other


class Inbox:
    """The subscriptions of `node`."""

    def __init__(self, node: Node) -> None:
        self._node, self._group = node, Unattended()
        self._subscriptions: list[tuple] = []

    def listen(self, kind: type, topic: str, show: Callable[..., None], *qualities: QoSProfile) -> None:
        """Messages of `kind` on `topic` go to `show(message, successor)`, from `take`; `successor`: whether it is the
        first one of another publisher than before. There is a subscription for each of the `qualities`; a message that
        several of them receive is shown once."""
        delivered = deque(maxlen=REMEMBERED if len(qualities) > 1 else 0)
        for quality in qualities:
            made = self._node.create_subscription(kind, topic, show, quality, callback_group=self._group)
            self._subscriptions.append((made, show, Succession(lambda: self._publishers(topic)), delivered))

    def _publishers(self, topic: str) -> set[tuple]:
        """The processes that publish on `topic`. A node that replaces one of its publishers remains the same."""
        return {tuple(info.endpoint_gid[:PROCESS]) for info in self._node.get_publishers_info_by_topic(topic)}

    def look(self) -> None:
        """Now and then: remember who publishes, for the messages that are yet to be taken."""
        for _, _, succession, _ in self._subscriptions:
            succession.look()

    def take(self) -> int:
        """Show what has come, `BATCH` of a subscription at most; returns how many were taken. What cannot be
        shown is left out.

        Messages are taken as bytes: otherwise a message would be made even where none has come.
        """
        count = 0
        for subscription, show, succession, delivered in self._subscriptions:
            with subscription.handle:  # else it could be destroyed meanwhile
                for _ in range(BATCH):
                    taken = subscription.handle.take_message(subscription.msg_type, True)
                    if taken is None:
                        break
                    count += 1
                    data, about = taken
                    delivery = about["publication_sequence_number"], about["source_timestamp"]
                    successor = succession.changes(*delivery)
                    if successor:
                        self.look()
                    if delivery not in delivered:
                        delivered.append(delivery)
                        try:
                            show(deserialize_message(data, subscription.msg_type), successor)
                        except Exception as error:
                            leave_out(self._node, error, f"a message of {subscription.topic_name}")
        return count
