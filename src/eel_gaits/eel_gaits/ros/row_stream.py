# SPDX-License-Identifier: Apache-2.0
"""Streams the rows of a law as `eel_msgs/CurvatureSamples`, some time ahead of the simulation."""

from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from eel_ros.qos import keep_all

from eel_gaits.ros.messages import samples_to_message
from eel_gaits.sources.sampled_law import SampledLaw
from eel_msgs.msg import CurvatureSamples

AHEAD = 2.0  # s of simulation time by which rows are sent ahead
BRIDGE = 1.0  # s of simulation time from the last row of a motion to the first of the next
MOST_ROWS = 500  # sent at once, so that the node hears calls and signals; the others follow with the next look
LEAD = 0.1  # s of simulation time, from the present to the first row of a simulation that already runs


class RowStream:
    """The stream of a `node` on the topic `curvature_samples`. Nothing is on the network until it begins.

    frame: of the messages. A subscriber that comes later, and a simulation that was reset, get the rows from the
    present on.
    """

    def __init__(self, node, frame: str):
        self._node, self._frame = node, frame
        self._publisher: Any = None
        self._law: Any = None  # a SampledLaw while it is streamed
        self._origin, self._next, self._listeners = 0.0, 0, 0

    @property
    def topic_name(self) -> str:
        """The topic, with its namespace."""
        return self._publisher.topic_name

    @property
    def running(self) -> bool:
        """Whether a law is streamed."""
        return self._law is not None

    @property
    def next_stamp(self) -> Time | None:
        """The simulation time at which another motion can begin after the rows that have been sent; None where there
        are none. Between the last row and the first of the other motion the body follows one quintic."""
        if self._law is None or not self._next:
            return None
        seconds, nanoseconds = divmod(round(1e9 * (self._time_of(self._next - 1) + BRIDGE)), 1_000_000_000)
        return Time(sec=seconds, nanosec=nanoseconds)

    def follow(self, law: SampledLaw, origin: float):
        """Stream `law`, whose own t = 0 lies at the simulation time `origin` [s]."""
        if self._publisher is None:
            self._publisher = self._node.create_publisher(CurvatureSamples, "curvature_samples", keep_all())
        self._law = law.with_fewer_points()
        self.begin_again(origin)

    def stop(self):
        """Send nothing more. What has been sent stays with the simulation, until a law takes over."""
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
        self._publisher = self._law = None

    def begin_again(self, origin: float):
        """Send the rows again, from the present on. origin [s]: simulation time of the law's own t = 0."""
        self._origin, self._next, self._listeners = origin, 0, 0

    def extend(self, now: float):
        """Send the rows up to 2 s after `now` [s of simulation time], to whoever is there."""
        if self._law is None:
            return
        listeners = self._publisher.get_subscription_count()
        if listeners > self._listeners:  # a new one has had none of the rows
            first = now - self._origin + (LEAD if now > 0.0 else 0.0)
            self._next = int(np.searchsorted(self._law.time, first - 1e-9))
        self._listeners = listeners
        if not listeners:
            return
        passed, last = np.searchsorted(self._law.time, (now - self._origin, now - self._origin + AHEAD)).tolist()
        self._next = max(self._next, passed - 1)  # time has gone beyond those before
        last = min(last, self._next + MOST_ROWS)
        for row in range(self._next, last):
            rows = self._law.values[row].reshape(6, -1)
            self._publisher.publish(samples_to_message(self._time_of(row), self._law.x, rows, self._frame))
        self._next = max(self._next, last)

    def _time_of(self, row: int) -> float:
        return self._origin + float(self._law.time[row])
