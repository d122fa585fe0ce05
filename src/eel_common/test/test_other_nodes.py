# SPDX-License-Identifier: Apache-2.0
"""Who publishes /clock, and which of two nodes with the same topics goes on."""

from types import SimpleNamespace

import pytest
from eel_common.ros.loop import other_nodes
from eel_common.ros.loop.diagnostics import Report
from eel_common.ros.loop.other_nodes import Identity, OtherNodes
from eel_common.ros.testing.log import Log

FIRST, SECOND = Identity("2026-01-01T00:00:00", "a", "7"), Identity("2026-01-01T00:00:01", "a", "8")


class Network:
    """Nodes /0, /1, ... that get each other's diagnostics once a second, and see all publishers of /clock."""

    def __init__(self, monkeypatch, identities, topics):
        self.time, self.strangers, self.makes_clock = 0.0, [], True
        monkeypatch.setattr(other_nodes.time, "monotonic", lambda: self.time)
        self.logs = [Log() for _ in identities]
        self.nodes = [
            OtherNodes(self.node(f"/{k}"), topic, each, Report(log, lambda: self.time))
            for k, (each, log, topic) in enumerate(zip(identities, self.logs, topics, strict=True))
        ]
        self.present = range(len(identities))

    def node(self, name):
        return SimpleNamespace(
            get_fully_qualified_name=lambda: name, get_publishers_info_by_topic=lambda topic: self.publishers()
        )

    def publishers(self):
        own = [f"{k}" for k in self.present if self.nodes[k].clock_is_free]
        return [SimpleNamespace(node_namespace="/", node_name=name) for name in (*own, *self.strangers)]

    def run(self, seconds):
        """Let time pass; which of the nodes publish /clock at its end."""
        for _ in range(seconds):
            self.time += 1.0
            for sender in self.present:
                for each in self.nodes:
                    each.receive(f"/{sender}", self.nodes[sender].values(self.makes_clock))
            for each in self.nodes:
                each.look(self.makes_clock)
        return [k for k in self.present if self.nodes[k].clock_is_free]


@pytest.mark.parametrize(("identities", "winner"), [((FIRST, SECOND), 0), ((SECOND, FIRST), 1)])
def test_of_two_swimmers_the_one_that_began_first_has_the_clock(monkeypatch, identities, winner):
    network = Network(monkeypatch, identities, ("/left/head_pose", "/right/head_pose"))
    assert network.run(2) == [winner] and network.run(10) == [winner]
    assert not any(each.holding for each in network.nodes)
    network.present = [1 - winner]
    assert network.run(6) == [1 - winner], "the clock comes back when the other has gone"


def test_a_publisher_of_another_kind_gets_the_clock_until_it_has_gone(monkeypatch):
    network = Network(monkeypatch, [FIRST], ["/head_pose"])
    assert network.run(10) == [0]
    network.strangers = ["_NODE_NAME_UNKNOWN_"]
    assert network.run(10) == [0], "it has just been discovered"
    network.strangers = ["simulator"]
    assert network.run(2) == [0] and network.run(3) == []
    network.run(20)
    network.strangers = []
    assert network.run(1) == [0]
    ((level, text), (_, end)) = network.logs[0].lines
    assert level == "warning" and text.startswith("/clock is published by /simulator already: this node does not")
    assert end == "no other publisher of /clock any more"


def test_a_node_that_makes_no_clock_leaves_it_to_others_without_a_word(monkeypatch):
    network = Network(monkeypatch, (FIRST, SECOND), ("/left/head_pose", "/right/head_pose"))
    network.makes_clock = False
    network.strangers = ["simulator"]
    network.run(10)
    assert [log.lines for log in network.logs] == [[], []]


def test_of_two_nodes_with_the_same_topics_the_later_one_waits_until_the_other_has_gone(monkeypatch):
    network = Network(monkeypatch, (SECOND, FIRST), ("/head_pose", "/head_pose"))
    network.run(3)
    later, earlier = network.nodes
    assert later.holding == "waiting until /1 has gone" and not earlier.holding
    errors = [[text for level, text in log.lines if level == "error"] for log in network.logs]
    (told,) = errors[0]
    assert "process 7" in told and "this node waits" in told
    (told,) = errors[1]
    assert "/0 (host a, process 8, started 2026-01-01T00:00:01)" in told
    network.present = [0]
    network.run(4)
    assert later.holding
    network.run(2)
    assert not later.holding
    assert ("info", "no other node publishes /head_pose any more") in network.logs[0].lines


def test_a_node_ignores_itself_and_statuses_of_other_kinds(monkeypatch):
    network = Network(monkeypatch, [SECOND], ["/head_pose"])
    network.nodes[0].receive("/camera", {"swimmer": "/head_pose", "started": "a"})
    assert network.run(3) == [0] and not network.nodes[0].holding and not network.logs[0].lines
