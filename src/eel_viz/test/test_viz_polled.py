# SPDX-License-Identifier: Apache-2.0
"""Subscriptions that the visualiser polls one message of each in turn, and topics that wait for one another."""

import math
import weakref
from collections import Counter
from contextlib import nullcontext

import pytest
from eel_common.topics import SWIMMER
from eel_viz.ros import polled_subscriptions
from eel_viz.ros.polled_subscriptions import DROP_LIMIT, GONE, TAKE_LIMIT, PolledSubscriptions, SwimmerPresence
from eel_viz.same_stamp import UNSEEN, SameStamp
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import String


class Waiting(nullcontext):
    """Stands for a subscription, and its handle, on which so many messages wait."""

    def __init__(self, topic, waiting):
        super().__init__()
        self.msg_type, self.topic_name, self.handle, self._count, self._waiting = String, topic, self, 0, waiting

    def take_message(self, kind, raw):
        if self._count == self._waiting:
            return None
        self._count += 1
        about = {"publication_sequence_number": self._count, "source_timestamp": self._count}
        return serialize_message(String(data=self.topic_name)), about


class Node:
    def __init__(self, waiting=math.inf):
        self._waiting = waiting

    def create_subscription(self, kind, topic, *quality, **options):
        return Waiting(topic, self._waiting)

    def get_publishers_info_by_topic(self, topic):
        return []

    def resolve_topic_name(self, topic):
        return f"/{topic}"

    def count_publishers(self, topic):
        return 0


def test_a_turn_of_slow_messages_ends_and_all_topics_get_their_turns(monkeypatch):
    now, shown = [0.0], []
    monkeypatch.setattr(polled_subscriptions.time, "monotonic", lambda: now[0])

    def show(message, new_publisher, sent):
        now[0] += 0.6 * TAKE_LIMIT
        shown.append(message.data)

    polled = PolledSubscriptions(Node())
    for topic in ("pose", "twist", "wrench"):
        polled.show(String, topic, show, QoSProfile(depth=1))
    assert [polled.take() for _ in range(4)] == [2] * 4
    assert shown == ["pose", "twist", "wrench", "pose", "twist", "wrench", "pose", "twist"]


@pytest.mark.parametrize(("waiting", "expected"), [(3, (4, True)), (math.inf, (2, False))])
def test_what_is_dropped_is_counted_for_a_while(monkeypatch, waiting, expected):
    """Of two topics with so many messages each those from before 3 ns; each takes longer than there is time for."""
    now = [0.0]

    def monotonic():
        now[0] += 0.6 * DROP_LIMIT if waiting == math.inf else 0.0
        return now[0]

    monkeypatch.setattr(polled_subscriptions.time, "monotonic", monotonic)
    monkeypatch.setattr(
        polled_subscriptions, "is_from_before", lambda about, before: about["source_timestamp"] < before
    )
    polled = PolledSubscriptions(Node(waiting))
    for topic in ("pose", "twist"):
        polled.show(String, topic, lambda *shown: pytest.fail("it is shown"), QoSProfile(depth=1))
    assert polled.drop(3) == expected


def test_no_topic_runs_ahead_of_one_that_is_slow_to_show(monkeypatch):
    """On a machine with much else to do a backbone takes 20 ms; 600 samples wait on each topic."""
    now, shown, apart = [0.0], Counter(backbone=0), []
    monkeypatch.setattr(polled_subscriptions.time, "monotonic", lambda: now[0])

    def show(message, new_publisher, sent):
        now[0] += 0.02 if message.data == "backbone" else 1e-4
        shown[message.data] += 1
        apart.append(max(shown.values()) - min(shown.values()))

    polled = PolledSubscriptions(Node(waiting=600))
    for topic in ("pose", "backbone", "twist"):
        polled.show(String, topic, show, QoSProfile(depth=1))
    while polled.take():
        pass
    assert shown == dict.fromkeys(("pose", "backbone", "twist"), 600) and max(apart) == 1


def test_a_topic_whose_message_comes_a_little_later_is_not_left_behind(monkeypatch):
    """A turn may begin while a sample is being published."""
    shown = []
    polled = PolledSubscriptions(Node(waiting=5))
    for topic in ("pose", "curvature"):
        polled.show(String, topic, lambda message, *about: shown.append(message.data), QoSProfile(depth=1))
    late = next(subscription for subscription in polled._receivers if subscription.topic_name == "curvature")
    take, empty = late.take_message, [None, None]
    monkeypatch.setattr(late, "take_message", lambda *kind: empty.pop() if empty else take(*kind))
    assert polled.take() == 10
    assert shown == ["pose"] * 3 + ["curvature", "pose"] * 2 + ["curvature"] * 3 and polled.take() == 0


def test_a_swimmer_has_not_gone_while_its_messages_wait(monkeypatch):
    """However long it takes to show one, or to send what is shown."""
    now = [0.0]
    monkeypatch.setattr(polled_subscriptions.time, "monotonic", lambda: now[0])
    presence = SwimmerPresence(Node())
    presence.heard(f"/{SWIMMER}")
    for taken, gone in ((1, False), (1, False), (0, True)):
        now[0] += 2.0 * GONE
        assert not presence.has_gone()
        presence.look(taken)
        assert presence.has_gone() is gone


def test_a_topic_that_is_ahead_by_a_whole_history_loses_nothing():
    drawn = []
    both = SameStamp(lambda *values: drawn.append(values))
    both.second(0, "second 0")
    for stamp in range(1, 5001):
        both.first(stamp, f"first {stamp}")
    for stamp in range(1, 5001, 4):
        both.second(stamp, f"second {stamp}")
    assert drawn == [(stamp, f"first {stamp}", f"second {stamp}") for stamp in range(1, 5001, 4)]


def test_what_the_other_topic_has_passed_or_never_meets_is_let_go():
    class Value:
        pass

    both, kept = SameStamp(lambda *values: None), weakref.WeakSet()

    def fill(stamps):
        for stamp in stamps:
            value = Value()
            kept.add(value)
            both.first(stamp, value)

    fill(range(2 * UNSEEN))
    assert len(kept) == UNSEEN
    both.second(2 * UNSEEN - 10, None)
    assert len(kept) == 9
