# SPDX-License-Identifier: Apache-2.0
"""`eel record`: record topics to a rosbag2 folder (MCAP), without `ros2 bag`.

Messages are written undecoded. The bag is completed twice a second (see `growing_bag`), so that it can be opened
however the recorder ends. The swimmer's topics are subscribed to from the start, so that no message of a run as fast as
possible is lost; other topics as soon as they are discovered. At the end all earlier messages are taken (see
`run_node`). Stamps in the bag are times of reception. The dynamics node repeats sample 0 while its run stands at the
start; it is written once for each run.
"""

import argparse
import sys
import time
from collections import Counter
from collections.abc import Mapping
from typing import Any

from eel_common.command.command_line import Parser, check_seconds
from eel_common.ros.qos import fitting, keep_all, matches
from eel_common.ros.run_node import run_node
from eel_common.topics import GLOBAL, LATCHED, OWN, SAMPLED
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rclpy.utilities import remove_ros_args
from rosbags.interfaces import Connection, Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

from eel_viz.bags.definitions import definition, message_class, type_hash
from eel_viz.bags.growing_bag import GrowingBag
from eel_viz.ros.polled_subscriptions import PolledSubscriptions, SwimmerPresence

NAME, COMMAND = "record", "eel record"
LOOK_PERIOD = 0.2  # s between two look-ups of the topics
SAVE_PERIOD = 0.5  # s: least time between two saves of the bag
LEAST_PERIOD_TO_COST = 15.0  # the least ratio of that period to the CPU time of a save
STAMP = slice(4, 12)  # of a serialised message that begins with a header
NOT_BY_DEFAULT = ("/rosout", "/parameter_events")  # recorded only by name


class Recorder(Node):
    """Subscribes to the raw messages of each topic and writes them to one bag.

    Attributes:
        failure: the reason for exit status 1; empty without one.
        counts: number of messages by topic.
    """

    def __init__(self, options: argparse.Namespace) -> None:
        check_seconds("--duration", options.duration)
        super().__init__(NAME, namespace=options.namespace)
        self._options = options
        self._bag = GrowingBag(options.out)
        self._saved, self._saving = time.monotonic(), 0.0  # s: time of the last save, and its CPU time
        self.failure = ""
        self.counts: Counter[str] = Counter()
        self._saved_messages = 0
        self._polled = PolledSubscriptions(self)
        self._subscribed: dict[str, tuple[Subscription, QoSProfile]] = {}
        self._offers: dict[str, list[QoSProfile]] = {}
        self._connections: dict[str, Connection] = {}
        self._start: dict[str, bytes] = {}  # topic: the last sample 0 of a run at its start
        self._refused: set[str] = set()
        self._began = self._looked = time.monotonic()
        self._presence = SwimmerPresence(self)
        self._sampled = {self.resolve_topic_name(name) for name in SAMPLED}

    def listen(self) -> None:
        """Subscribe to the swimmer's topics."""
        for topic, kind in {**{self.resolve_topic_name(name): kind for name, kind in OWN.items()}, **GLOBAL}.items():
            if self._wanted(topic):
                self._subscribe(topic, kind, keep_all(latched=topic.rsplit("/", 1)[-1] in LATCHED))
        self.get_logger().info(f"recording to {self._options.out}, end with Ctrl-C")

    def poll(self) -> bool:
        """Look for new topics and save the bag. Returns False when the recording is to end."""
        now = time.monotonic()
        if now - self._looked >= LOOK_PERIOD:
            self._looked = now
            self._update_topics()
        if not self._save_if_due(now):
            return False
        if self._options.duration is not None and now - self._began >= self._options.duration:
            return False
        return not (self._options.stop_with_publisher and self._presence.has_gone())

    def close(self) -> None:
        """Complete the bag, and log its contents."""
        if not self.failure:
            self._save()
        self._bag.abort()
        counts = ", ".join(f"{topic} {count}" for topic, count in sorted(self.counts.items())) or "no message"
        self.get_logger().info(f"recorded in {self._options.out}: {counts}")
        samples = sorted((self.counts[topic], topic) for topic in self._sampled if self.counts[topic])
        if samples and samples[0][0] != samples[-1][0]:
            (least, short), (most, long) = samples[0], samples[-1]
            self.get_logger().warning(f"topics of unequal length: {short} has {least} samples, {long} has {most}")

    def take_messages(self, before: int) -> int:
        """Record waiting messages, and save if due. Returns the number of those from `before` [ns]; 0: of all."""
        count = self._polled.take(before)
        self._presence.look(count)
        self._save_if_due(time.monotonic())
        return count

    def drop_messages(self, before: int) -> tuple[int, bool]:
        """Drop waiting messages. Returns how many are from `before` [ns], and whether that is exact, not a minimum."""
        return self._polled.drop(before)

    def _save_if_due(self, now: float) -> bool:
        """Save the bag if due. Returns False if that fails."""
        return now - self._saved < max(SAVE_PERIOD, LEAST_PERIOD_TO_COST * self._saving) or self._save()

    def _save(self) -> bool:
        """Save the bag. Returns whether that succeeded."""
        began = time.process_time()
        try:
            self._bag.save()
        except OSError as error:
            saved = self._saved_messages
            self.failure = f"{self._options.out}: {error.strerror}: the bag ends with the {saved} messages before"
            return False
        self._saved = time.monotonic()
        self._saving = time.process_time() - began
        self._saved_messages = self.counts.total()
        return True

    def _update_topics(self) -> None:
        for topic, kinds in self.get_topic_names_and_types():
            if not self._wanted(topic) or topic in self._refused:
                continue
            offers = [info.qos_profile for info in self.get_publishers_info_by_topic(topic)]
            if not offers:
                continue
            self._offers[topic] = offers
            if topic not in self._subscribed:
                self._subscribe(topic, kinds[0], fitting(offers))
            elif not all(matches(self._subscribed[topic][1], offer) for offer in offers):
                self._polled.remove(self._subscribed.pop(topic)[0])
                self._subscribe(topic, kinds[0], fitting(offers))

    def _wanted(self, topic: str) -> bool:
        if self._options.topics:
            return topic in [self.resolve_topic_name(name) for name in self._options.topics]
        space = self.get_namespace().rstrip("/") + "/"
        return (topic.startswith(space) or topic in GLOBAL or topic == "/tf") and topic not in NOT_BY_DEFAULT

    def _subscribe(self, topic: str, kind: str, quality: QoSProfile) -> None:
        def receive(data: bytes, about: Mapping[str, Any]) -> None:
            if topic not in self._connections:
                self._connect(topic, kind)
            self._presence.heard(topic)
            if topic in self._sampled and any(data[STAMP]):
                self._start.pop(topic, None)  # the run goes on: the next sample 0 is that of another run
            elif topic in self._sampled:
                if data == self._start.get(topic):
                    return
                self._start[topic] = data
            self.counts[topic] += 1
            self._bag.write(self._connections[topic], about.get("received_timestamp") or time.time_ns(), data)

        try:
            self._subscribed[topic] = self._polled.add(message_class(kind), topic, quality, receive), quality
        except ValueError as error:
            self._refused.add(topic)
            self.get_logger().warning(f"{topic} is left out: {error}")

    def _connect(self, topic: str, kind: str) -> None:
        offers = self._offers.get(topic) or [info.qos_profile for info in self.get_publishers_info_by_topic(topic)]
        self._connections[topic] = self._bag.add_connection(
            topic,
            kind,
            msgdef=definition(kind),
            rihs01=type_hash(kind),
            offered_qos_profiles=[_stored(offer) for offer in offers or [self._subscribed[topic][1]]],
        )


