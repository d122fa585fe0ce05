# SPDX-License-Identifier: Apache-2.0
"""Subscriptions that the visualiser polls: a turn ends after a while, and the next one begins where it ended."""

from contextlib import nullcontext

from eel_viz.ros import polled_subscriptions
from eel_viz.ros.polled_subscriptions import TAKE_LIMIT, PolledSubscriptions
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import String


class Waiting(nullcontext):
    """Stands for a subscription, and its handle, on which messages wait without end."""

    def __init__(self, topic):
        super().__init__()
        self.msg_type, self.topic_name, self.handle, self._count = String, topic, self, 0

    def take_message(self, kind, raw):
        self._count += 1
        about = {"publication_sequence_number": self._count, "source_timestamp": self._count}
        return serialize_message(String(data=self.topic_name)), about


class Node:
    def create_subscription(self, kind, topic, *quality, **options):
        return Waiting(topic)

    def get_publishers_info_by_topic(self, topic):
        return []


def test_a_turn_of_slow_messages_ends_and_all_topics_get_their_turns(monkeypatch):
    now, shown = [0.0], []
    monkeypatch.setattr(polled_subscriptions.time, "monotonic", lambda: now[0])

    def show(message, new_publisher):
        now[0] += 0.6 * TAKE_LIMIT
        shown.append(message.data)

    polled = PolledSubscriptions(Node())
    for topic in ("pose", "twist", "wrench"):
        polled.show(String, topic, show, QoSProfile(depth=1))
    assert [polled.take() for _ in range(4)] == [2] * 4
    assert shown == ["pose"] * 2 + ["twist"] * 2 + ["wrench"] * 2 + ["pose"] * 2
