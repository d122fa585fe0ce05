"""The node's ROS parameters, declared from the dataclasses `DynamicsParameters` and `Scene` (as `scene.*`)."""

from dataclasses import fields, replace

from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.parameter import Parameter

from .messages import descriptor_of
from .parameters import DynamicsParameters, checked, default_of, from_values
from .scene import Scene


class Declaration:
    """Declares all parameters of `node`; `ValueError` names one that does not fit.

    Attributes: values, the DynamicsParameters in force; scene. Those that can be set during the run are checked, a
    number without a point is taken for one with it, and `changed(values)` is called afterwards.
    """

    def __init__(self, node, changed):
        self._changed = changed
        self.values: DynamicsParameters = self._declare(node, DynamicsParameters, "")
        self.scene: Scene = self._declare(node, Scene, "scene.")
        self._fields = {item.name: item for item in fields(DynamicsParameters)}
        self._paced = self.values.real_time_factor > 0.0
        node.add_pre_set_parameters_callback(self._convert)
        node.add_on_set_parameters_callback(self._judge)
        node.add_post_set_parameters_callback(self._take)

    def _declare(self, node, kind, prefix: str):
        given = {}
        for item in fields(kind):
            # Declared twice: first with any type, to see what the user gave and say in one line what is wrong with it.
            name = prefix + item.name
            given[item.name] = node.declare_parameter(
                name, default_of(item), ParameterDescriptor(dynamic_typing=True)
            ).value
            node.undeclare_parameter(name)
            value = checked(item, given[item.name], name)
            value = default_of(item) if value is None else list(value) if isinstance(value, tuple) else value
            node.declare_parameter(name, value, descriptor_of(item), ignore_override=True)
        return from_values(kind, given, prefix)

    def _convert(self, parameters):
        """Before a set: whole numbers for floats become floats; what does not fit is left for `_judge`."""
        return [self._converted(parameter) for parameter in parameters]

    def _converted(self, parameter):
        item = self._fields.get(parameter.name)
        try:
            return (
                parameter
                if item is None
                else Parameter(parameter.name, value=checked(item, parameter.value, item.name))
            )
        except ValueError:
            return parameter

    def _judge(self, parameters) -> SetParametersResult:
        try:
            for parameter in parameters:
                item = self._fields.get(parameter.name)
                if item is None:
                    continue
                value = checked(item, parameter.value, item.name)
                if item.name == "real_time_factor" and (value > 0.0) != self._paced:
                    now = "> 0" if self._paced else "0 (as fast as it goes)"
                    raise ValueError(f"real_time_factor was {now} at the start and has to stay so, got {value:g}")
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _take(self, parameters):
        changes = {each.name: each.value for each in parameters if each.name in self._fields}
        if changes:
            self.values = replace(self.values, **changes)
            self._changed(self.values)
