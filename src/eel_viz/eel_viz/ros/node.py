"""The visualiser: every topic of a swimmer into Rerun.

It only listens. Subscriptions are reliable and keep all, so that a run without a pace loses nothing; times are those of
the messages. It runs until SIGINT or SIGTERM, or with `stop_with_publisher` until the swimmer has gone.
"""

import sys
import time
from dataclasses import fields

from diagnostic_msgs.msg import DiagnosticArray
from eel_gaits.command_line import complain
from eel_gaits.quantity import limits
from eel_gaits.wording import shown
from eel_ros.command_line import USE_SIM_TIME, answer_words
from eel_ros.parameters import declare, default_of, help_rows, take_overrides, warn_of_unknown
from eel_ros.qos import keep_all
from eel_ros.run_node import run_node
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import QoSProfile

from eel_msgs.msg import Backbone, BodyGeometry, Curvature, CurvatureLaw, EnergyLedger, HydrodynamicLoad, InternalWrench
from eel_viz.recording.delivery import leave
from eel_viz.recording.intake import Intake
from eel_viz.recording.runs import OtherRuns, Runs
from eel_viz.recording.sinks import destinations
from eel_viz.ros.inbox import Inbox
from eel_viz.settings import Settings
from eel_viz.topics import SWIMMER

NAME = "visualiser"
ABOUT = "Shows and records every topic of a swimmer in Rerun."
LATCHED, LIVE = keep_all(latched=True), keep_all()  # the first also hears what was published before, the second anybody
LOOK = 0.5  # s between two looks at who publishes
GONE = 1.0  # s without publishers and messages, after which `stop_with_publisher` ends the node

SAMPLED = {
    "head_pose": PoseStamped,
    "head_twist": TwistStamped,
    "odom": Odometry,
    "backbone": Backbone,
    "curvature": Curvature,
    "internal_wrench": InternalWrench,
    "hydrodynamic_load": HydrodynamicLoad,
    "energy": EnergyLedger,
}


class Visualiser(Node):
    """Topics to an intake."""

    def __init__(self):
        super().__init__(NAME, automatically_declare_parameters_from_overrides=True)
        self.settings = self._declare_settings()
        own = self.get_namespace().rstrip("/")
        other = f"/{self.settings.compare.strip('/')}".rstrip("/")  # empty: the swimmer without a namespace
        told = other or "/"
        if self.settings.compare and other == own:
            raise ValueError(f"compare must be another namespace than the swimmer's own, got {shown(told)}")
        self._runs = runs = Runs(
            destinations(self.settings, self._say, self._warn, live=True),
            name=own.strip("/") or "eel",
            warn=self._warn,
            crowded=lambda topic: self.count_publishers(topic) > 1,
        )
        self._inbox = Inbox(self)
        self._intake = Intake(runs, namespace=own, warn=self._warn)
        self._last_message = self._looked = time.monotonic()
        self._present = False
        self._listen(own, self._intake)
        if self.settings.compare:
            intake = Intake(OtherRuns(runs, other), namespace=other, warn=lambda text: self._warn(f"{told}: {text}"))
            self._listen(other, intake)

    def _declare_settings(self) -> Settings:
        """Declare a parameter for each setting, fixed at the start; ValueError names what does not fit."""
        overrides = take_overrides(self)
        values = {item.name: overrides.get(item.name, default_of(item)) for item in fields(Settings)}
        settings = Settings.from_values(values)
        declare(self, settings, limits)
        warn_of_unknown(self, overrides, values)
        return settings

    def attend(self) -> bool:
        """Now and then: look after the sinks; False once the swimmer has gone and the node is to follow."""
        self._intake.attend()
        now = time.monotonic()
        if now - self._looked > LOOK:
            self._looked = now
            self._inbox.look()
        if not self.settings.stop_with_publisher:
            return True
        if self.count_publishers(SWIMMER):
            self._present, self._last_message = True, now
        return not self._present or now - self._last_message < GONE

    def close(self) -> None:
        """Complete the recordings, and say what came."""
        self._say(f"received: {self._intake.close()}")

    @property
    def failure(self) -> str:
        """What could not be done; empty if all was."""
        return "a recording lacks a part of its run" if self._runs.lost else ""

    def work(self) -> bool:
        """Show what has come; whether there was any."""
        return self._inbox.take() > 0

    def _listen(self, space: str, intake: Intake) -> None:
        """Hear the swimmer in the namespace `space`."""
        self._hear(space, intake, "body", BodyGeometry, LATCHED)  # first, for the others need it
        self._hear(space, intake, "curvature_law", CurvatureLaw, LATCHED, LIVE)
        for topic, kind in SAMPLED.items():
            self._hear(space, intake, topic, kind, LIVE)
        self._hear("", intake, "diagnostics", DiagnosticArray, LIVE)

    def _hear(self, space: str, intake: Intake, topic: str, kind: type, *qualities: QoSProfile) -> None:
        def receive(message, successor):
            self._last_message = time.monotonic()
            self._present |= topic == SWIMMER  # a law alone is no swimmer
            intake.take(topic, message, successor=successor)

        self._inbox.listen(kind, f"{space}/{topic}", receive, *qualities)

    def _say(self, text: str) -> None:
        self.get_logger().info(text)

    def _warn(self, text: str) -> None:
        self.get_logger().warning(text)


def main(arguments: list[str] | None = None) -> int:
    """Run the node; the exit status is 0 after SIGINT or SIGTERM, 1 if a file could not be written to its end, 2 if a
    parameter or a word is refused at start."""
    given = sys.argv if arguments is None else [NAME, *arguments]
    status = answer_words(NAME, ABOUT, help_rows(Settings), given, complain)
    if status is not None:
        return status
    words = [*USE_SIM_TIME, *given]
    node, attend, work = Visualiser, Visualiser.attend, Visualiser.work
    return leave(run_node(NAME, words, node, attend, work, complain=complain, complete=True))


if __name__ == "__main__":
    sys.exit(main())
