# SPDX-License-Identifier: Apache-2.0
"""Streams the curvature of a chain of oscillators as `eel_msgs/CurvatureSamples`, ahead of the simulation."""

from typing import Any

import numpy as np
from eel_ros.frames import frame_in
from eel_ros.qos import keep_all

from eel_gaits.gaits.cpg import Oscillators
from eel_gaits.ros.messages import FRAME, samples_to_message
from eel_msgs.msg import CurvatureSamples

AHEAD = 0.5  # s of simulation time, from the present to the last sample
LEAD = 0.1  # s, from the present to the first one of a simulation that already runs
LONGEST_GAP = 2.0  # s by which the simulation may be ahead; beyond, the oscillators begin anew
MOST_SAMPLES = 500  # sent at once, so that the node hears calls and signals; the others follow with the next look


class SampleStream:
    """The stream of a `node` on the topic `curvature_samples`. Nothing is on the network until it begins."""

    def __init__(self, node):
        self._node = node
        self._publisher: Any = None
        self._chain: Any = None  # Oscillators while they are streamed
        self._count = 0  # samples since the start, which lies at `_start`
        self._start, self._listeners = 0.0, 0

    @property
    def running(self) -> bool:
        """Whether oscillators are streamed."""
        return self._chain is not None

    def follow(self, numbers, now):
        """Begin at `now` [s of simulation time], or change to the new `numbers` after the samples already sent."""
        if self._publisher is None:
            self._publisher = self._node.create_publisher(CurvatureSamples, "curvature_samples", keep_all())
        if self._chain is None or numbers.length != self._chain.numbers.length:
            self.restart(numbers, now)
        else:
            self._start, self._count = self._chain.time, 0  # the sample period may be another
            self._chain.numbers = numbers
        self.extend(now)

    def restart(self, numbers, now):
        """Begin from rest."""
        self._start, self._count = (now + LEAD if now > 0.0 else 0.0), 0
        self._chain = Oscillators(numbers, self._start)
        self._publish()

    def stop(self):
        """Send nothing more."""
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
        self._publisher, self._chain = None, None

    def extend(self, now):
        """Send the samples up to 0.5 s after `now` [s of simulation time]."""
        if self._chain is None:
            return
        listeners = self._publisher.get_subscription_count()
        if listeners > self._listeners and now <= self._start:  # the new one has missed the first samples
            self.restart(self._chain.numbers, now)
        self._listeners = listeners
        period = self._chain.numbers.sample_period
        if now - self._chain.time > LONGEST_GAP:
            text = f"time goes on at {now:.9g} s, after samples up to {self._chain.time:.9g} s: a new start"
            self._node.get_logger().warning(text, throttle_duration_sec=1.0)
            self.restart(self._chain.numbers, now)
        elif self._chain.time < now:  # the simulation was faster
            self._start, self._count = now + LEAD, 0
            self._chain.advance(self._start)
            self._publish()
        for _ in range(MOST_SAMPLES):
            if self._chain.time >= now + AHEAD:
                return
            self._count += 1
            self._chain.advance(self._start + self._count * period)
            self._publish()

    def _publish(self):
        chain, frame = self._chain, frame_in(self._node.get_namespace(), FRAME)
        rows = np.concatenate((np.zeros((3, len(chain.x))), chain.curvature()))
        self._publisher.publish(samples_to_message(chain.time, chain.x, rows, frame))
