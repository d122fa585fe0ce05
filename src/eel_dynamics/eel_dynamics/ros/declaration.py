"""The node's ROS parameters, declared from the dataclasses `DynamicsParameters` and `Scene` (as `scene.*`)."""

from dataclasses import fields, replace

from eel_gaits.quantity import limits
from eel_ros.frames import frame_in
from eel_ros.parameters import declare, default_of, take_overrides, warn_of_unknown
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from eel_dynamics.model.scene import Scene
from eel_dynamics.ros.parameters import FRAMES, DynamicsParameters, checked, from_values


class Declaration:
    """Declares all parameters of `node`; `ValueError` names one that does not fit.

    Changes during the run are checked; an integer is accepted for a float. After a change `changed(values)` is called.

    Attributes:
        values: the present DynamicsParameters.
        scene: the Scene.
    """

    def __init__(self, node, changed):
        self._changed = changed
        overrides = take_overrides(node)
        space = node.get_namespace()
        frames = {name: frame_in(space, getattr(DynamicsParameters, name)) for name in FRAMES}
        self.values: DynamicsParameters = _declared(node, DynamicsParameters, frames | overrides, "")
        self.scene: Scene = _declared(node, Scene, overrides, "scene.")
        warn_of_unknown(node, overrides, [name for name in overrides if node.has_parameter(name)])
        self._fields = {item.name: item for item in fields(DynamicsParameters)}
        self._paced = self.values.real_time_factor > 0.0
        node.add_pre_set_parameters_callback(self._convert)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def _convert(self, parameters):
        """Before a set: convert integers to floats where needed; bad values are left for `_check`."""
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

    def _check(self, parameters) -> SetParametersResult:
        try:
            for parameter in parameters:
                item = self._fields.get(parameter.name)
                if item is None:
                    continue
                value = checked(item, parameter.value, item.name)
                if item.name == "real_time_factor" and (value > 0.0) != self._paced:
                    now = "> 0" if self._paced else "0 (as fast as possible)"
                    raise ValueError(f"real_time_factor was {now} at the start and has to stay so, got {value:g}")
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply(self, parameters):
        changes = {each.name: each.value for each in parameters if each.name in self._fields}
        if changes:
            self.values = replace(self.values, **changes)
            self._changed(self.values)


def _declared(node, kind: type, overrides: dict, prefix: str):
    """An instance of the dataclass `kind` from the user's `overrides` and the defaults, declared as parameters."""
    given = {item.name: overrides.get(prefix + item.name, default_of(item)) for item in fields(kind)}
    values = from_values(kind, given, prefix)
    declare(node, values, limits, prefix)
    return values