def _stored(offer: QoSProfile) -> Qos:
    """A publisher's quality of service in the form of rosbag2."""

    def seconds(duration: Duration) -> QosTime:
        return QosTime(*divmod(duration.nanoseconds, 1_000_000_000))

    return Qos(
        QosHistory[offer.history.name],
        offer.depth,
        QosReliability[offer.reliability.name],
        QosDurability[offer.durability.name],
        seconds(offer.deadline),
        seconds(offer.lifespan),
        QosLiveliness[offer.liveliness.name],
        seconds(offer.liveliness_lease_duration),
        offer.avoid_ros_namespace_conventions,
    )


def main(arguments: list[str] | None = None) -> int:
    """Run the command. Exit status: 0 after SIGINT, SIGTERM, --duration or the publishers' end; 1 after a write error
    (disk full); 2 if it cannot start."""
    words = sys.argv if arguments is None else [NAME, *arguments]
    parser = Parser(
        prog=COMMAND,
        description="Record topics to a rosbag2 folder (MCAP), readable by ros2 bag and rosbags: all messages, as they "
        "come, with the quality of service that their publishers offer.",
        epilog="The bag is made whole twice a second, so that it opens even if the recorder is killed or the disk is "
        "full; SIGKILL loses what came since: up to 0.7 s, and 2.5 s where twenty busy processes shared two cores. At "
        "the end all is taken that was sent before; after a signal for 1.5 s, and it is said how many are left out. "
        "Exit status: 0 after Ctrl-C or the end that was asked for; 1 if it had to stop, 2 if it cannot begin, with "
        "one line that says why. ROS arguments follow --ros-args.",
    )
    parser.add_argument(
        "topics", nargs="*", help="names; none: every topic of the namespace, /clock, /diagnostics and /tf"
    )
    parser.add_argument("-o", "--out", required=True, metavar="FOLDER", help="new folder of the bag")
    parser.add_argument("--namespace", default="/", metavar="NS", help="of the swimmer (default /)")
    parser.add_argument("--duration", type=float, metavar="SECONDS", help="end after so much wall time")
    parser.add_argument("--stop-with-publisher", action="store_true", help="end when the swimmer has gone")
    options = parser.parse_args(remove_ros_args(args=words)[1:])
    make, poll, take_messages = lambda: Recorder(options), Recorder.poll, Recorder.take_messages
    return run_node(COMMAND, words, make, poll, take_messages, complete=True)


if __name__ == "__main__":
    sys.exit(main())
