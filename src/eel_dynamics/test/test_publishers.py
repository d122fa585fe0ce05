# SPDX-License-Identifier: Apache-2.0
"""The node's publishers and those who subscribe to them."""

from types import SimpleNamespace

import pytest
from eel_common.ros.loop.channel import WaitBudget
from eel_common.ros.loop.diagnostics import Report
from eel_common.ros.testing.log import Log
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.publishers import END_TIMEOUT, Publishers

from eel_dynamics import Scene


class FakeNode:
    """A node whose topics have the `audience`; subscribers of those in `late` have not received everything."""

    def __init__(self, audience, published=None, late=()):
        self.audience, self.published, self.late = audience, published, late

    def create_publisher(self, kind, topic, quality):
        return SimpleNamespace(
            handle=SimpleNamespace(get_subscription_count=lambda: self.audience[topic]),
            wait_for_all_acked=lambda longest: topic not in self.late,
            publish=self.published,
        )

    def destroy_publisher(self, publisher):
        pass


def publishers_of(monkeypatch, node, factor, log=None):
    """The node's publishers, with tuples in place of messages."""
    sample = SimpleNamespace(
        kinds=dict.fromkeys(node.audience, str),
        set_time=lambda nanoseconds: None,
        fill=lambda name, snapshot: (name, snapshot.torque, snapshot.fluid_force),
    )
    monkeypatch.setattr("eel_dynamics.ros.publishers.SampleMessages", lambda simulation, values: sample)
    monkeypatch.setattr("eel_dynamics.ros.publishers.Publishers.publish_body", lambda self, simulation: None)
    values = DynamicsParameters(real_time_factor=factor, publish_robot_description=False)
    parameters = SimpleNamespace(values=values, sensors=())
    swimmer = SimpleNamespace(scene=Scene(), flow=None, robot=None, swimmer=SimpleNamespace(sensors=(), robot=None))
    return Publishers(node, swimmer, parameters, Report(log or Log()))


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
    received, audience = [], {"internal_wrench": 0, "hydrodynamic_load": 0, "energy": 0}
    node = FakeNode(audience, published=received.append)
    publishers = publishers_of(monkeypatch, node, 1.0)
    assert publishers.wanted_parts() == {"wrench": False, "load": False}
    audience.update(dict.fromkeys(audience, 1))
    publishers.publish(SimpleNamespace(torque=None, fluid_force=None), 0)
    assert received == []
    assert publishers.wanted_parts() == {"wrench": True, "load": True}
    publishers.publish(SimpleNamespace(torque=1, fluid_force=2), 0)
    assert [name for name, *_ in received] == ["internal_wrench", "hydrodynamic_load", "energy"]


@pytest.mark.parametrize("factor", [0.0, 1.0])
def test_subscribers_that_are_waited_for_are_counted_on_each_topic(monkeypatch, factor):
    """At real time too. Those of some topics alone are complete when none has come for a while."""
    audience = dict.fromkeys(("head_pose", "backbone", "swim_state"), 0)
    publishers = publishers_of(monkeypatch, FakeNode(audience), factor)
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
    log, late = Log(), {"backbone", "head_pose"}
    node = FakeNode(dict.fromkeys(("backbone", "head_pose"), 1), late=late)
    publishers = publishers_of(monkeypatch, node, 0.0, log)
    publishers._give_up(publishers._channels["backbone"])
    assert not publishers.all_received([], END_TIMEOUT + 1.0)
    late.discard("head_pose")
    assert not publishers.all_received([], END_TIMEOUT - 1.0) and "received everything" not in str(log.lines)
    assert publishers.all_received([], END_TIMEOUT + 1.0)
    assert log.lines[-1] == ("warning", "some subscriber has not received everything within 6 s")
