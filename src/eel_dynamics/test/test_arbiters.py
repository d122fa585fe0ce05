# SPDX-License-Identifier: Apache-2.0
"""Who publishes /clock, and which of two nodes with the same topics goes on."""

from types import SimpleNamespace

import pytest
from eel_dynamics.ros import clock_arbiter
from eel_dynamics.ros.clock_arbiter import ClockArbiter, ClockMonitor
from eel_dynamics.ros.diagnostics import Report
from eel_dynamics.ros.swimmer_arbiter import Identity, SwimmerArbiter
from fake_log import Log


def race(first_age, own, other, leaves):
    """Who publishes in the end, of two that meet; `leaves`: whether the other follows the same rules."""
    ours, theirs = ClockArbiter(), ClockArbiter()
    now, ours_on, theirs_on = 0.0, ours.judge(0.0, (), set()), False
    while now < 40.0:
        now += 0.25
        if now == first_age:
            theirs_on = True if not leaves else theirs.judge(now, (), set())
        seen = now > first_age + 1.0  # discovery takes a second
        ours_on_before = ours_on
        ours_on = ours.judge(now, own if ours_on else (), {other} if theirs_on and seen else set())
        if leaves and now > first_age:
            theirs_on = theirs.judge(now, other if theirs_on else (), {own} if ours_on_before and seen else set())
    return ours_on, theirs_on


@pytest.mark.parametrize("own", [(1,), (3,)])
def test_the_older_of_two_keeps_the_clock(own):
    assert race(20.0, own, (2,), leaves=True) == (True, False)


@pytest.mark.parametrize("own", [(1,), (3,)])
def test_of_two_that_start_together_one_publishes(own):
    assert sorted(race(0.5, own, (2,), leaves=True)) == [False, True]


@pytest.mark.parametrize("own", [(1,), (3,)])
@pytest.mark.parametrize("age", [0.5, 20.0])
def test_a_publisher_that_never_leaves_gets_the_clock(own, age):
    assert race(age, own, (2,), leaves=False) == (False, True)


def test_the_clock_comes_back_when_the_other_is_gone():
    right = ClockArbiter()
    assert not right.judge(0.0, (), {(1,)})
    assert right.judge(1.0, (), set())


def test_a_node_that_stops_publishing_the_clock_logs_it_once(monkeypatch):
    now, publishers, log = [0.0], {}, Log()
    monkeypatch.setattr(clock_arbiter.time, "monotonic", lambda: now[0])
    node = SimpleNamespace(
        get_publishers_info_by_topic=lambda topic: list(publishers.values()),
        get_name=lambda: "dynamics",
        get_namespace=lambda: "/",
    )

    def publisher(number, name):
        return SimpleNamespace(endpoint_gid=(number,), node_namespace="/", node_name=name)

    def offer(publishing):
        publishers.pop(2, None)
        if publishing:
            publishers[2] = publisher(2, "dynamics")

    monitor = ClockMonitor(node, offer, Report(log, lambda: now[0]))
    monitor.look(True)
    publishers[1] = publisher(1, "simulator")
    for _ in range(100):
        now[0] += 0.25
        monitor.look(True)
    stops = [entry for entry in log.lines if "stops" in entry[1]]
    assert stops == [("warning", "this node stops publishing /clock, which /simulator publishes too")]
    assert 2 not in publishers


class Network:
    """Arbiters that get each other's diagnostics, once a second."""

    def __init__(self, *identities):
        self.time = 0.0
        self.logs = [Log() for _ in identities]
        self.held = [[] for _ in identities]
        self.arbiters = [
            SwimmerArbiter(each, "/head_pose", Report(log), held.append, lambda: self.time)
            for each, log, held in zip(identities, self.logs, self.held, strict=True)
        ]

    def run(self, seconds, present):
        for _ in range(seconds):
            self.time += 1.0
            for sender in present:
                for each in self.arbiters:
                    each.receive("/dynamics", self.arbiters[sender].values())
            for each in self.arbiters:
                each.look()


def test_of_two_nodes_with_the_same_topics_the_later_one_waits_until_the_other_has_gone():
    first, second = Identity("2026-01-01T00:00:00", "a", "7"), Identity("2026-01-01T00:00:01", "a", "8")
    network = Network(second, first)
    network.run(3, present=(0, 1))
    later, earlier = network.arbiters
    assert later.waits and not earlier.waits
    assert network.held == [["waiting until /dynamics has gone"], []]
    ((level, text),) = network.logs[0].lines
    assert level == "error" and "process 7" in text and "this node waits" in text
    ((level, text),) = network.logs[1].lines
    assert level == "error" and "/dynamics (host a, process 8, started 2026-01-01T00:00:01)" in text
    network.run(4, present=(0,))
    assert later.waits
    network.run(2, present=(0,))
    assert not later.waits and network.held == [["waiting until /dynamics has gone", ""], []]
    assert network.logs[0].lines[1:] == [("info", "no other node publishes /head_pose any more")]


def test_a_node_ignores_itself_other_swimmers_and_statuses_of_other_kinds():
    arbiter = SwimmerArbiter(Identity("b", "b", "2"), "/head_pose", Report(Log()), lambda reason: None)
    arbiter.receive("/dynamics", arbiter.values())
    arbiter.receive("/eel2/dynamics", {"swimmer": "/eel2/head_pose", "started": "a", "host": "a", "process": "1"})
    arbiter.receive("/camera", {"swimmer": "/head_pose", "started": "a"})
    arbiter.look()
    assert not arbiter.waits
