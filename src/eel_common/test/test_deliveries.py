# SPDX-License-Identifier: Apache-2.0
"""Second deliveries of a message, by two subscriptions of one node."""

from eel_common.ros import qos
from eel_common.ros.qos import Deliveries


def info(sent, count):
    return {"source_timestamp": sent, "publication_sequence_number": count}


def test_a_message_that_comes_again_is_recognised_whatever_came_in_between():
    received = Deliveries()
    order = [info(1000, 1), info(1001, 2), info(1000, 1), info(1001, 1), info(1001, 2)]
    assert [received.repeats(each) for each in order] == [False, False, True, False, True]


def test_messages_without_a_time_of_sending_are_never_repetitions():
    received = Deliveries()
    assert not any(received.repeats(each) for each in (info(0, 1), info(0, 1), {}, {}))


def test_it_remembers_a_bounded_number_of_messages(monkeypatch):
    monkeypatch.setattr(qos, "REMEMBERED", 3)
    received = Deliveries()
    for count in range(1, 5):
        assert not received.repeats(info(1000, count))
    assert received.repeats(info(1000, 2)) and not received.repeats(info(1000, 1))
