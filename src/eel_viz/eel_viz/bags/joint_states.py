# SPDX-License-Identifier: Apache-2.0
"""Joint angles in a bag: the messages sensor_msgs/JointState of a topic, as rows."""

import os

import numpy as np
from eel_base.wording import shown

from eel_viz.bags.bag import Bag

KIND = "sensor_msgs/msg/JointState"


def joint_states(path: str | os.PathLike[str], topic: str | None = None) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Time (N,) [s], angles (N, n) [rad] and names of the joints in the bag at `path`.

    topic: None: the only one of this type. Joints stand in the order of the first message; messages that lack one are
    left out. Time is that of the header, or of reception where no header has one. `ValueError` in one line if there is
    no such topic.
    """
    with Bag(path) as bag:
        there = sorted(name for name, about in bag.topics.items() if about.type == KIND)
        chosen = there if topic is None else [name for name in there if name == f"/{topic.lstrip('/')}"]
        if len(chosen) != 1:
            what = "several topics, choose one" if len(chosen) > 1 else "no such topic"
            raise ValueError(f"bag {shown(str(path))} has {what} of {KIND}; it has: {', '.join(there) or 'none'}")
        names: list[str] = []
        stamps, received, rows = [], [], []
        message: object
        for _, at, message in bag.messages(*chosen):
            angles = dict(zip(getattr(message, "name"), getattr(message, "position"), strict=False))  # noqa: B009
            names = names or list(angles)
            if set(names) <= set(angles):
                stamp = message.header.stamp  # type: ignore[attr-defined]
                stamps.append(stamp.sec + 1e-9 * stamp.nanosec)
                received.append(1e-9 * at)
                rows.append([float(angles[name]) for name in names])
    if not rows:
        raise ValueError(f"bag {shown(str(path))} has no message with joints on {chosen[0]}")
    return np.array(stamps if any(stamps) else received), np.array(rows), names
