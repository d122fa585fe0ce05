# SPDX-License-Identifier: Apache-2.0
"""Decides what this node publishes when other nodes publish the same: the swimmer's topics, and /clock.

Each dynamics node gives its identity in /diagnostics: topic, start, host, process. So all nodes decide alike once they
have received each other's identity: the earliest start publishes. Of two swimmers with the same topics the later one
waits until the earlier one has gone. Of two sources of /clock the later one stops publishing it. Any other publisher of
/clock, such as a bag player, has precedence.
A warning alone would be shorter. But two swims on one topic, or two times on /clock, corrupt what every subscriber
computes (test_namespaces.py and test_node_flow.py show both).
"""

import os
import socket
import time
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import NamedTuple

from eel_common.ros.loop.diagnostics import ERROR, Report
from eel_common.ros.serving import ServedNode

GONE = 5.0  # s without diagnostics, sent once a second: the node counts as gone
STRANGE = 3.0  # s without diagnostics: a publisher of /clock counts as a foreign node
HINT = "this node does not, and keeps a time of its own (with follow_clock:=true it would follow /clock)"


class Identity(NamedTuple):
    """A dynamics node. They compare by start time: the lesser began first."""

    started: str  # UTC, ISO 8601
    host: str
    process: str

    @staticmethod
    def own() -> "Identity":
        """The identity of this process, started now."""
        return Identity(datetime.now(UTC).isoformat(), socket.gethostname(), str(os.getpid()))


class OtherNode(NamedTuple):
    """The last status of another dynamics node."""

    name: str
    topic: str  # its head_pose
    makes_clock: bool
    seen: float  # s, steady clock


class OtherNodes:
    """Compares this node, which publishes the `topic`, with other nodes on the network.

    Attributes:
        holding: the reason, as text, why this node must wait; empty if it need not.
        clock_is_free: whether no other node owns /clock.
    """

    def __init__(self, node: ServedNode, topic: str, own: Identity, report: Report) -> None:
        self._node, self._topic, self._own, self._report = node, topic, own, report
        self._others: dict[Identity, OtherNode] = {}
        self._strangers: dict[str, float] = {}  # foreign publishers of /clock: time first seen [s, steady clock]
        self.holding, self.clock_is_free = "", True

    def values(self, makes_clock: bool) -> dict[str, str]:
        """The identity for /diagnostics."""
        return {"swimmer": self._topic, "makes_clock": str(makes_clock), **self._own._asdict()}

    def receive(self, name: str, values: Mapping[str, str]) -> None:
        """Take a status from /diagnostics: the node's `name`, and its values."""
        if "swimmer" in values and all(field in values for field in Identity._fields):
            identity = Identity(*(values[field] for field in Identity._fields))
            if identity != self._own:
                makes_clock = values.get("makes_clock") == str(True)
                self._others[identity] = OtherNode(name, values["swimmer"], makes_clock, time.monotonic())

    def look(self, makes_clock: bool) -> None:
        """Decide again; call this a few times a second. `makes_clock`: whether this node is to publish /clock."""
        now = time.monotonic()
        self._others = {each: other for each, other in self._others.items() if now - other.seen < GONE}
        self._look_for_swimmers()
        self._look_for_clocks(makes_clock, now)

    def _look_for_swimmers(self) -> None:
        alike = [identity for identity, other in self._others.items() if other.topic == self._topic]
        first = min((self._own, *alike))
        self.holding = f"waiting until {self._others[first].name} has gone" if first != self._own else ""
        if self.holding:
            text = f"{self._described(first)} publishes {self._topic} already: this node waits until it has gone"
            self._report.begin("swimmer", text, ERROR)
        elif alike:
            text = f"{self._described(min(alike))} is to publish {self._topic} too: it waits until this node has gone"
            self._report.begin("swimmer", text, ERROR)
        else:
            self._report.end("swimmer", f"no other node publishes {self._topic} any more")

    def _look_for_clocks(self, makes_clock: bool, now: float) -> None:
        infos = self._node.get_publishers_info_by_topic("/clock")
        known = {self._node.get_fully_qualified_name(), *(other.name for other in self._others.values())}
        names = {f"{info.node_namespace.rstrip('/')}/{info.node_name}" for info in infos} - known
        self._strangers = {name: self._strangers.get(name, now) for name in names if "UNKNOWN" not in name}
        owners = [name for name, since in self._strangers.items() if now - since > STRANGE]
        owners += [other.name for each, other in self._others.items() if other.makes_clock and each < self._own]
        self.clock_is_free = not owners
        if makes_clock and owners:
            self._report.begin("clock", f"/clock is published by {', '.join(sorted(owners))} already: {HINT}")
        else:
            self._report.end("clock", "" if owners else "no other publisher of /clock any more")

    def _described(self, identity: Identity) -> str:
        host, process, started = identity.host, identity.process, identity.started
        return f"{self._others[identity].name} (host {host}, process {process}, started {started})"
