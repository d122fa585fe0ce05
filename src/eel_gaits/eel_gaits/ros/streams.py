# SPDX-License-Identifier: Apache-2.0
"""Streams of `eel_msgs/CurvatureSamples`, ahead of the simulation: a chain of oscillators, or the rows of a law."""

from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from eel_common.ros.headers import stamp_of
from eel_common.ros.qos import keep_all

from eel_gaits.gaits.cpg import Oscillation, Oscillators
from eel_gaits.ros.messages import samples_to_message
from eel_gaits.sources.sampled_law import SampledLaw
from eel_msgs.msg import CurvatureSamples

CHAIN_AHEAD = 0.5  # s of simulation time, from the present to the oscillators' last sample
ROWS_AHEAD = 2.0  # s of simulation time the lead of the rows
LEAD = 0.1  # s, from the present to the first sample, for a running simulation
LONGEST_GAP = 2.0  # s: if the simulation is further ahead, the oscillators restart
BRIDGE = 1.0  # s of simulation time between the last row of a motion and the first of the next
MOST_SAMPLES = 500  # sent at a time, so that the node answers calls and signals in between


class SampleStream:
    """A stream of a `node` on the topic `curvature_samples`, in this `frame`. The publisher is created when it
    begins."""

    def __init__(self, node: Any, frame: str) -> None:
        self._node, self._frame = node, frame
        self._publisher: Any = None
        self._listeners = 0

    @property
    def running(self) -> bool:
        """Whether something is streamed."""
        return self._publisher is not None

    @property
    def topic_name(self) -> str:
        """The topic, with its namespace."""
        return str(self._publisher.topic_name)

    def stop(self) -> None:
        """Stop sending. A simulation keeps the samples sent, until a law takes over."""
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
            self._publisher = None

    def _begin(self) -> None:
        if self._publisher is None:
            self._publisher = self._node.create_publisher(CurvatureSamples, "curvature_samples", keep_all())

    def _has_new_listeners(self) -> bool:
        """Whether subscribers have joined since the last call."""
        before, self._listeners = self._listeners, self._publisher.get_subscription_count()
        return self._listeners > before

    def _send(self, time: float, x: np.ndarray, rows: np.ndarray) -> None:
        self._publisher.publish(samples_to_message(time, x, rows, self._frame))


class OscillatorStream(SampleStream):
    """The stream of a chain of oscillators."""

    def __init__(self, node: Any, frame: str) -> None:
        super().__init__(node, frame)
        self._chain: Any = None  # the `Oscillators`, None before they begin
        self._start, self._count = 0.0, 0  # s; samples since then

    def follow(self, numbers: Oscillation, now: float) -> None:
        """Begin at `now` [s of simulation time], or change to the new `numbers` after the samples already sent."""
        if not self.running or numbers.length != self._chain.numbers.length:
            self._begin()
            self.restart(numbers, now)
        else:
            self._start, self._count = self._chain.time, 0  # the sample period may have changed
            self._chain.numbers = numbers
        self.extend(now)

    def restart(self, numbers: Oscillation, now: float) -> None:
        """Begin from rest."""
        self._start, self._count = (now + LEAD if now > 0.0 else 0.0), 0
        self._chain = Oscillators(numbers, self._start)
        self._send_present()

    def extend(self, now: float) -> None:
        """Send the samples up to 0.5 s after `now` [s of simulation time]."""
        if not self.running:
            return
        if self._has_new_listeners() and now <= self._start:  # the new subscriber missed the first samples
            self.restart(self._chain.numbers, now)
        if now - self._chain.time > LONGEST_GAP:
            text = f"time goes on at {now:.9g} s, after samples up to {self._chain.time:.9g} s: a new start"
            self._node.get_logger().warning(text, throttle_duration_sec=1.0)
            self.restart(self._chain.numbers, now)
        elif self._chain.time < now:  # the simulation has overtaken it
            self._start, self._count = now + LEAD, 0
            self._advance()
        for _ in range(MOST_SAMPLES):
            if self._chain.time >= now + CHAIN_AHEAD:
                return
            self._count += 1
            self._advance()

    def _advance(self) -> None:
        self._chain.advance(self._start + self._count * self._chain.numbers.sample_period)
        self._send_present()

    def _send_present(self) -> None:
        chain = self._chain
        self._send(chain.time, chain.x, np.concatenate((np.zeros((3, len(chain.x))), chain.curvature())))


class RowStream(SampleStream):
    """The stream of the rows of a law.

    A new subscriber, and a simulation after a reset, get the rows from the present on.
    """

    def __init__(self, node: Any, frame: str) -> None:
        super().__init__(node, frame)
        self._law: Any = None  # the `SampledLaw`, None before it begins
        self._origin, self._next = 0.0, 0  # s; index of the next row

    @property
    def next_stamp(self) -> Time | None:
        """The simulation time at which another motion can begin after the rows sent; None if there are none. Between
        the last row and the first of the other motion the body follows one quintic."""
        return stamp_of(self._time_of(self._next - 1) + BRIDGE) if self.running and self._next else None

    def follow(self, law: SampledLaw, origin: float) -> None:
        """Stream `law`, whose own t = 0 lies at the simulation time `origin` [s]."""
        self._begin()
        self._law = law.with_fewer_points()
        self.begin_again(origin)

    def begin_again(self, origin: float) -> None:
        """Send the rows again, from the present on. origin [s]: simulation time of the law's own t = 0."""
        self._origin, self._next, self._listeners = origin, 0, 0

    def extend(self, now: float) -> None:
        """Send the rows up to 2 s after `now` [s of simulation time]."""
        if not self.running:
            return
        if self._has_new_listeners():  # a new subscriber has none of the rows
            first = now - self._origin + (LEAD if now > 0.0 else 0.0)
            self._next = int(np.searchsorted(self._law.time, first - 1e-9))
        if not self._listeners:
            return
        span = now - self._origin, now - self._origin + ROWS_AHEAD
        passed, last = np.searchsorted(self._law.time, span).tolist()
        self._next = max(self._next, passed - 1)  # rows in the past
        last = min(last, self._next + MOST_SAMPLES)
        for row in range(self._next, last):
            self._send(self._time_of(row), self._law.x, self._law.values[row].reshape(6, -1))
        self._next = max(self._next, last)

    def _time_of(self, row: int) -> float:
        return self._origin + float(self._law.time[row])
