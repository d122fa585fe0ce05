# SPDX-License-Identifier: Apache-2.0
"""Publishes the samples of a run on all topics with subscribers, paced or without loss.

In a paced run (real_time_factor > 0) the node never waits: a slow subscriber misses samples. In a run as fast as
possible, publishers are RELIABLE and KEEP_ALL: if the history is full, `publish` fails and is retried until the
subscriber has caught up, or is considered stuck. The topic then changes to a KEEP_LAST history, so that the run and the
other subscribers go on.
"""

import math
import time

LIVE_DEPTH = 100  # samples: history of a paced run
LONG_DEPTH = 5000  # samples: history after a subscriber got stuck, as long as the one that keeps all
RETRY = 0.002  # s between two attempts to publish, in which other threads can run
END_TIMEOUT = 5.0  # s: longest wait for acknowledgements at the end of a paced run
LOSSLESS_END_TIMEOUT = 30.0  # s: where no sample may be lost: time for a slow subscriber to read a full history
SLICE = 0.2  # s between two checks whether such a wait is interrupted
QUIET_TIME = 1.0  # s without a change, after which the subscribers that some topics have are considered complete
MATCH_LIMIT = 5.0  # s: longest wait for the subscribers that exist to be matched
COUNT_PERIOD = 0.1  # s of wall time between two counts of subscribers: a count costs as much as a short message
PARTS = {"wrench": ("internal_wrench", "joint_states", "swim_state"), "load": ("hydrodynamic_load",)}
# of Simulation.observe, and the topics that need them
NOT_AWAITED = ("/tf", "joint_states", "swim_state")  # topics that the run does not wait for subscribers of


class Channel:
    """One topic with its publisher, made by `create(message_type, topic, depth)`; depth None: KEEP_ALL."""

    def __init__(self, create, message_type, topic: str, lossless: bool):
        self.topic, self.message_type = topic, message_type
        self._create = create
        self.lossless = lossless
        self.publisher = create(message_type, topic, None if lossless else LIVE_DEPTH)

    def drop_oldest(self, destroy):
        """Change to a KEEP_LAST history, long enough for the subscribers that are not stuck."""
        destroy(self.publisher)
        self.lossless = False
        self.publisher = self._create(self.message_type, self.topic, LONG_DEPTH)


