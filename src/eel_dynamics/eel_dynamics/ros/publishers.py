"""The topics of a run: each sample goes to those that someone hears, at real time or without loss.

At real time a slow subscriber misses samples and nobody waits. Without a pace, publishers are reliable and keep all: a
history that is full makes `publish` fail, and it is tried again until the subscriber has caught up, or is taken for
stuck. Its topics then change to a history that forgets, so that the run and the other subscribers go on.
"""

import math
import time

LIVE_DEPTH = 100  # samples: history at real time
LONG_DEPTH = 5000  # samples: history once a subscriber has been given up, as long as that which keeps all
RETRY = 0.002  # s between two attempts: lets the other threads run
FAREWELL = 5.0  # s: longest wait for acknowledgements at the end of a run
BACKLOG = 30.0  # s: likewise where no sample may be lost: a history full of them, for one who takes its time
SLICE = 0.2  # s: a wait at the end looks so often whether it is interrupted
CALM = 1.0  # s without a change after which partial subscribers are taken to be complete
LOOK = 0.1  # s of wall time, after which subscribers are counted again: a count costs as much as a short message
HEAVY = {"internal_wrench": "wrench", "hydrodynamic_load": "load"}  # topic: what Simulation.observe computes for it


class Channel:
    """One topic: its publisher, made by `create(message_type, topic, depth)`; depth None: all is kept until taken."""

    def __init__(self, create, message_type, topic: str, lossless: bool):
        self.topic, self.message_type = topic, message_type
        self._create = create
        self.lossless = lossless
        self.publisher = create(message_type, topic, None if lossless else LIVE_DEPTH)

    def forget(self, destroy):
        """Changes to a history that forgets what a stuck subscriber has not taken, long enough for the others."""
        destroy(self.publisher)
        self.lossless = False
        self.publisher = self._create(self.message_type, self.topic, LONG_DEPTH)


class Publishers:
    """All topics of samples, and /clock.

    sample: makes the messages (messages.Sample). create: see Channel; destroy(publisher).
    received(publisher, seconds): waits until all is acknowledged, whether it is. refusal: the exception of a publish
    that failed. values(): the DynamicsParameters in force. stopped(): whether the run is over.
    """

    def __init__(self, sample, *, create, destroy, received, refusal, values, stopped, report):
        self._sample, self._create, self._destroy, self._refusal = sample, create, destroy, refusal
        self._received = received
        self._values, self._stopped, self._report = values, stopped, report
        self._lossless = values().real_time_factor == 0.0
        self._channels = {name: Channel(create, kind, name, self._lossless) for name, kind in sample.kinds.items()}
        self._heard, self._looked = (), -math.inf  # topics that someone hears, and s: when that was found
        self._clock = None
        self._patience = Patience()
        self._audience, self._audience_since = None, 0.0

    def _look(self):
        """Find the topics that someone hears."""
        self._looked = time.monotonic()
        hidden = () if self._values().publish_tf else ("/tf",)
        self._heard = tuple(
            name
            for name, channel in self._channels.items()
            if name not in hidden and channel.publisher.get_subscription_count() > 0
        )

    def wanted_parts(self) -> dict[str, bool]:
        """Which of the costly parts of the next snapshot someone wants: the flags of `Simulation.observe`."""
        if self._lossless or time.monotonic() - self._looked >= LOOK:
            self._look()
        return {part: name in self._heard for name, part in HEAVY.items()}

    def publish(self, snapshot, nanoseconds: int):
        """One sample at simulation time `nanoseconds`, /clock first, to those who were there when `wanted_parts` was
        asked."""
        self.tick(nanoseconds)
        for name in self._heard:
            self._send(self._channels[name], self._sample.fill(name, snapshot))

    def tick(self, nanoseconds: int):
        """/clock alone."""
        self._sample.set_time(nanoseconds)
        if self._clock is not None:
            self._send(self._clock, self._sample.tick())

    def offer_clock(self, offered: bool):
        """Begins or ends publishing /clock."""
        if offered and self._clock is None:
            self._clock = Channel(self._create, self._sample.clock, "/clock", self._lossless)
        elif not offered and self._clock is not None:
            self._destroy(self._clock.publisher)
            self._clock = None

    def audience_complete(self, wanted: int, now: float) -> bool:
        """Whether every topic has `wanted` subscribers, or some have and nobody has come or gone for a while."""
        own = [channel for name, channel in self._channels.items() if not name.startswith("/")]
        counts = [channel.publisher.get_subscription_count() for channel in own]
        if counts != self._audience:
            self._audience, self._audience_since = counts, now
        return min(counts) >= wanted or (max(counts) >= wanted and now - self._audience_since > CALM)

    def wait_until_received(self, others: list, interrupted, longest: float = math.inf) -> bool:
        """Waits until all is received, of `others` (publishers) too; False after a farewell, or `longest` [s], or once
        `interrupted()`. Where no sample may be lost that is long, but for topics of which somebody was given up."""
        clock = [self._clock] if self._clock is not None else []
        samples = [*self._channels.values(), *clock] if self._lossless else []
        whole = [channel.publisher for channel in samples if channel.lossless]
        rest = [channel.publisher for channel in samples if not channel.lossless] + others
        backlog = max(BACKLOG, self._values().subscriber_timeout)
        all_samples = self._wait_for(whole, min(backlog, longest), interrupted)
        return self._wait_for(rest, min(FAREWELL, longest), interrupted) and all_samples

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
            except self._refusal as error:
                if not channel.lossless:
                    self._report.event("publish " + channel.topic, f"{channel.topic} could not be published: {error}")
                    return
                now = time.monotonic()
                if start is None:
                    start = now
                    self._patience.begin(now)
                if self._patience.over(now, self._values().subscriber_timeout):
                    self._give_up(channel)
                    continue
                self._report.event(
                    "slow subscriber", f"waiting for a subscriber of {channel.topic}, whose history is full"
                )
                time.sleep(RETRY)
            else:
                if start is not None and channel.lossless:
                    self._patience.renew()
                return

    def _give_up(self, channel: Channel):
        self._report.begin(
            "stuck " + channel.topic,
            f"a subscriber of {channel.topic} has been stuck for {self._values().subscriber_timeout:g} s: "
            "going on without it, it will miss samples",
        )
        channel.forget(self._destroy)


class Patience:
    """How long subscribers have been waited for: one account for all topics, as who is stuck is stuck on all."""

    def __init__(self):
        self._since = None  # s, steady clock
        self._last = 0.0

    def begin(self, now: float):
        """A publish has failed; a wait that ended some time ago does not count."""
        if self._since is None or now - self._last > CALM:
            self._since = now
        self._last = now

    def over(self, now: float, timeout: float) -> bool:
        """Whether `timeout` s of waiting are used up."""
        self._last = now
        return now - self._since >= timeout

    def renew(self):
        """A subscriber has caught up."""
        self._since = None
