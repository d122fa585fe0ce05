# SPDX-License-Identifier: Apache-2.0
"""A node that answers each call and stands each message, and whose parameters take any number for a float.

Its read-only parameters accept the value that they have.
`ros2 param load` sets every parameter of a dump, also those that are read-only; rclpy refuses them even where nothing
changes. `ros2 param set` and `load` hand over 1e-06, nan and [1.0, 2] as texts: YAML 1.1 reads no number in the first
two, and rclpy no array in the third.
"""

from eel_base.wording import did_you_mean
from rcl_interfaces.msg import SetParametersResult
from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.parameter import Parameter

from eel_ros.serving import ServedNode

WRONG_TYPE = "Wrong parameter type"  # rclpy's words, which name neither parameter nor value
WORDS = {  # of the types that the nodes declare
    Parameter.Type.BOOL: "true or false",
    Parameter.Type.INTEGER: "an integer",
    Parameter.Type.DOUBLE: "a number",
    Parameter.Type.STRING: "a text",
    Parameter.Type.DOUBLE_ARRAY: "a list of numbers",
    Parameter.Type.STRING_ARRAY: "a list of texts",
}


def _number(value) -> float:
    if isinstance(value, bool):
        raise ValueError
    return float(value)


def _numbers(value) -> list[float]:
    if isinstance(value, str):  # such as [1.0, 2]
        value = value.strip().removeprefix("[").removesuffix("]").split(",")
    return [_number(each) for each in value]


CONVERTED = {  # declared type: the types that are converted, and how
    Parameter.Type.DOUBLE: ((Parameter.Type.INTEGER, Parameter.Type.STRING), _number),
    Parameter.Type.DOUBLE_ARRAY: ((Parameter.Type.INTEGER_ARRAY, Parameter.Type.STRING), _numbers),
}


class ParameterNode(ServedNode):
    """A node with these rules for its parameters."""

    def set_parameters_atomically(self, parameters: list[Parameter]) -> SetParametersResult:
        """Set `parameters` at once. The reason that comes with a success is `answer_to` them."""
        changes = [self._as_declared(each) for each in parameters if not self._is_held(each)]
        if not changes:
            return SetParametersResult(successful=True)
        try:
            result = super().set_parameters_atomically(changes)
        except ParameterNotDeclaredException:
            unknown = [each.name for each in changes if not self.has_parameter(each.name)]
            known = self.get_parameters_by_prefix("")
            told = "; ".join(f"no parameter {name!r}{did_you_mean(name, known)}" for name in unknown)
            return SetParametersResult(successful=False, reason=told)
        if result.successful:
            result.reason = self.answer_to([each.name for each in changes])
        elif result.reason.startswith(WRONG_TYPE):
            result.reason = "; ".join(filter(None, map(self._misfit, changes))) or result.reason
        return result

    def answer_to(self, names: list[str]) -> str:
        """What the user is told of the parameters `names`, which have been set."""
        return ""

    def _as_declared(self, parameter: Parameter) -> Parameter:
        """The parameter with floats in place of other numbers, where floats were declared."""
        declared = self.get_parameter(parameter.name).type_ if self.has_parameter(parameter.name) else None
        if declared not in CONVERTED or parameter.type_ not in CONVERTED[declared][0]:
            return parameter
        convert = CONVERTED[declared][1]
        try:
            return Parameter(parameter.name, declared, convert(parameter.value))
        except (TypeError, ValueError):
            return parameter

    def _misfit(self, parameter: Parameter) -> str:
        """What type the parameter must have, and the value that it got; empty where the type fits."""
        if not self.has_parameter(parameter.name) or self.describe_parameter(parameter.name).dynamic_typing:
            return ""
        declared = self.get_parameter(parameter.name).type_
        if parameter.type_ == declared or declared not in WORDS:
            return ""
        return f"{parameter.name} must be {WORDS[declared]}, got {parameter.value!r}"

    def _is_held(self, parameter: Parameter) -> bool:
        """Whether the parameter is read-only and has this value."""
        if not self.has_parameter(parameter.name) or not self.describe_parameter(parameter.name).read_only:
            return False
        wanted, present = self._as_declared(parameter), self.get_parameter(parameter.name)
        return (wanted.type_, wanted.value) == (present.type_, present.value)
