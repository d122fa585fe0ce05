# SPDX-License-Identifier: Apache-2.0
"""Decides whether this node may publish /clock: only one publisher may, and the first one stays.

A publisher knows the others by their identifiers alone, and discovers them up to some seconds late. Two nodes of this
kind must not both stop and must not both go on. So each waits for a grace period before it stops: a node that has just
begun waits briefly, one that has published for long waits longer, and of two alike the one with the greater identifier
stops first. A publisher of another kind never stops; this node does after its grace period.
"""

import time

YOUNG = 4.0  # s: discovery of an older publisher takes less
GRACE_YOUNG = (0.0, 3.0)  # s: greater identifier, smaller identifier
GRACE_OLD = (8.0, 12.0)
HINT = ", and keeps a time of its own (with follow_clock:=true it would follow /clock)"


class ClockArbiter:
    """Decides from the identifiers of all publishers of /clock; `publishing`: the last decision."""

    def __init__(self):
        self.publishing = False
        self._since = 0.0  # s, steady clock: when this node began to publish
        self._conflict_since = None  # s: when this node first saw another publisher
        self._grace = 0.0  # s: grace period before this node stops

    def judge(self, now: float, own: tuple, others: set) -> bool:
        """Whether to publish at `now` [s, steady clock]; `own` identifier (empty while unknown), `others`: the rest."""
        if not self.publishing:
            if not others:
                self.publishing, self._since, self._conflict_since = True, now, None
        elif not others:
            self._conflict_since = None
        else:
            if self._conflict_since is None:
                self._conflict_since = now
                grace = GRACE_YOUNG if now - self._since < YOUNG else GRACE_OLD
                self._grace = grace[0] if own > min(others) else grace[1]
            self.publishing = now - self._conflict_since < self._grace
        return self.publishing


class ClockMonitor:
    """Looks up the publishers of /clock, and calls `offer(bool)` when this node is to begin or to stop publishing.

    node: get_publishers_info_by_topic, get_name, get_namespace.
    """

    def __init__(self, node, offer, report):
        self._node, self._offer, self._report = node, offer, report
        self._arbiter = ClockArbiter()
        self._offered = False
        self._own = ()
        self._foreign = set()

    def look(self, wanted: bool):
        """Look the publishers up; call this a few times a second. `wanted`: the value of the parameter `clock`."""
        infos = self._node.get_publishers_info_by_topic("/clock")
        publishers = {tuple(info.endpoint_gid): (info.node_namespace, info.node_name) for info in infos}
        if not self._offered:
            self._own, self._foreign = (), set(publishers)
        elif self._own not in publishers:
            name = (self._node.get_namespace(), self._node.get_name())
            self._own = min(
                (gid for gid in publishers if publishers[gid] == name and gid not in self._foreign), default=()
            )
        others = {gid: name for gid, name in publishers.items() if gid != self._own}
        allowed = wanted and self._arbiter.judge(time.monotonic(), self._own, set(others))
        if not wanted:
            self._arbiter = ClockArbiter()
        names = ", ".join(sorted(self._called(*each) for each in others.values()))
        if wanted and others:
            state = f"this node does not{HINT}" if not allowed else "one of the two has to go"
            self._report.begin("clock", f"/clock is published by {names} already: {state}")
        else:
            self._report.end("clock", "" if others else "no other publisher of /clock any more")
        if allowed != self._offered:
            self._offered = allowed
            self._offer(allowed)
            if wanted and not allowed:
                self._report.event("clock stopped", f"this node stops publishing /clock, which {names} publishes too")

    def _called(self, namespace: str, name: str) -> str:
        """A node's full name; a publisher may be discovered before the name of its node."""
        if "UNKNOWN" in name:
            return "a node just discovered"
        another = (namespace, name) == (self._node.get_namespace(), self._node.get_name())
        return f"{'another ' if another else ''}{namespace.rstrip('/')}/{name}"
