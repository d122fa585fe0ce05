"""The visualiser: every topic of a swimmer into Rerun.

It only listens. Subscriptions are reliable and keep all, so that a run without a pace loses nothing; times are those of
the messages. It runs until SIGINT or SIGTERM, or with `stop_with_publisher` until the swimmer has gone.
"""

import sys
import time
from collections import Counter
from dataclasses import fields

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node

from eel_msgs.msg import Backbone, BodyGeometry, Curvature, CurvatureLaw, EnergyLedger, HydrodynamicLoad, InternalWrench
from eel_viz import messages
from eel_viz.lifetime import live
from eel_viz.messages import BadMessage, stamp_of
from eel_viz.quality import keep_all
from eel_viz.runs import Runs
from eel_viz.settings import Settings, limits
from eel_viz.sinks import destinations

NAME = "visualiser"
DEFAULTS = ["--ros-args", "-p", "use_sim_time:=true", "--"]  # what the user says comes after, and wins
EVERY = keep_all()
GONE = 1.0  # s without publishers and messages, after which `stop_with_publisher` ends the node


class Visualiser(Node):
    """A table of topics, and one small callback for each message."""

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
        self._last_law = None
        self._last_message = time.monotonic()
        self._present = False
        self._listen("head_pose", PoseStamped, self._head_pose)
        self._listen("head_twist", TwistStamped, self._head_twist)
        self._listen("odom", Odometry, self._odom)
        self._listen("backbone", Backbone, self._backbone)
        self._listen("curvature", Curvature, self._curvature)
        self._listen("internal_wrench", InternalWrench, self._internal_wrench)
        self._listen("hydrodynamic_load", HydrodynamicLoad, self._hydrodynamic_load)
        self._listen("energy", EnergyLedger, self._energy)
        self._listen("body", BodyGeometry, self._body, keep_all(latched=True))
        self._listen("curvature_law", CurvatureLaw, self._law, keep_all(latched=True))
        self._listen("curvature_law", CurvatureLaw, self._law)
        self._listen("/diagnostics", DiagnosticArray, self._diagnostics)

    def attend(self) -> bool:
        """Now and then: look after the sinks; False once the swimmer has gone and the node is to follow."""
        self._runs.attend()
        if not self.settings.stop_with_publisher:
            return True
        now = time.monotonic()
        if self.count_publishers("head_pose"):
            self._present, self._last_message = True, now
        return not self._present or now - self._last_message < GONE

    def close(self) -> None:
        """Complete the recordings, and say what came."""
        self._runs.close()
        counts = ", ".join(f"{topic} {count}" for topic, count in self.received.items()) or "nothing"
        self._say(f"received: {counts}")

    def _say(self, text: str) -> None:
        self.get_logger().info(text)

    def _warn(self, text: str) -> None:
        self.get_logger().warning(text)

    def _listen(self, topic, kind, show, quality=EVERY) -> None:
        def receive(message):
            self.received[topic] += 1
            self._last_message = time.monotonic()
            self._present |= topic == "head_pose"  # a law alone is no swimmer
            try:
                show(message)
            except BadMessage as problem:
                if (topic, problem.field) not in self._complaints:
                    self._complaints.add((topic, problem.field))
                    self._warn(f"{topic}: {problem}: left out, and those like it")

        self.create_subscription(kind, topic, receive, quality)

    # --- one for each message --------------------------------------------------------------------------------------
    def _head_pose(self, message):
        stamp, pose = stamp_of(message), messages.read_pose(message.pose)
        for loggers in self._runs.at("head_pose", stamp):
            loggers.head_pose(stamp, pose)

    def _head_twist(self, message):
        stamp, twist = stamp_of(message), messages.read_twist(message.twist)
        for loggers in self._runs.at("head_twist", stamp):
            loggers.head_twist(stamp, twist)

    def _odom(self, message):
        stamp = stamp_of(message)
        pose, twist = messages.read_pose(message.pose.pose), messages.read_twist(message.twist.twist)
        for loggers in self._runs.at("odom", stamp):
            loggers.odometry(stamp, pose, twist)

    def _backbone(self, message):
        stamp, backbone = stamp_of(message), messages.read_backbone(message)
        for loggers in self._runs.at("backbone", stamp):
            loggers.backbone(stamp, backbone)

    def _curvature(self, message):
        stamp, curvature = stamp_of(message), messages.read_curvature(message)
        for loggers in self._runs.at("curvature", stamp):
            loggers.curvature(stamp, curvature)

    def _internal_wrench(self, message):
        stamp, wrench = stamp_of(message), messages.read_wrench(message)
        for loggers in self._runs.at("internal_wrench", stamp):
            loggers.internal_wrench(stamp, wrench)

    def _hydrodynamic_load(self, message):
        stamp, load = stamp_of(message), messages.read_load(message)
        for loggers in self._runs.at("hydrodynamic_load", stamp):
            loggers.hydrodynamic_load(stamp, load)

    def _energy(self, message):
        stamp, energy = stamp_of(message), messages.read_energy(message)
        for loggers in self._runs.at("energy", stamp):
            loggers.energy(stamp, energy)

    def _body(self, message):
        self._runs.body(messages.read_body(message))

    def _law(self, message):
        if message != self._last_law:  # both subscriptions may hear it
            self._last_law = message
            self._runs.law(message.name)

    def _diagnostics(self, message):
        own = self.get_namespace().strip("/")
        statuses = [status for status in messages.read_diagnostics(message) if status.name.strip("/").startswith(own)]
        if statuses:
            self._runs.diagnostics(statuses)


def declare_settings(node: Node) -> Settings:
    """Declare a parameter for each field of `Settings`, fixed at start, and read what the user gave."""
    values = {}
    for item in fields(Settings):
        about = item.metadata
        descriptor = ParameterDescriptor(
            description=about["description"] + (f" [{about['unit']}]" if about["unit"] else ""),
            read_only=True,
            dynamic_typing=True,  # a float may be given as an integer, a list as one text
        )
        if isinstance(item.default, (int, float)) and not isinstance(item.default, bool):
            descriptor.additional_constraints = limits(about)
            _set_range(descriptor, item)
        default = list(item.default) if isinstance(item.default, tuple) else item.default
        value = node.declare_parameter(item.name, default, descriptor).value
        values[item.name] = list(value) if isinstance(item.default, tuple) and not isinstance(value, str) else value
    return Settings.from_values(values)


def _set_range(descriptor: ParameterDescriptor, item) -> None:
    low, high = item.metadata["minimum"], item.metadata["maximum"]
    if isinstance(item.default, int):
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high, step=1)]
    else:
        descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=1e9 if high is None else high)]


def main(arguments: list[str] | None = None) -> int:
    """Run the node; the exit status is 0 after SIGINT or SIGTERM, 2 if a parameter is refused at start."""
    given = sys.argv if arguments is None else [NAME, *arguments]
    return live(NAME, DEFAULTS + given, Visualiser, Visualiser.attend)


if __name__ == "__main__":
    sys.exit(main())
