"""The node's parameters, declared from `Settings`: type, default, range and description are written there alone."""

from dataclasses import fields

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node

from eel_viz.settings import Settings, limits

UNBOUNDED = 1e9  # upper end of a range that has none


def declare_settings(node: Node) -> Settings:
    """Declare a parameter for each field, fixed at start, and read the user's; ValueError names what is wrong."""
    values = {}
    for item in fields(Settings):
        default = list(item.default) if isinstance(item.default, tuple) else item.default
        value = node.declare_parameter(item.name, default, _described(item)).value
        values[item.name] = list(value) if hasattr(value, "typecode") else value
    return Settings.from_values(values)


def _described(item) -> ParameterDescriptor:
    about = item.metadata
    descriptor = ParameterDescriptor(
        description=about["description"] + (f" [{about['unit']}]" if about["unit"] else ""),
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
