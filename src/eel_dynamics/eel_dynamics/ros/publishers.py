# SPDX-License-Identifier: Apache-2.0
"""Publishes the samples of a run on all topics with subscribers, paced or without loss.

In a paced run (real_time_factor > 0) the node never waits: a slow subscriber misses samples. In a run as fast as
possible, publishers are RELIABLE and KEEP_ALL: if the history is full, `publish` fails and is retried until the
subscriber has caught up, or is considered stuck. The topic then changes to a KEEP_LAST history, so that the run and the
other subscribers go on.

A new topic begins in eel_common/topics.py. If its quantities are costly to compute, it needs an entry in `PARTS`.
"""

import math
import time
from typing import Any

from eel_common.ros.loop.channel import Channel, WaitBudget
from eel_common.ros.loop.diagnostics import Report
from eel_common.ros.qos import latched
from eel_common.ros.serving import ServedNode
from rclpy.duration import Duration
from rclpy.impl.implementation_singleton import rclpy_implementation
from rosgraph_msgs.msg import Clock

from eel_dynamics.ros.declaration import Declaration
from eel_dynamics.ros.messages import SampleMessages, body_message
from eel_dynamics.ros.robot_description import RobotDescription
from eel_dynamics.ros.sensors import FRAMES, SensorMessages
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.simulation import Simulation
from eel_msgs.msg import BodyGeometry

RETRY = 0.002  # s between two attempts to publish, in which other threads can run
BODY_TIMEOUT = 1.0  # s: longest wait for the present subscribers to have the body before the first sample
END_TIMEOUT = 5.0  # s: longest wait for acknowledgements at the end of a paced run
LOSSLESS_END_TIMEOUT = 30.0  # s: the same if no sample may be lost: a slow subscriber then reads a full history
SLICE = 0.02  # s: longest wait for one topic before signals and callbacks are handled
QUIET_TIME = 1.0  # s without a change, after which the subscribers that some topics have are considered complete
MATCH_LIMIT = 5.0  # s: longest wait for the subscribers that exist to be matched
PARTS = {"wrench": ("internal_wrench", "joint_states", "swim_state"), "load": ("hydrodynamic_load",)}
# of Simulation.observe, and the topics that need them
NOT_AWAITED = "/tf", "joint_states", "motor_states", "swim_state"  # the run does not wait for subscribers of these