class Publishers:
    """All topics of samples, and /clock.

    sample: makes the messages (messages.Sample). create: see Channel; destroy(publisher).
    known(publisher): number of subscribers on the network that the publisher can match.
    received(publisher, seconds): waits until all messages are acknowledged; whether they are. publish_error: the
    exception of a failed publish. values(): the present DynamicsParameters. stopped(): whether the run is over.

    Attributes:
        lossless: the run is as fast as possible, and no sample may be lost.
    """

    def __init__(self, sample, *, create, destroy, known, received, publish_error, values, stopped, report):
        self._sample, self._create, self._destroy, self._publish_error = sample, create, destroy, publish_error
        self._known, self._received = known, received
        self._values, self._stopped, self._report = values, stopped, report
        self.lossless = values().real_time_factor == 0.0
        self._channels = {}
        self.change(sample)
        self._subscribed: tuple[str, ...] = ()  # topics with subscribers
        self._last_count = -math.inf  # s: when that was found
        self._counts = {}  # of subscribers by topic, at that time
        self._clock = None
        self._wait_budget = WaitBudget()
        self._subscriber_counts, self._counts_since, self._waiting_since = None, 0.0, None
        self._samples = 0  # published since the start of the run

    def change(self, sample):
        """Change to another maker of messages, and to its topics."""
        self._sample = sample
        for name in [name for name in self._channels if name not in sample.kinds]:
            self._destroy(self._channels.pop(name).publisher)
        for name, kind in sample.kinds.items():
            if name not in self._channels:
                self._channels[name] = Channel(self._create, kind, name, self.lossless)
        self._subscribed, self._last_count = (), -math.inf

    def _count_subscribers(self):
        """Find the topics that have subscribers. In a run as fast as possible, tell what a new one has missed."""
        self._last_count = time.monotonic()
        hidden = () if self._values().publish_tf else ("/tf",)
        before, self._counts = self._counts, dict(zip(self._channels, self.audience(), strict=True))
        self._subscribed = tuple(name for name, count in self._counts.items() if name not in hidden and count > 0)
        if self.lossless and self._samples > 1:
            late = [name for name in self._subscribed if self._counts[name] > before.get(name, 0)]
            if late:
                self._report.note(
                    "late subscriber", f"a subscriber of {', '.join(late)} came late: it missed {self._samples} samples"
                )

    def wanted_parts(self) -> dict[str, bool]:
        """Which costly parts of the next snapshot have subscribers: the flags of `Simulation.observe`."""
        if self.lossless or time.monotonic() - self._last_count >= COUNT_PERIOD:
            self._count_subscribers()
        return {part: any(name in self._subscribed for name in topics) for part, topics in PARTS.items()}

    def audience(self) -> tuple[int, ...]:
        """The number of subscribers of each topic."""
        return tuple(channel.publisher.get_subscription_count() for channel in self._channels.values())

    def publish(self, snapshot, nanoseconds: int):
        """Publish one sample at simulation time `nanoseconds` [ns].

        Only topics that had subscribers at the last call of `wanted_parts` are published.
        """
        self._sample.set_time(nanoseconds)
        self._samples = self._samples + 1 if nanoseconds else 1
        for name in self._subscribed:
            self._send(self._channels[name], self._sample.fill(name, snapshot))

    def tick(self, nanoseconds: int):
        """Publish /clock, with simulation time `nanoseconds` [ns]."""
        self._sample.set_time(nanoseconds)
        if self._clock is not None:
            self._send(self._clock, self._sample.tick())

    def enable_clock(self, offered: bool):
        """Begin or stop publishing /clock."""
        if offered and self._clock is None:
            self._clock = Channel(self._create, self._sample.clock, "/clock", self.lossless)
        elif not offered and self._clock is not None:
            self._destroy(self._clock.publisher)
            self._clock = None

    def subscribers_complete(self, wanted: int, now: float) -> bool:
        """Whether every topic has `wanted` subscribers, or some topics have and no count has changed for a while.

        With 0 wanted: whether the subscribers on the network are matched, and none has come for a while; true after
        `MATCH_LIMIT`. now: time [s, steady clock].
        """
        left_out = NOT_AWAITED if wanted else ()
        own = [channel.publisher for name, channel in self._channels.items() if name not in left_out]
        if not wanted and self._clock is not None:
            own.append(self._clock.publisher)  # who follows it needs it from the start
        counts = [publisher.get_subscription_count() for publisher in own]
        known = [] if wanted else [self._known(publisher) for publisher in own]
        if [counts, known] != self._subscriber_counts:
            self._subscriber_counts, self._counts_since = [counts, known], now
        quiet = now - self._counts_since > QUIET_TIME
        if wanted:
            return min(counts) >= wanted or (max(counts) >= wanted and quiet)
        self._waiting_since = self._waiting_since or now
        matched = all(count >= there for count, there in zip(counts, known, strict=True))
        return (quiet and matched) or now - self._waiting_since > MATCH_LIMIT

    def wait_until_received(self, others: list, interrupted, longest: float = math.inf) -> bool:
        """Wait until all messages are acknowledged, also those of the publishers `others`; whether they were.

        Waits for `END_TIMEOUT`, or for `LOSSLESS_END_TIMEOUT` where no sample may be lost and no subscriber was stuck;
        in any case at most `longest` [s], and until `interrupted()`.
        """
        clock = [self._clock] if self._clock is not None else []
        samples = [*self._channels.values(), *clock] if self.lossless else []
        whole = [channel.publisher for channel in samples if channel.lossless]
        rest = [channel.publisher for channel in samples if not channel.lossless] + others
        backlog = max(LOSSLESS_END_TIMEOUT, self._values().subscriber_timeout)
        all_samples = self._wait_for(whole, min(backlog, longest), interrupted)
        return self._wait_for(rest, min(END_TIMEOUT, longest), interrupted) and all_samples

    def _wait_for(self, publishers: list, seconds: float, interrupted) -> bool:
        end = time.monotonic() + seconds
        for publisher in publishers:
            while not self._received(publisher, min(SLICE, max(0.0, end - time.monotonic()))):
                if time.monotonic() >= end or interrupted():
                    return False
        return True

    def _send(self, channel: Channel, message: bytes):
        start = None  # s: when the first attempt failed
        while not self._stopped():
            try:
                channel.publisher.publish(message)
            except self._publish_error as error:
                if not channel.lossless:
                    self._report.event("publish " + channel.topic, f"{channel.topic} could not be published: {error}")
                    return
                now = time.monotonic()
                if start is None:
                    start = now
                    self._wait_budget.begin(now)
                if self._wait_budget.over(now, self._values().subscriber_timeout):
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

    def _give_up(self, channel: Channel):
        self._report.begin(
            "stuck " + channel.topic,
            f"a subscriber of {channel.topic} has been stuck for {self._values().subscriber_timeout:g} s: "
            "going on without it, it will miss samples",
        )
        channel.drop_oldest(self._destroy)


class WaitBudget:
    """The time spent waiting for subscribers: one for all topics, as a stuck subscriber is stuck on all of them."""

    def __init__(self):
        self._since: float | None = None  # s, steady clock
        self._last = 0.0

    def begin(self, now: float):
        """Note a failed publish; a wait that ended more than `QUIET_TIME` ago does not count."""
        if self._since is None or now - self._last > QUIET_TIME:
            self._since = now
        self._last = now

    def over(self, now: float, timeout: float) -> bool:
        """Whether the waiting has reached `timeout` [s]."""
        self._last = now
        return self._since is not None and now - self._since >= timeout

    def renew(self):
        """Start over: a subscriber has caught up."""
        self._since = None
