# SPDX-License-Identifier: Apache-2.0
"""The gait generator. It publishes the curvature law of a gait, and a new one whenever parameters are set.

The topic `curvature_law` is transient local: a receiver that starts later gets the law too. The stamp of the law is the
simulation time at which the gait began. A parameter of the same gait does not change that time. Another gait begins at
the present time.
"""

import sys
from typing import Any

from builtin_interfaces.msg import Time
from eel_common.ros.headers import frame_in
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.parameters import declare, help_rows, take_overrides, warn_of_unknown
from eel_common.ros.qos import latched
from eel_common.ros.run_node import run_node
from eel_common.ros.serving import PolledGroup
from eel_common.wording import shown
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.clock import JumpThreshold
from rclpy.duration import Duration
from rclpy.parameter import Parameter

from eel_gaits.gaits.registry import GAITS, Transition
from eel_gaits.gaits.settings import FILE_GAITS, MeasuredBody, Settings
from eel_gaits.gaits.swimming import still
from eel_gaits.laws.law import Law
from eel_gaits.ros.messages import FRAME, law_to_message
from eel_gaits.ros.streams import OscillatorStream, RowStream
from eel_gaits.sources.sampled_law import SampledLaw
from eel_msgs.msg import CurvatureLaw

NAME = "gait_generator"
ABOUT = """\
Publishes the curvature law of a gait, and a new one whenever a parameter is set. The numbers of the
gait are parameters too: `eel simulate --help GAIT` lists them."""
KNOWN = ", ".join(sorted((*GAITS, *FILE_GAITS)))
FILE = (
    "file of the gait 'file' (a table, .npz: a measured motion; .yaml: a sequence) or 'sequence'; read when it is set"
)
ROWS = [
    ("gait", f"name of the gait, one of {KNOWN}", Settings.gait),
    ("file", FILE, Settings.file),
    *help_rows(Transition),
    *((name, f"{text}, of the gait 'file'", default) for name, text, default in help_rows(MeasuredBody)),
]
LOOK = 0.05  # s between two checks of the time, for resets and due samples


