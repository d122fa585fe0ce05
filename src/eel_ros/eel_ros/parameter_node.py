# SPDX-License-Identifier: Apache-2.0
"""A node whose parameters take an integer for a float, and whose read-only parameters accept the value that they have.

`ros2 param load` sets every parameter of a dump, also those that are read-only; rclpy refuses them even where nothing
changes.
"""

from rcl_interfaces.msg import SetParametersResult
from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.node import Node
from rclpy.parameter import Parameter

from eel_ros.parameters import did_you_mean

FLOATS = {  # declared type: the type that is converted, and how
    Parameter.Type.DOUBLE: (Parameter.Type.INTEGER, float),
    Parameter.Type.DOUBLE_ARRAY: (Parameter.Type.INTEGER_ARRAY, lambda values: [float(each) for each in values]),
}


class ParameterNode(Node):
    """A node with these rules for its parameters."""

    def set_parameters_atomically(self, parameters: list[Parameter]) -> SetParametersResult:
        """Set `parameters` at once. The reason that comes with a success is `answer_to` them."""
        changes = [self._as_declared(each) for each in parameters if not self._is_held(each)]
        if not changes:
            return SetParametersResult(successful=True)
        try:
            result = super().set_parameters_atomically(changes)
        except ParameterNotDeclaredException as error:
            hints = (did_you_mean(each.name, self.get_parameters_by_prefix("")) for each in changes)
            return SetParametersResult(successful=False, reason=f"{error}{next(filter(None, hints), '')}")
        if result.successful:
            result.reason = self.answer_to([each.name for each in changes])
        return result

    def answer_to(self, names: list[str]) -> str:
        """What the user is told of the parameters `names`, which have been set."""
        return ""

    def _as_declared(self, parameter: Parameter) -> Parameter:
        """The parameter with floats in place of integers, where floats were declared."""
        declared = self.get_parameter(parameter.name).type_ if self.has_parameter(parameter.name) else None
        given, convert = FLOATS.get(declared, (None, None))
        return Parameter(parameter.name, value=convert(parameter.value)) if parameter.type_ == given else parameter

    def _is_held(self, parameter: Parameter) -> bool:
        """Whether the parameter is read-only and has this value."""
        if not self.has_parameter(parameter.name) or not self.describe_parameter(parameter.name).read_only:
            return False
        wanted, present = self._as_declared(parameter), self.get_parameter(parameter.name)
        return (wanted.type_, wanted.value) == (present.type_, present.value)
