# SPDX-License-Identifier: Apache-2.0
"""The node's publishers and those who subscribe to them."""

from types import SimpleNamespace

import pytest
from eel_dynamics.ros.diagnostics import Report
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.publishers import Publishers, WaitBudget
from fake_log import Log


def test_patience_is_one_account_for_all_topics():
    patience = WaitBudget()
    patience.begin(0.0)
    assert not patience.over(4.9, 5.0) and patience.over(5.0, 5.0)
    patience.begin(5.1)
    assert patience.over(5.2, 5.0)  # the next topic of the same subscriber: no further wait
    patience.begin(100.0)
    assert not patience.over(104.0, 5.0)
    patience.renew()
    patience.begin(104.5)
    assert not patience.over(109.0, 5.0)


@pytest.mark.fault(
    "subscribers", "a subscriber of a costly topic that comes while a sample is made", "it gets the next sample"
)
def test_a_subscriber_that_comes_after_the_snapshot_was_taken(monkeypatch):
    """Nobody subscribes when it is asked what to compute; somebody does when it is published."""
    monkeypatch.setattr("eel_dynamics.ros.publishers.COUNT_PERIOD", 0.0)
    received, audience = [], {"internal_wrench": 0, "hydrodynamic_load": 0, "energy": 0}
    sample = SimpleNamespace(
        kinds=dict.fromkeys(audience, str),
        set_time=lambda nanoseconds: None,
        fill=lambda name, snapshot: (name, snapshot.torque, snapshot.fluid_force),
    )

    def create(kind, topic, depth):
        return SimpleNamespace(get_subscription_count=lambda: audience[topic], publish=received.append)

    publishers = Publishers(
        sample, create=create, destroy=None, known=None, received=None, publish_error=RuntimeError,
        values=DynamicsParameters, stopped=lambda: False, report=Report(Log()),
    )  # fmt: skip
    assert publishers.wanted_parts() == {"wrench": False, "load": False}
    audience.update(dict.fromkeys(audience, 1))
    publishers.publish(SimpleNamespace(torque=None, fluid_force=None), 0)
    assert received == []
    assert publishers.wanted_parts() == {"wrench": True, "load": True}
    publishers.publish(SimpleNamespace(torque=1, fluid_force=2), 0)
    assert [name for name, *_ in received] == ["internal_wrench", "hydrodynamic_load", "energy"]


@pytest.mark.parametrize("factor", [0.0, 1.0])
def test_subscribers_that_are_waited_for_are_counted_on_each_topic(factor):
    """At real time too. Those of some topics alone are complete when none has come for a while."""
    audience = dict.fromkeys(("head_pose", "backbone", "swim_state"), 0)
    publishers = Publishers(
        SimpleNamespace(kinds=dict.fromkeys(audience, str)), destroy=None, known=None, received=None,
        create=lambda kind, topic, depth: SimpleNamespace(get_subscription_count=lambda: audience[topic]),
        publish_error=RuntimeError, values=lambda: DynamicsParameters(real_time_factor=factor),
        stopped=lambda: False, report=Report(Log()),
    )  # fmt: skip
    assert not publishers.subscribers_complete(2, 10.0)
    audience["head_pose"] = 5
    assert not publishers.subscribers_complete(2, 11.0)  # five of one topic are not two of each
    audience["backbone"] = 1
    assert not publishers.subscribers_complete(2, 12.9) and not publishers.subscribers_complete(2, 13.8)
    audience["backbone"] = 2
    assert publishers.subscribers_complete(2, 13.9)  # nobody has to plot
    audience["backbone"] = 1
    assert not publishers.subscribers_complete(2, 14.0) and publishers.subscribers_complete(2, 15.1)


def test_who_was_given_up_does_not_cost_the_others_the_end_of_a_run(monkeypatch):
    """Its topic gets a short farewell; on the others a backlog is waited for as long as without it."""
    monkeypatch.setattr("eel_dynamics.ros.publishers.END_TIMEOUT", 0.0)
    asked = []

    def received(publisher, seconds):
        asked.append(publisher)
        return publisher == "head_pose" and asked.count(publisher) == 20

    publishers = Publishers(
        SimpleNamespace(kinds=dict.fromkeys(("backbone", "head_pose"), str)), create=lambda kind, topic, depth: topic,
        destroy=lambda publisher: None, known=None, received=received, publish_error=RuntimeError,
        values=lambda: DynamicsParameters(real_time_factor=0.0), stopped=lambda: False, report=Report(Log()),
    )  # fmt: skip
    publishers._give_up(publishers._channels["backbone"])
    assert not publishers.wait_until_received([], lambda: False)
    assert asked == ["head_pose"] * 20 + ["backbone"]
