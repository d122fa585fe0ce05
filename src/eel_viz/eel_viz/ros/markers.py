# SPDX-License-Identifier: Apache-2.0
"""The node `markers`: publishes the swimmer as `visualization_msgs/MarkerArray` and `nav_msgs/Path`.

RViz and Foxglove show them. Skin and arrows need messages of one stamp. So a sample is drawn when all of its topics
with publishers have come. Rerun is not needed.
"""

import sys
import time
from collections import OrderedDict
from typing import Any

from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.parameters import declare_all, help_rows
from eel_common.ros.qos import latched
from eel_common.ros.run_node import run_node
from nav_msgs.msg import Path
from sensor_msgs.msg import JointState
from visualization_msgs.msg import MarkerArray

from eel_msgs.msg import Backbone, BodyGeometry, HydrodynamicLoad, InternalWrench, MotorStates
from eel_viz.message_readers import read_backbone, read_body, read_joints, read_load, read_motors, read_wrench, stamp_of
from eel_viz.messages import BadMessage
from eel_viz.ros.marker_messages import FinMarker, ForceMarkers, JointMarkers, SkinMarker, midline
from eel_viz.settings import MarkerSettings

NAME = "markers"
ABOUT = "Publishes a swimmer as markers and its midline as a path, for RViz and Foxglove."
TOPICS = {
    "backbone": (Backbone, read_backbone),
    "internal_wrench": (InternalWrench, read_wrench),
    "hydrodynamic_load": (HydrodynamicLoad, read_load),
    "fin_states": (JointState, read_joints),
    "motor_states": (MotorStates, read_motors),
}
DEPTH = 10  # samples that wait for the rest of their topics
LOOK_PERIOD = 0.5  # s between two look-ups of the publishers


class Markers(ParameterNode):
    """Joins the messages of one stamp, and publishes at most `rate` samples per second of wall time. The last sample is
    always published, so that a paused run is shown correctly."""

    def __init__(self) -> None:
        super().__init__(NAME)
        (self._settings,) = declare_all(self, MarkerSettings)
        self._makers: dict[str, Any] = {"hydrodynamic_load": ForceMarkers(self._settings)}  # by topic
        self._waiting: OrderedDict[int, dict[str, Any]] = OrderedDict()  # stamp [ns]: messages by topic
        self._expected: set[str] = set(TOPICS)
        self._newest: dict[str, Any] | None = None  # the last complete sample not yet drawn
        self._drawn = self._looked = 0.0  # s, steady clock
        self._reported: set[tuple[str, str]] = set()  # topic and field of messages that cannot be shown
        self._markers = self.create_publisher(MarkerArray, "markers", 10)
        self._midline = self.create_publisher(Path, "midline", 10)
        self.create_subscription(BodyGeometry, "body", self._receive_body, latched(1))
        for topic, (kind, _) in TOPICS.items():
            self.create_subscription(kind, topic, lambda message, topic=topic: self._receive(topic, message), DEPTH)

    def poll(self) -> bool:
        """Look up which topics have publishers, and draw what is due. Returns True: the node continues."""
        if time.monotonic() - self._looked > LOOK_PERIOD:
            self._looked = time.monotonic()
            self._expected = {"backbone"} | {topic for topic in TOPICS if self.count_publishers(topic)}
        self._draw_if_due()
        return True

    def _receive_body(self, message: BodyGeometry) -> None:
        try:
            body = read_body(message)
        except BadMessage as problem:
            self._warn_once("body", problem)
            return
        self._makers = {
            "internal_wrench": SkinMarker(body, self._settings.colour_limit),
            "hydrodynamic_load": self._makers["hydrodynamic_load"],
            **({"fin_states": FinMarker(body)} if body.fins else {}),
            **({"motor_states": JointMarkers(body)} if body.joints else {}),
        }

    def _receive(self, topic: str, message: Any) -> None:
        try:
            stamp = stamp_of(message)
        except BadMessage as problem:
            self._warn_once(topic, problem)
            return
        sample = self._waiting.setdefault(stamp, {})
        sample[topic] = message
        if self._expected <= sample.keys():
            del self._waiting[stamp]
            self._newest = sample
            self._draw_if_due()
        elif len(self._waiting) > DEPTH:
            self._waiting.popitem(last=False)

    def _draw_if_due(self) -> None:
        now = time.monotonic()
        if self._newest is not None and now - self._drawn >= 1.0 / self._settings.rate:
            self._drawn, sample, self._newest = now, self._newest, None
            self._draw(sample)

    def _draw(self, sample: dict[str, Any]) -> None:
        """Publish the `sample`, messages by topic, without unusable messages."""
        values: dict[str, Any] = {}
        for topic, message in sample.items():
            try:
                values[topic] = TOPICS[topic][1](message)
            except BadMessage as problem:
                self._warn_once(topic, problem)
        backbone = values.get("backbone")
        if backbone is None:
            return
        header, markers = sample["backbone"].header, []
        if self._markers.get_subscription_count():
            for topic, maker in self._makers.items():
                if topic in values or topic == "internal_wrench":  # without it, the skin is grey
                    markers.extend(maker.markers(header, backbone, values.get(topic)))
            self._markers.publish(MarkerArray(markers=markers))
        if self._midline.get_subscription_count():
            self._midline.publish(midline(header, backbone))

    def _warn_once(self, topic: str, problem: BadMessage) -> None:
        if (topic, problem.field) not in self._reported:
            self._reported.add((topic, problem.field))
            self.get_logger().warning(f"{topic}: {problem}: left out, and those like it")


def main(arguments: list[str] | None = None) -> int:
    """Run the node. Exit status: 0 after SIGINT or SIGTERM; 2 if a parameter or an argument is refused at start."""
    words, rows = sys.argv if arguments is None else [NAME, *arguments], help_rows(MarkerSettings)
    return run_node(NAME, words, Markers, Markers.poll, about=ABOUT, parameters=rows, sim_time=True)


if __name__ == "__main__":
    sys.exit(main())
