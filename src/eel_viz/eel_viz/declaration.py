"""The node's parameters, declared from `Settings`: type, default, range and description are written there alone."""

import sys
from dataclasses import fields

from eel_gaits.command_line import complain, write_on_any_terminal
from eel_gaits.wording import shown
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

from eel_viz.settings import Settings, limits

OF_ROS = ("use_sim_time", "start_type_description_service", "qos_overrides.")  # beginnings of its own parameters' names
UNBOUNDED = 1e9  # upper end of a range that has none


def declare_settings(node: Node) -> Settings:
    """Declare a parameter for each field, fixed at start, and read the user's; ValueError names what is wrong.

    The node has declared what the user gave already; what is no setting is named in a warning.
    """
    given = [name for name in node.get_parameters_by_prefix("") if not name.startswith(OF_ROS)]
    for name in given:
        node.undeclare_parameter(name)  # to be declared anew with its type and range
    values = {}
    for item in fields(Settings):
        default = list(item.default) if isinstance(item.default, tuple) else item.default
        value = node.declare_parameter(item.name, default, _described(item)).value
        values[item.name] = list(value) if hasattr(value, "typecode") else value
    unknown = [repr(name) for name in given if name not in values]
    if unknown:
        node.get_logger().warning(f"not parameters of this node, ignored: {', '.join(unknown)}")
    return Settings.from_values(values)


def answer_words(name: str, about: str, words: list[str]) -> int | None:
    """The exit status that the command line `words` (the program first) comes to by what is no ROS argument: 0 for -h
    or --help, with a usage; 2 for anything else, with one line; None without any."""
    rest = remove_ros_args(words)[1:]
    if not rest:
        return None
    if not {"-h", "--help"} & set(rest):
        complain(name, f"unknown argument {shown(rest[0])} (parameters come after --ros-args as -p NAME:=VALUE)")
        return 2
    lines = [f"usage: {name} [--ros-args -p NAME:=VALUE ...]", "", about, "", "parameters:"]
    for item in fields(Settings):
        default = list(item.default) if isinstance(item.default, tuple) else item.default
        told = str(default).lower() if isinstance(default, bool) else "empty" if default == "" else default
        lines.append(f"  {item.name:<20}  {_description(item)} (default {told})")
    write_on_any_terminal()
    sys.stdout.write("\n".join([*lines, ""]))
    return 0


def _description(item) -> str:
    unit = item.metadata["unit"]
    return item.metadata["description"] + (f" [{unit}]" if unit else "")


def _described(item) -> ParameterDescriptor:
    about = item.metadata
    descriptor = ParameterDescriptor(
        description=_description(item),
        read_only=True,
        dynamic_typing=True,  # a float may be given as an integer, a list as one text
    )
    low, high = about["minimum"], about["maximum"]
    if isinstance(item.default, bool) or not isinstance(item.default, int | float):
        return descriptor
    descriptor.additional_constraints = limits(about)
    if isinstance(item.default, int):
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high, step=1)]
    else:
        upper = UNBOUNDED if high is None else high
        descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=upper)]
    return descriptor
