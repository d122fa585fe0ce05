"""The gait generator: publishes the curvature law of a gait, and a new one whenever a parameter is set.

`curvature_law` is transient local: a receiver that comes later gets the law too. Its stamp is the simulation time at
which the gait began. Parameters of the same gait leave that time alone; another gait begins at now.
"""

import signal
import sys
from dataclasses import fields

import rclpy
from builtin_interfaces.msg import Time
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.callback_groups import CallbackGroup
from rclpy.clock import JumpThreshold
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from eel_gaits.command_line import complain, write_on_any_terminal
from eel_gaits.messages import law_to_message
from eel_gaits.registry import GAITS
from eel_gaits.serving import leave_out, serve_once
from eel_gaits.settings import Settings, Transition
from eel_gaits.starting import CANNOT_START, tell_no_start
from eel_gaits.wording import shown
from eel_msgs.msg import CurvatureLaw

NAME = "gait_generator"
DEFAULTS = ["--ros-args", "-p", "use_sim_time:=true", "--"]  # what the user says comes after, and wins
ABOUT = "Publishes the curvature law of a gait, and a new one whenever a parameter is set."
OF_ROS = ("use_sim_time", "start_type_description_service", "qos_overrides.")  # beginnings of its own parameters' names
LOOK = 0.25  # s between two looks at whether time went back, or a signal has come


def answer_words(name, about, parameters, words):
    """The exit status that the command line `words` (the program first) comes to by what is no ROS argument: 0 for -h
    or --help, with a usage; 2 for anything else, with one line; None without any.

    `parameters` are rows of name, description and default.
    """
    rest = remove_ros_args(words)[1:]
    if not rest:
        return None
    if not {"-h", "--help"} & set(rest):
        complain(name, f"unknown argument {shown(rest[0])} (parameters come after --ros-args as -p NAME:=VALUE)")
        return 2
    lines = [f"usage: {name} [--ros-args -p NAME:=VALUE ...]", "", about, "", "parameters:"]
    for key, description, default in parameters:
        told = str(default).lower() if isinstance(default, bool) else "empty" if default == "" else default
        lines.append(f"  {key:<24}  {description} (default {told})")
    write_on_any_terminal()
    sys.stdout.write("\n".join([*lines, ""]))
    return 0


def take_overrides(node):
    """What the user gave `node` at start, by name, which rclpy declared: undeclared again, but for ROS's own, to be
    declared anew with type and range."""
    overrides = {name: parameter.value for name, parameter in node.get_parameters_by_prefix("").items()}
    for name in overrides:
        if not name.startswith(OF_ROS):
            node.undeclare_parameter(name)
    return overrides


def warn_of_unknown(node, overrides, known):
    """One line that names the overrides that are not `known`; a parameter file for several nodes may hold some."""
    unknown = [repr(name) for name in overrides if name not in known and not name.startswith(OF_ROS)]
    if unknown:
        node.get_logger().warning(f"not parameters of this node, ignored: {', '.join(unknown)}")


class Unattended(CallbackGroup):
    """What is in it wakes no executor."""

    def can_execute(self, entity):
        return False


