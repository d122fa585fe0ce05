"""The visualiser: every topic of a swimmer into Rerun.

It only listens. Subscriptions are reliable and keep all, so that a run without a pace loses nothing; times are those of
the messages. It runs until SIGINT or SIGTERM, or with `stop_with_publisher` until the swimmer has gone.
"""

import sys
import time
from collections import Counter

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node

from eel_msgs.msg import Backbone, BodyGeometry, Curvature, CurvatureLaw, EnergyLedger, HydrodynamicLoad, InternalWrench
from eel_viz import messages
from eel_viz.declaration import declare_settings
from eel_viz.lifetime import live
from eel_viz.messages import BadMessage, stamp_of
from eel_viz.quality import keep_all
from eel_viz.runs import Runs
from eel_viz.sinks import destinations

NAME = "visualiser"
DEFAULTS = ["--ros-args", "-p", "use_sim_time:=true", "--"]  # what the user says comes after, and wins
GONE = 1.0  # s without publishers and messages, after which `stop_with_publisher` ends the node
COARSE = 4  # stations, below which a backbone says little about the shape
BODY_LIMIT = 2.0  # s after the first backbone in which the body should have come
SWIMMER = "head_pose"  # whose publishers' leaving that is

SAMPLES = {  # topic, and method of `Loggers`: type, and what the method is given besides the stamp
    "head_pose": (PoseStamped, lambda message: [messages.read_pose(message.pose)]),
    "head_twist": (TwistStamped, lambda message: [messages.read_twist(message.twist)]),
    "odom": (
        Odometry,
        lambda message: [messages.read_pose(message.pose.pose), messages.read_twist(message.twist.twist)],
    ),
    "backbone": (Backbone, lambda message: [messages.read_backbone(message)]),
    "curvature": (Curvature, lambda message: [messages.read_curvature(message)]),
    "internal_wrench": (InternalWrench, lambda message: [messages.read_wrench(message)]),
    "hydrodynamic_load": (HydrodynamicLoad, lambda message: [messages.read_load(message)]),
    "energy": (EnergyLedger, lambda message: [messages.read_energy(message)]),
}


class Visualiser(Node):
    """Topics to loggers; what cannot be shown is said once and left out."""

    def __init__(self):
        super().__init__(NAME)
        self.settings = declare_settings(self)
        self._runs = Runs(
            destinations(self.settings, self._say, self._warn),
            name=self.get_namespace().strip("/") or "eel",
            warn=self._warn,
            crowded=lambda topic: self.count_publishers(topic) > 1,
        )
        self.received = Counter()
        self._complaints = set()
        self._stations = {}  # topic: how many
        self._first_backbone = None  # s
        self._last_law = None
        self._last_message = time.monotonic()
        self._present = False
        for topic, (kind, read) in SAMPLES.items():
            self._listen(topic, kind, lambda message, topic=topic, read=read: self._sample(topic, message, read))
        self._listen("body", BodyGeometry, self._body, latched=True)
        self._listen("curvature_law", CurvatureLaw, self._law, latched=True)
        self._listen("curvature_law", CurvatureLaw, self._law)
        self._listen("/diagnostics", DiagnosticArray, self._diagnostics)

    def attend(self) -> bool:
        """Now and then: look after the sinks; False once the swimmer has gone and the node is to follow."""
        self._runs.attend()
        if self._first_backbone and not self.received["body"] and time.monotonic() - self._first_backbone > BODY_LIMIT:
            self._warn_once("no body", "no body has come: the backbone is drawn as a line, without skin")
        if not self.settings.stop_with_publisher:
            return True
        now = time.monotonic()
        if self.count_publishers(SWIMMER):
            self._present, self._last_message = True, now
        return not self._present or now - self._last_message < GONE

    def close(self) -> None:
        """Complete the recordings, and say what came."""
        self._runs.close()
        counts = ", ".join(f"{topic} {count}" for topic, count in self.received.items()) or "nothing"
        self._say(f"received: {counts}")

    def _listen(self, topic, kind, show, *, latched=False) -> None:
        def receive(message):
            self.received[topic] += 1
            self._last_message = time.monotonic()
            self._present |= topic == SWIMMER  # a law alone is no swimmer
            try:
                show(message)
            except BadMessage as problem:
                self._warn_once((topic, problem.field), f"{topic}: {problem}: left out, and those like it")

        self.create_subscription(kind, topic, receive, keep_all(latched=latched))

    def _sample(self, topic, message, read) -> None:
        stamp, values = stamp_of(message), read(message)
        if hasattr(message, "x"):
            self._watch_stations(topic, len(message.x))
        for loggers in self._runs.at(topic, stamp):
            getattr(loggers, topic)(stamp, *values)

    def _watch_stations(self, topic, count) -> None:
        if self._stations.setdefault(topic, count) != count:
            text = (
                f"{topic} has {count} stations and had {self._stations[topic]}: it is drawn, its envelope begins anew"
            )
            self._warn_once((topic, "stations"), text)
            self._stations[topic] = count
        if topic == "backbone":
            self._first_backbone = self._first_backbone or time.monotonic()
            if count < COARSE:
                self._warn_once("coarse", f"backbone has {count} stations: the shape between them is a guess")

    def _body(self, message) -> None:
        self._runs.body(messages.read_body(message))

    def _law(self, message) -> None:
        if message != self._last_law:  # both subscriptions may hear it
            self._last_law = message
            self._runs.law(message.name)

    def _diagnostics(self, message) -> None:
        own = self.get_namespace().rstrip("/")
        statuses = [each for each in messages.read_diagnostics(message) if each.name.rpartition("/")[0] == own]
        if statuses:
            self._runs.diagnostics(stamp_of(message), statuses)

    def _say(self, text: str) -> None:
        self.get_logger().info(text)

    def _warn_once(self, fault, text: str) -> None:
        if fault not in self._complaints:
            self._complaints.add(fault)
            self._warn(text)

    def _warn(self, text: str) -> None:
        self.get_logger().warning(text)


def main(arguments: list[str] | None = None) -> int:
    """Run the node; the exit status is 0 after SIGINT or SIGTERM, 2 if a parameter is refused at start."""
    given = sys.argv if arguments is None else [NAME, *arguments]
    return live(NAME, DEFAULTS + given, Visualiser, Visualiser.attend)


if __name__ == "__main__":
    sys.exit(main())
