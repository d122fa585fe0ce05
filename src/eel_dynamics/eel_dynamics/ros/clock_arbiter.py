"""Whether this node may publish /clock: one publisher on the network, and the one that was there first.

Each publisher knows the others by their identifiers alone, and learns of them up to some seconds late. So that two
nodes of this kind never both stay and never both leave, each gives the other time to leave before it leaves itself: a
node that started lately gives little, one that has been publishing for long gives more, and of two alike the one with
the greater identifier goes first. A publisher of another kind never leaves; this node does when that time is over.
"""

import time

YOUNG = 4.0  # s: discovery of an older publisher takes no longer than this
GRACE_YOUNG = (0.0, 3.0)  # s: greater identifier, smaller identifier
GRACE_OLD = (8.0, 12.0)


class ClockArbiter:
    """The right to publish, judged from the identifiers of all publishers of /clock."""

    def __init__(self):
        self.publishing = False
        self._since = 0.0  # s, steady clock: when this node began to publish
        self._met = None  # s: when it first saw another
        self._grace = 0.0  # s: time it gives the other

    def judge(self, now: float, own: tuple, others: set) -> bool:
        """Whether to publish at `now` [s, steady clock]; `own` identifier (empty while unknown), `others`: the rest."""
        if not self.publishing:
            if not others:
                self.publishing, self._since, self._met = True, now, None
        elif not others:
            self._met = None
        else:
            if self._met is None:
                self._met = now
                grace = GRACE_YOUNG if now - self._since < YOUNG else GRACE_OLD
                self._grace = grace[0] if own > min(others) else grace[1]
            self.publishing = now - self._met < self._grace
        return self.publishing


class ClockWatch:
    """Looks who publishes /clock, and has `offer(bool)` called when this node is to begin or to end.

    node: get_publishers_info_by_topic, get_name, get_namespace.
    """

    def __init__(self, node, offer, report):
        self._node, self._offer, self._report = node, offer, report
        self._arbiter = ClockArbiter()
        self._offered = False
        self._own = ()
        self._strangers = set()

    def look(self, wanted: bool):
        """To be called a few times a second; `wanted`: the parameter."""
        infos = self._node.get_publishers_info_by_topic("/clock")
        heard = {tuple(info.endpoint_gid): (info.node_namespace, info.node_name) for info in infos}
        if not self._offered:
            self._own, self._strangers = (), set(heard)
        elif self._own not in heard:
            name = (self._node.get_namespace(), self._node.get_name())
            self._own = min((gid for gid in heard if heard[gid] == name and gid not in self._strangers), default=())
        others = {gid: name for gid, name in heard.items() if gid != self._own}
        allowed = wanted and self._arbiter.judge(time.monotonic(), self._own, set(others))
        if not wanted:
            self._arbiter = ClockArbiter()
        if wanted and others:
            names = ", ".join(sorted(_full_name(*each) for each in others.values()))
            state = "this node does not" if not allowed else "one of the two has to go"
            self._report.begin("clock", f"/clock is published by {names} already: {state}")
        else:
            self._report.end("clock", "no other publisher of /clock any more")
        if allowed != self._offered:
            self._offered = allowed
            self._offer(allowed)


def _full_name(namespace: str, name: str) -> str:
    """A node's full name; of a node just discovered the publisher is known before the name is."""
    return "a node just discovered" if "UNKNOWN" in name else f"{namespace.rstrip('/')}/{name}"