class GaitGenerator(ParameterNode):
    """A node with the parameters `gait`, `transition` and the gait's own numbers, and the topic `curvature_law`."""

    def __init__(self) -> None:
        self._ticks = PolledGroup()
        super().__init__(NAME)
        overrides = take_overrides(self)
        self._settings = Settings.start(overrides)
        warn_of_unknown(self, overrides, Settings.known_names())
        self._stamp = Time()
        self._frame = frame_in(self.get_namespace(), FRAME)
        self._stream, self._rows = OscillatorStream(self, self._frame), RowStream(self, self._frame)
        self._publisher = self.create_publisher(CurvatureLaw, "curvature_law", latched(1))
        descriptor = ParameterDescriptor(description="name of the gait", additional_constraints=f"one of {KNOWN}")
        self.declare_parameter("gait", self._settings.gait, descriptor, ignore_override=True)
        descriptor = ParameterDescriptor(description=FILE)
        self.declare_parameter("file", self._settings.file, descriptor, ignore_override=True)
        self._declare_numbers()
        backwards = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False)
        self._publish_later = self.create_guard_condition(self._publish)  # one law for all changes
        self._jump_handle = self.get_clock().create_jump_callback(backwards, post_callback=self._follow_reset)
        self._publish()

    def create_subscription(self, *args: Any, **kwargs: Any) -> Any:
        """Put a subscription into the group that the node polls.

        The only subscription is rclpy's own to /clock, which may tick thousands of times per second. The node needs
        only the newest tick, and only when it needs the time.
        """
        return super().create_subscription(*args, **kwargs, callback_group=self._ticks)

    def look_at_clock(self) -> None:
        """Take the newest tick of /clock, if any."""
        for ticks in self.subscriptions:
            with ticks.handle:
                taken = ticks.handle.take_message(ticks.msg_type, ticks.raw)
            if taken is not None:
                ticks.callback(*taken)

    def look(self) -> bool:
        """Read the clock and send the samples that are due. Returns True: the node continues."""
        self.look_at_clock()
        self._stream.extend(self._now())
        self._rows.extend(self._now())
        return True

    def _now(self) -> float:
        """Simulation time [s]."""
        return 1e-9 * self.get_clock().now().nanoseconds

    def _declare_numbers(self) -> None:
        for group in self._settings.groups():
            declare(self, group, changeable=True)

    def set_parameters_atomically(self, parameters: list[Parameter]) -> SetParametersResult:
        """Set all `parameters` or none. Those of the gait make new settings and a new law."""
        ours = Settings.known_names()
        others = [each for each in parameters if each.name not in ours and self.has_parameter(each.name)]
        changes = {each.name: each.value for each in parameters if each not in others}
        if not changes:
            return super().set_parameters_atomically(parameters)
        try:
            settings = self._settings.changed(changes)
        except ValueError as error:
            self.get_logger().warning(f"refused: {error}")
            return SetParametersResult(successful=False, reason=str(error))
        stored = {"gait": settings.gait, "file": settings.file}
        if settings.gait == self._settings.gait:  # otherwise its numbers are declared after the set is accepted
            stored = {name: (stored | settings.numbers())[name] for name in changes}
        result = super().set_parameters_atomically(
            [*others, *(Parameter(name, value=value) for name, value in stored.items())]
        )
        if result.successful:
            self._follow(settings)
        return result

    def _follow(self, settings: Settings) -> None:
        """Swim with these settings from now on."""
        self.look_at_clock()
        before, self._settings = self._settings, settings
        if settings.gait != before.gait:
            for name in before.numbers():
                self.undeclare_parameter(name)
            self._declare_numbers()
            self._stamp = self.get_clock().now().to_msg()
        if isinstance(settings.law(), SampledLaw) and self._rows.next_stamp is not None:
            self._stamp = self._rows.next_stamp
        self._publish_later.trigger()

    def _follow_reset(self, jump: Any) -> None:
        """After time went back, the receiver sets the law's t = 0 to 0. Later laws get that time too."""
        oscillation = self._settings.oscillation()
        if oscillation is not None:
            self._stream.restart(oscillation, self._now())
        if self._rows.running:
            self._stamp = Time()
            self._rows.begin_again(0.0)
        elif self._stamp != Time():
            self._stamp = Time()
            self._publish()

    def _publish(self) -> None:
        law, oscillation = self._settings.law(), self._settings.oscillation()
        began = self._stamp.sec + 1e-9 * self._stamp.nanosec
        beginning = f"gait {shown(self._settings.gait)}, t = 0 at {began:.3f} s, published on"
        if isinstance(law, SampledLaw):
            if self._stream.running:
                self._publish_law(still())  # a simulation drops the old stream's samples before the new one begins
            self._rows.follow(law, began)
            self.get_logger().info(f"{beginning} {self._rows.topic_name}: {law.about}")
        elif oscillation is not None:
            if self._rows.running:
                self._publish_law(still())
            self._stream.follow(oscillation, self._now())
            self.get_logger().info(f"gait {shown(self._settings.gait)}, published on curvature_samples")
        else:
            self._publish_law(law)
            self.get_logger().info(f"{beginning} {self._publisher.topic_name}")

    def _publish_law(self, law: Law) -> None:
        """Publish a law. A simulation then drops its samples."""
        self._stream.stop()
        self._rows.stop()
        self._publisher.publish(law_to_message(law, stamp=self._stamp, frame=self._frame))


def main(args: list[str] | None = None) -> int:
    """Run the node. The exit status is 0 after SIGINT or SIGTERM, and 2 if a parameter or word is refused at start."""
    words, look = sys.argv if args is None else args, GaitGenerator.look
    return run_node(NAME, words, GaitGenerator, look, about=ABOUT, parameters=ROWS, sim_time=True, period=LOOK)


if __name__ == "__main__":
    sys.exit(main())
