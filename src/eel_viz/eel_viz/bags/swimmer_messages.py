# SPDX-License-Identifier: Apache-2.0
"""The messages of one swimmer in a bag, and the joint angles in a bag. The library uses them too."""

import os
import warnings
from collections.abc import Collection, Iterator
from typing import Any

import numpy as np
from eel_common.topics import DIAGNOSTICS, GLOBAL, OWN, SAMPLED
from eel_common.wording import shown

from eel_viz.bags.bag import Bag
from eel_viz.bags.joint_signs import JointSigns
from eel_viz.recording.destination import LogFunction
from eel_viz.recording.dispatcher import READERS

JOINTS = "sensor_msgs/msg/JointState"


class SwimmerMessages:
    """The messages of one swimmer in `bag`, as pairs of topic (without namespace) and message.

    namespace: the swimmer's; None: that of the only swimmer. further: topics in addition to the shown ones. turned: for
    an older bag, as in `JointSigns`. `ValueError` if there is no swimmer, or more than one.
    """

    def __init__(
        self,
        bag: Bag,
        namespace: str | None,
        log_warning: LogFunction,
        further: tuple[str, ...] = (),
        turned: Collection[str] | None = None,
    ) -> None:
        self._bag, self._log_warning = bag, log_warning
        self._reported: set[str] = set()  # topics with messages that cannot be read
        self.namespace = self._found(namespace)
        self._topics: dict[str, str] = {}
        for name in (*READERS, *further):
            topic = DIAGNOSTICS if name == "diagnostics" else f"{self.namespace}/{name}"
            there, kind = bag.topics.get(topic), OWN.get(name) or GLOBAL[topic]
            if there is not None and there.type == kind:
                self._topics[topic] = name
            elif there is not None:
                log_warning(f"{topic} is left out: it is {there.type}, not {kind}")
        self._signs = JointSigns(bag, self.namespace, log_warning, turned)

    def has_several_publishers(self, name: str) -> bool:
        """Whether the topic `name` has several publishers in the bag."""
        return any(self._bag.topics[topic].publishers > 1 for topic, each in self._topics.items() if each == name)

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        """Yield topic and message in the recorded order, but the body first, as it holds at all times."""
        body = f"{self.namespace}/body"
        first = next((message for _, _, message in self._bag.messages(body)), None) if body in self._topics else None
        if first is not None:
            yield "body", first
        for topic, _, message in self._bag.messages(*self._topics, unreadable=self._leave_out):
            if topic == body and first is not None:
                first = None
            else:
                yield self._topics[topic], self._signs.turn(self._topics[topic], message)

    def _leave_out(self, topic: str, why: str) -> None:
        if topic not in self._reported:
            self._reported.add(topic)
            self._log_warning(f"{topic}: {why}: left out, and those like it")

    def _found(self, namespace: str | None) -> str:
        spaces = sorted(
            {
                topic[: -len(name) - 1]
                for topic, about in self._bag.topics.items()
                for name in SAMPLED
                if name in READERS and topic.endswith(f"/{name}") and about.type == OWN[name]
            }
        )
        named = ", ".join(space or "/" for space in spaces)
        if namespace is not None:
            wanted = f"/{namespace.strip('/')}".rstrip("/")
            if wanted not in spaces:
                raise ValueError(f"no swimmer in namespace {shown(namespace)} of the bag; there is: {named or 'none'}")
            return wanted
        if len(spaces) > 1:
            raise ValueError(f"the bag has swimmers in several namespaces, choose one with --namespace: {named}")
        if not spaces:
            topics = ", ".join(sorted(self._bag.topics)) or "none at all"
            raise ValueError(f"the bag has no topic of a swimmer; its topics: {topics}")
        return spaces[0]


def swimmer_messages(
    path: str | os.PathLike[str], namespace: str | None = None, turned: Collection[str] | None = None
) -> Iterator[tuple[str, Any]]:
    """Yield topic and message of the swimmer in the bag at `path`, as `SwimmerMessages` does.

    `ValueError` in one line if it cannot be read.
    """
    with Bag(path) as bag:
        yield from SwimmerMessages(bag, namespace, _warn, ("fin_states",), turned)


def _warn(text: str) -> None:
    warnings.warn(text, stacklevel=4)


def joint_states(path: str | os.PathLike[str], topic: str | None = None) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Time (N,) [s], angles (N, n) [rad] and names of the joints in the bag at `path`.

    topic: None: the only one of this type. Joints have the order of the first message; messages that lack one are left
    out. Time is the header's, or the time of reception if no header has one. `ValueError` in one line if there is no
    such topic.
    """
    with Bag(path) as bag:
        there = sorted(name for name, about in bag.topics.items() if about.type == JOINTS)
        chosen = there if topic is None else [name for name in there if name == f"/{topic.lstrip('/')}"]
        if len(chosen) != 1:
            what = "several topics, choose one" if len(chosen) > 1 else "no such topic"
            raise ValueError(f"bag {shown(str(path))} has {what} of {JOINTS}; it has: {', '.join(there) or 'none'}")
        names: list[str] = []
        namespace, _, last = chosen[0].rpartition("/")
        signs = JointSigns(bag, namespace, _warn) if last == "joint_states" else None
        stamps, received, rows = [], [], []
        message: Any
        for _, at, message in bag.messages(*chosen):
            message = message if signs is None else signs.turn(last, message)
            angles = dict(zip(message.name, message.position, strict=False))
            names = names or list(angles)
            if set(names) <= set(angles):
                stamp = message.header.stamp
                stamps.append(stamp.sec + 1e-9 * stamp.nanosec)
                received.append(1e-9 * at)
                rows.append([float(angles[name]) for name in names])
    if not rows:
        raise ValueError(f"bag {shown(str(path))} has no message with joints on {chosen[0]}")
    return np.array(stamps if any(stamps) else received), np.array(rows), names
