"""Subscriptions that are read when there is time, all at once, instead of one call of the executor for each message.

An executor gathers and waits on everything a node has before each single message: with eight topics that is more work
than showing them. Here a group that never lets the executor run leaves the messages where they are, in histories that
keep all, until `take` fetches them.
"""

from collections.abc import Callable

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message

from eel_viz.lifetime import leave_out
from eel_viz.succession import Succession

BATCH = 64  # messages of one topic before the next has its turn


class Untouched(CallbackGroup):
    """What the executor leaves alone."""

    def can_execute(self, entity) -> bool:
        """Never."""
        return False

    def beginning_execution(self, entity) -> bool:
        """Never."""
        return False

    def ending_execution(self, entity) -> None:
        """Nothing has begun."""


class Inbox:
    """The subscriptions of `node`."""

    def __init__(self, node: Node) -> None:
        self._node, self._group = node, Untouched()
        self._subscriptions: list[tuple] = []

    def listen(self, kind: type, topic: str, show: Callable[..., None], quality: QoSProfile) -> None:
        """Messages of `kind` on `topic` go to `show(message, successor)`, from `take`; `successor`: whether it is the
        first one of another publisher than before."""
        made = self._node.create_subscription(kind, topic, show, quality, callback_group=self._group)
        self._subscriptions.append((made, show, Succession(lambda: self._publishers(topic))))

    def _publishers(self, topic: str) -> set[tuple]:
        """Their identifiers."""
        return {tuple(info.endpoint_gid) for info in self._node.get_publishers_info_by_topic(topic)}

    def take(self) -> int:
        """Show what has come, `BATCH` of a topic at most; returns how many. What cannot be shown is left out.

        Messages are taken as bytes: otherwise a message would be made even where none has come.
        """
        count = 0
        for subscription, show, succession in self._subscriptions:
            with subscription.handle:  # else it could be destroyed meanwhile
                for _ in range(BATCH):
                    taken = subscription.handle.take_message(subscription.msg_type, True)
                    if taken is None:
                        break
                    data, about = taken
                    count += 1
                    successor = succession.changes(about["publication_sequence_number"], about["source_timestamp"])
                    try:
                        show(deserialize_message(data, subscription.msg_type), successor)
                    except Exception as error:
                        leave_out(self._node, error, f"a message of {subscription.topic_name}")
        return count