class GaitGenerator(Node):
    """Parameters `gait`, `transition` and the gait's own numbers; topic `curvature_law`."""

    def __init__(self):
        self._ticks = Unattended()
        super().__init__(NAME, automatically_declare_parameters_from_overrides=True)
        overrides = take_overrides(self)
        self._settings = Settings.start(overrides)
        warn_of_unknown(self, overrides, Settings.known_names())
        self._plan = None  # in mid-change: the new Settings, or the reason of a refusal
        self._stamp = Time()
        quality = QoSProfile(
            depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
        )
        self._publisher = self.create_publisher(CurvatureLaw, "curvature_law", quality)
        known = ", ".join(sorted(GAITS))
        descriptor = ParameterDescriptor(description="name of the gait", additional_constraints=f"one of {known}")
        self.declare_parameter("gait", self._settings.gait, descriptor, ignore_override=True)
        self._declare_numbers()
        self.add_pre_set_parameters_callback(self._plan_change)
        self.add_on_set_parameters_callback(self._judge_change)
        self.add_post_set_parameters_callback(self._make_change)
        backwards = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False)
        self._jump_handle = self.get_clock().create_jump_callback(backwards, post_callback=self._follow_reset)
        self._publish()

    def create_subscription(self, *args, **kwargs):
        """The only one is rclpy's own, to /clock, which ticks a hundred times a second, or thousands: its newest tick
        is enough, once it is asked for."""
        return super().create_subscription(*args, **kwargs, callback_group=self._ticks)

    def look_at_clock(self):
        """Take the newest tick of /clock, where this node has one."""
        for ticks in self.subscriptions:
            with ticks.handle:
                taken = ticks.handle.take_message(ticks.msg_type, ticks.raw)
            if taken is not None:
                try:
                    ticks.callback(taken[0])
                except ValueError as error:  # a negative time
                    leave_out(self, error, "a message on /clock")

    def _declare_numbers(self):
        for name, value, about in self._settings.quantities():
            bounds = FloatingPointRange(from_value=about["minimum"], to_value=about["maximum"])
            unit = f" [{about['unit']}]" if about["unit"] else ""
            descriptor = ParameterDescriptor(description=about["description"] + unit, floating_point_range=[bounds])
            self.declare_parameter(name, value, descriptor, ignore_override=True)

    def _plan_change(self, parameters):
        """Before a set: work out the new settings, and give rclpy what it can store under the present gait."""
        ours = Settings.known_names()
        others = [each for each in parameters if each.name not in ours and self.has_parameter(each.name)]
        changes = {each.name: each.value for each in parameters if each not in others}
        self._plan = None
        if not changes:
            return parameters
        try:
            self._plan = self._settings.changed(changes)
        except ValueError as error:
            self._plan = str(error)
            return [Parameter("gait", value=self._settings.gait)]
        if self._plan.gait != self._settings.gait:  # its numbers are declared once the set is accepted
            return [*others, Parameter("gait", value=self._plan.gait)]
        stored = {"gait": self._plan.gait, **{name: value for name, value, _ in self._plan.quantities()}}
        return [*others, *(Parameter(name, value=stored[name]) for name in changes)]

    def _judge_change(self, parameters):
        if isinstance(self._plan, str):
            self.get_logger().warning(f"refused: {self._plan}")
            return SetParametersResult(successful=False, reason=self._plan)
        return SetParametersResult(successful=True)

    def _make_change(self, parameters):
        plan, self._plan = self._plan, None
        if plan is None:  # a declaration, or nothing of ours
            return
        self.look_at_clock()
        before, self._settings = self._settings, plan
        if plan.gait != before.gait:
            for name, _, _ in before.quantities():
                self.undeclare_parameter(name)
            self._declare_numbers()
            self._stamp = self.get_clock().now().to_msg()
        self._publish()

    def _follow_reset(self, jump):
        """Time went back: the receiver's law now has its own t = 0 at 0, and so has what is published later."""
        if self._stamp != Time():
            self._stamp = Time()
            self._publish()

    def _publish(self):
        self._publisher.publish(law_to_message(self._settings.law(), stamp=self._stamp))
        began = self._stamp.sec + 1e-9 * self._stamp.nanosec
        self.get_logger().info(
            f"gait {shown(self._settings.gait)}, t = 0 at {began:.3f} s, published on {self._publisher.topic_name}"
        )


def parameter_rows():
    """Name, description and default of each parameter; those of a gait say of which."""
    yield "gait", f"name of the gait, one of {', '.join(sorted(GAITS))}", Settings.gait
    gaits = {}  # of each number
    for kind, gait in [(Transition, None), *((make.numbers, name) for name, make in GAITS.items())]:
        for entry in fields(kind):
            unit = f" [{entry.metadata['unit']}]" if entry.metadata["unit"] else ""
            gaits.setdefault((entry.name, entry.metadata["description"] + unit, entry.default), []).append(gait)
    for (name, description, default), names in gaits.items():
        yield name, description if None in names else f"{description}, of {', '.join(names)}", default


def main(args=None):
    """Run the node; the exit status is 0 after SIGINT or SIGTERM, 2 if a parameter or a word is refused at start."""
    words = sys.argv if args is None else args
    signals = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, _: signals.append(received))
    try:
        status = answer_words(NAME, ABOUT, parameter_rows(), words)
        if status is not None:
            return status
        rclpy.init(args=DEFAULTS + words, signal_handler_options=SignalHandlerOptions.NO)
        node = GaitGenerator()
    except CANNOT_START as error:
        tell_no_start(NAME, error)
        rclpy.try_shutdown()
        return 2
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while not signals:
        serve_once(executor, node, LOOK)
        node.look_at_clock()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)  # until the process is gone: a second one would spoil its exit status
    executor.shutdown()
    node.destroy_node()
    rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
