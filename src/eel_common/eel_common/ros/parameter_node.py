# SPDX-License-Identifier: Apache-2.0
"""A node that survives every call and message, and checks its parameters by the fields that declare them.

Its read-only parameters accept their present value: `ros2 param load` sets every parameter of a dump, and rclpy would
refuse those that are read-only even if nothing changes. `ros2 param set` and `load` send 1e-06, nan and [1.0, 2] as
texts: YAML 1.1 does not read the first two as numbers, nor rclpy the third as an array.
"""

from dataclasses import Field
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.parameter import Parameter

from eel_common.files.yaml_tree import from_yaml
from eel_common.quantity import checked
from eel_common.ros.serving import ServedNode
from eel_common.wording import did_you_mean


class ParameterNode(ServedNode):
    """A node with these rules for its parameters. Other options are those of `Node`.

    Attributes:
        parameter_fields: the fields from which parameters have been declared, by the parameter's name.
    """

    def __init__(self, name: str, **options: Any) -> None:
        self.parameter_fields: dict[str, Field[Any]] = {}
        super().__init__(name, **{"automatically_declare_parameters_from_overrides": True, **options})

    def set_parameters_atomically(self, parameters: list[Parameter]) -> SetParametersResult:
        """Set all `parameters` or none. With a success, the reason holds `answer_to`."""
        try:
            changes = [each for each in map(self._as_declared, parameters) if not self._is_held(each)]
            if not changes:
                return SetParametersResult(successful=True)
            result = super().set_parameters_atomically(changes)
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        except ParameterNotDeclaredException:
            unknown = [each.name for each in parameters if not self.has_parameter(each.name)]
            known = self.get_parameters_by_prefix("")
            reason = "; ".join(f"no parameter {name!r}{did_you_mean(name, known)}" for name in unknown)
            return SetParametersResult(successful=False, reason=reason)
        if result.successful:
            result.reason = self.answer_to([each.name for each in changes])
        return result

    def answer_to(self, names: list[str]) -> str:
        """The text for the user after the parameters `names` have been set."""
        return ""

    def _as_declared(self, parameter: Parameter) -> Parameter:
        """The parameter with its value in the field's type. `ValueError` if it does not fit."""
        item = self.parameter_fields.get(parameter.name)
        if item is None or not self.has_parameter(parameter.name):
            return parameter
        value, first = parameter.value, item.default[0] if isinstance(item.default, tuple) else item.default
        if isinstance(value, str) and not isinstance(first, str):
            value = from_yaml(value)
        return Parameter(parameter.name, value=as_parameter(checked(item, value, parameter.name)))

    def _is_held(self, parameter: Parameter) -> bool:
        """Whether the parameter is read-only and has this value."""
        if not self.has_parameter(parameter.name) or not self.describe_parameter(parameter.name).read_only:
            return False
        present = self.get_parameter(parameter.name)
        return (parameter.type_, parameter.value) == (present.type_, present.value)


def as_parameter(value: Any) -> Any:
    """`value` in the form of a ROS parameter: a list for a tuple, 0.0 for None."""
    if value is None:
        return 0.0
    return list(value) if isinstance(value, tuple) else value