class Publishers:
    """All topics of samples of a `simulation`, its body, and /clock.

    Attributes:
        lossless: the run is as fast as possible, and no sample may be lost.
        sensors: SensorMessages.
        stopped: the run is over, and waits for nobody.
    """

    def __init__(self, node: ServedNode, simulation: Simulation, parameters: Declaration, report: Report) -> None:
        self._node, self._parameters, self._report = node, parameters, report
        self.lossless, self.stopped = parameters.values.real_time_factor == 0.0, False
        self._channels: dict[str, Channel] = {}
        self._clock: Channel | None = None
        self._body: Any = node.create_publisher(BodyGeometry, "body", latched(1))
        self._description = RobotDescription(node)
        self._present: tuple[dict[str, int], bool] = {}, True  # subscribers by topic, and whether /tf is published
        self._subscribed: tuple[str, ...] = ()  # topics with subscribers that are published
        self._parts: dict[str, bool] = {}  # the answer of `wanted_parts`
        self._wait_budget = WaitBudget()
        self._audience: tuple[list[int], list[int]] | None = None  # of each topic: subscribers matched, and known
        self._audience_since, self._waiting_since = 0.0, math.inf  # s, steady clock
        self._samples = 0  # published since the start of the run
        self.begin(simulation)

    def begin(self, simulation: Simulation) -> None:
        """Change to the topics of a new `simulation`, and publish its body."""
        values = self._parameters.values
        self._sample = SampleMessages(simulation, values)
        self.sensors = SensorMessages(self._parameters.sensors, simulation, values, self._sample)
        kinds = self._sample.kinds | self.sensors.kinds
        for name in [name for name in self._channels if name not in kinds]:
            self._channels.pop(name).close()
        for name, kind in kinds.items():
            if name not in self._channels:
                self._channels[name] = Channel(self._node, kind, "/tf" if name == FRAMES else name, self.lossless)
        self.publish_body(simulation)
        self._description.publish(simulation, values)

    def publish_body(self, simulation: Simulation) -> None:
        """Publish the geometry of the body of a `simulation`; late subscribers get it too."""
        self._body.publish(body_message(simulation, self._parameters.values.section_frame))

    def wait_until_body_received(self) -> None:
        """Wait until the present subscribers have received the body: they need it for the samples."""
        self._body.wait_for_all_acked(Duration(seconds=BODY_TIMEOUT))

    def wanted_parts(self) -> dict[str, bool]:
        """Which costly parts of the next snapshot have subscribers: the flags of `Simulation.observe`."""
        counts, shown = self.audience(), self._parameters.values.publish_tf
        if (counts, shown) != self._present:
            before, self._present = self._present[0], (counts, shown)
            heard = [name for name, count in counts.items() if count and name not in self.sensors.kinds]
            self._subscribed = tuple(name for name in heard if shown or name != "/tf")
            self._parts = {part: any(name in self._subscribed for name in topics) for part, topics in PARTS.items()}
            late = [name for name in self._subscribed if counts[name] > before.get(name, 0)]
            if late and self.lossless and self._samples > 1:
                self._report.note(
                    "late subscriber", f"a subscriber of {', '.join(late)} came late: it missed {self._samples} samples"
                )
        return self._parts

    def audience(self) -> dict[str, int]:
        """The number of subscribers of each topic."""
        return {name: channel.subscribers() for name, channel in self._channels.items()}

    def publish(self, snapshot: Snapshot, nanoseconds: int) -> None:
        """Publish one sample at simulation time `nanoseconds` [ns].

        Only topics that had subscribers at the last call of `wanted_parts` are published.
        """
        self._sample.set_time(nanoseconds)
        self._samples = self._samples + 1 if nanoseconds else 1
        for name in self._subscribed:
            self._send(self._channels[name], self._sample.fill(name, snapshot))
        for name, message in self.sensors.due(snapshot, nanoseconds, lambda name: self._channels[name].subscribers()):
            self._send(self._channels[name], message)

    def tick(self, nanoseconds: int) -> None:
        """Publish /clock, with simulation time `nanoseconds` [ns]."""
        if self._clock is not None and self._clock.subscribers():
            self._sample.set_time(nanoseconds)
            self._send(self._clock, self._sample.tick())

    def enable_clock(self, offered: bool) -> None:
        """Begin or stop publishing /clock."""
        if offered and self._clock is None:
            self._clock = Channel(self._node, Clock, "/clock", self.lossless)
        elif not offered and self._clock is not None:
            self._clock.close()
            self._clock = None

    def subscribers_complete(self, wanted: int, now: float) -> bool:
        """Whether every topic has `wanted` subscribers, or some topics have and no count has changed for a while.

        With 0 wanted: whether the subscribers on the network are matched, and none has come for a while; true after
        `MATCH_LIMIT`. now: time [s, steady clock].
        """
        own = [*self._channels.values()]
        if not wanted and self._clock is not None:
            own.append(self._clock)  # a node that follows it needs it from the start
        counts = [channel.subscribers() for channel in own]
        known = [] if wanted else [channel.count_known() for channel in own]
        if (counts, known) != self._audience:
            self._audience, self._audience_since = (counts, known), now
        quiet = now - self._audience_since > QUIET_TIME
        if wanted:
            left_out = *NOT_AWAITED, *self.sensors.kinds
            least = min(count for name, count in self.audience().items() if name not in left_out)
            return least >= wanted or (max(counts) >= wanted and quiet)
        self._waiting_since = min(self._waiting_since, now)
        matched = all(count >= there for count, there in zip(counts, known, strict=True))
        return (quiet and matched) or now - self._waiting_since > MATCH_LIMIT

    def all_received(self, others: list[Any], waited: float) -> bool:
        """Whether all messages are acknowledged, also those of the publishers `others`, `waited` [s] after the end.

        Also true, with a warning, once the longest wait is over: `END_TIMEOUT`, or `LOSSLESS_END_TIMEOUT` if no sample
        may be lost and no subscriber was stuck.
        """
        samples = [*self._channels.values(), *([self._clock] if self._clock is not None else [])]
        backlog = max(LOSSLESS_END_TIMEOUT, self._parameters.values.subscriber_timeout)
        waits = [(each.publisher, backlog if each.lossless else END_TIMEOUT) for each in samples if self.lossless]
        waits += [(publisher, END_TIMEOUT) for publisher in (self._body, *others)]
        late = [longest for publisher, longest in waits if not publisher.wait_for_all_acked(Duration(seconds=SLICE))]
        if late and waited >= max(late):
            self._report.event("end", f"some subscriber has not received everything within {waited:.2g} s")
        return not late or waited >= max(late)

    def _send(self, channel: Channel, message: bytes) -> None:
        start = None  # s: when the first attempt failed
        while not self.stopped:
            try:
                channel.publisher.publish(message)
            except rclpy_implementation.RCLError as error:
                if not channel.lossless:
                    self._report.event("publish " + channel.topic, f"{channel.topic} could not be published: {error}")
                    return
                now = time.monotonic()
                if start is None:
                    start = now
                    self._wait_budget.begin(now)
                if self._wait_budget.over(now, self._parameters.values.subscriber_timeout):
                    self._give_up(channel)
                    continue
                self._report.event(
                    "slow subscriber", f"waiting for a subscriber of {channel.topic}, whose history is full"
                )
                time.sleep(RETRY)
            else:
                if start is not None and channel.lossless:
                    self._wait_budget.renew()
                return

    def _give_up(self, channel: Channel) -> None:
        self._report.begin(
            "stuck " + channel.topic,
            f"a subscriber of {channel.topic} has been stuck for {self._parameters.values.subscriber_timeout:g} s: "
            "going on without it, it will miss samples",
        )
        channel.drop_oldest()
