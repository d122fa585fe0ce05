# SPDX-License-Identifier: Apache-2.0
"""The visualiser node: subscribes to every topic of a swimmer and logs the messages to Rerun.

Subscriptions are reliable and keep all, so that no message is lost when the simulation runs as fast as possible. Times
are the messages' stamps. The node runs until SIGINT or SIGTERM; with `stop_with_publisher` also until the swimmer's
publishers have gone.
"""

import sys
import time
from typing import Any

from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.parameters import declare_all, help_rows
from eel_common.ros.process_end import exit_immediately
from eel_common.ros.qos import keep_all
from eel_common.ros.run_node import run_node
from eel_common.topics import DIAGNOSTICS, GLOBAL, LATCHED, OWN
from eel_common.wording import shown

from eel_viz.bags.definitions import message_class
from eel_viz.recording.dispatcher import READERS, Dispatcher
from eel_viz.recording.recordings import Recordings
from eel_viz.recording.sinks import destinations
from eel_viz.ros.polled_subscriptions import PolledSubscriptions, SwimmerPresence
from eel_viz.settings import Settings

NAME = "visualiser"
ABOUT = "Shows and records every topic of a swimmer in Rerun."
EARLIER, LIVE = keep_all(latched=True), keep_all()  # the first gets earlier messages, the second matches any publisher
LOOK_PERIOD = 0.5  # s between two look-ups of the publishers

CANNOT_START = 2  # exit status


class Visualiser(ParameterNode):
    """Subscribes to the topics of one swimmer, or of two for comparison, and passes the messages to dispatchers."""

    def __init__(self) -> None:
        super().__init__(NAME)
        (self.settings,) = declare_all(self, Settings)
        own = self.get_namespace().rstrip("/")
        other = f"/{self.settings.compare.strip('/')}".rstrip("/")  # empty: the swimmer without a namespace
        if self.settings.compare and other == own:
            raise ValueError(f"compare must be another namespace than the swimmer's own, got {shown(other or '/')}")
        self._recordings = recordings = Recordings(
            destinations(self.settings, self._log_info, self._log_warning, live=True),
            name=own.strip("/") or "eel",
            log_warning=self._log_warning,
            has_several_publishers=lambda topic: self.count_publishers(topic) > 1,
        )
        self._polled, self._presence = PolledSubscriptions(self), SwimmerPresence(self)
        self._dispatchers = {own: Dispatcher(recordings, namespace=own, log_warning=self._log_warning)}  # by namespace
        self._looked = time.monotonic()
        self._laws: dict[str, Any] = {}  # topic: the last law
        if self.settings.compare:
            self._dispatchers[other] = Dispatcher(
                recordings,
                namespace=other,
                log_warning=lambda text: self._log_warning(f"{other or '/'}: {text}"),
                compared=other,
            )

    def listen(self) -> None:
        """Subscribe to the topics of each swimmer."""
        for space, dispatcher in self._dispatchers.items():
            self._subscribe(space, dispatcher)

    def poll(self) -> bool:
        """Poll the recordings. Returns False after the swimmer has gone, with `stop_with_publisher`."""
        for dispatcher in self._dispatchers.values():
            dispatcher.poll()
        self._recordings.poll()
        now = time.monotonic()
        if now - self._looked > LOOK_PERIOD:
            self._looked = now
            self._polled.note_publishers()
        return not (self.settings.stop_with_publisher and self._presence.has_gone())

    def close(self) -> None:
        """Close the recordings, and log the numbers of messages."""
        try:
            received = [dispatcher.finish() for dispatcher in self._dispatchers.values()]
        finally:
            self._recordings.close()
        self._log_info(f"received: {received[0]}")

    @property
    def failure(self) -> str:
        """The reason for exit status 1; empty without one."""
        return "a recording lacks a part of its run" if self._recordings.incomplete else ""

    def take_messages(self, before: int) -> int:
        """Log waiting messages. Returns the number of those from `before` [ns]; 0: of all."""
        count = self._polled.take(before)
        self._presence.look(count)
        return count

    def drop_messages(self, before: int) -> tuple[int, bool]:
        """Drop waiting messages. Returns how many are from `before` [ns], and whether that is exact, not a minimum."""
        return self._polled.drop(before)

    def _subscribe(self, space: str, dispatcher: Dispatcher) -> None:
        """Subscribe to the topics of the swimmer in the namespace `space`, the body first: the others need it."""
        for name in READERS:
            topic = DIAGNOSTICS if name == "diagnostics" else f"{space}/{name}"
            kind = message_class(OWN.get(name) or GLOBAL[topic])
            qualities = (EARLIER,) if name == "body" else (EARLIER, LIVE) if name in LATCHED else (LIVE,)

            def show(message: Any, new_publisher: bool, sent: int, name: str = name, topic: str = topic) -> None:
                self._presence.heard(topic)
                if name == "curvature_law":
                    before, self._laws[topic] = self._laws.get(topic), message
                    if message == before:  # published again
                        return
                dispatcher.dispatch(name, message, new_publisher=new_publisher, sent=sent)

            self._polled.show(kind, topic, show, *qualities)

    def _log_info(self, text: str) -> None:
        self.get_logger().info(text)

    def _log_warning(self, text: str) -> None:
        self.get_logger().warning(text)


def main(arguments: list[str] | None = None) -> int:
    """Run the node. Exit status: 0 after SIGINT or SIGTERM; 1 if a file could not be written completely; 2 if a
    parameter or an argument is refused at start."""
    words, rows = sys.argv if arguments is None else [NAME, *arguments], help_rows(Settings)
    make, poll, take = Visualiser, Visualiser.poll, Visualiser.take_messages
    status = run_node(NAME, words, make, poll, take, about=ABOUT, parameters=rows, sim_time=True, complete=True)
    # Not with Python's own exit: a stream may be blocked, and a thread of LTTng, part of ROS, may fork just then. It
    # would wait for a lock of Arrow, and the destructors of LTTng for the thread.
    return status if status == CANNOT_START else exit_immediately(status)


if __name__ == "__main__":
    sys.exit(main())
