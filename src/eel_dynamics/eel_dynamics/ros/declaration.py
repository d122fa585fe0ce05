# SPDX-License-Identifier: Apache-2.0
"""The node's ROS parameters, declared from the dataclasses `DynamicsParameters` and `Scene` (as `scene.*`)."""

from dataclasses import fields, replace

from eel_base.quantity import checked
from eel_ros.frames import frame_in
from eel_ros.parameters import AT_RESET, as_parameter, declare, default_of, take_overrides, warn_of_unknown
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.scene import Scene
from eel_dynamics.ros.parameters import FRAMES, ROOT, DynamicsParameters, from_values
from eel_dynamics.ros.simulation_from_parameters import body_of

SCENE, USE_SIM_TIME = "scene.", "use_sim_time"


class Declaration:
    """Declares all parameters of `node`; `ValueError` names one that does not fit.

    Changes during the run are checked; an integer is accepted for a float. Some act at once. The others, and all of
    the scene, act at the next reset: `begin` makes them the present ones.

    Attributes:
        values: the present DynamicsParameters.
        scene: the present Scene.
        next_values, next_scene: those of the next reset.
    """

    def __init__(self, node: Node) -> None:
        overrides = take_overrides(node)
        space = node.get_namespace()
        frames = {name: frame_in(space, getattr(DynamicsParameters, name)) for name in FRAMES}
        if space.strip("/") and overrides.get("world_frame") != ROOT:
            frames["root_frame"] = ROOT
        self.values: DynamicsParameters = _declared(node, DynamicsParameters, frames | overrides, "")
        self.scene: Scene = _declared(node, Scene, overrides, SCENE, AT_RESET)
        self.next_values, self.next_scene = self.values, self.scene
        self._fields = {item.name: item for item in fields(DynamicsParameters)}
        self._fields |= {SCENE + item.name: item for item in fields(Scene)}
        warn_of_unknown(node, overrides, self._fields)
        self._paced = self.values.real_time_factor > 0.0
        self._node = node
        self._check_clock(self.values, node.get_parameter(USE_SIM_TIME).value)
        node.add_pre_set_parameters_callback(self._convert)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    @property
    def pending(self) -> bool:
        """Whether a change waits for the next reset."""
        return (self.next_values, self.next_scene) != (self.values, self.scene)

    def answer_to(self, names: list[str]) -> str:
        """When the changes of the parameters `names` act; empty: at once."""
        later = [name for name in names if name in self._fields and not self._acts_at_once(name)]
        return f"acts {AT_RESET}" if later else ""

    def begin(self, values: DynamicsParameters, scene: Scene):
        """Make `values` and `scene` the present ones, but for what has been changed since and acts at once."""
        at_once = {name: getattr(self.values, name) for name in self._fields if self._acts_at_once(name)}
        self.values, self.scene = replace(values, **at_once), scene

    def _acts_at_once(self, name: str) -> bool:
        return not name.startswith(SCENE) and self._fields[name].metadata.get("changeable") is True

    def _convert(self, parameters):
        """Before a set: convert integers to floats where needed; bad values are left for `_check`."""
        return [self._converted(parameter) for parameter in parameters]

    def _converted(self, parameter):
        item = self._fields.get(parameter.name)
        try:
            if item is not None:
                return Parameter(parameter.name, value=as_parameter(checked(item, parameter.value, parameter.name)))
        except ValueError:
            pass
        return parameter

    def _check(self, parameters) -> SetParametersResult:
        try:
            given = self._checked(parameters)
            values, _ = self._changed_by(given)
            factor = values.real_time_factor
            if (factor > 0.0) != self._paced:
                now = "> 0" if self._paced else "0 (as fast as possible)"
                raise ValueError(f"real_time_factor was {now} at the start and has to stay so, got {factor:g}")
            simulated = [each.value for each in parameters if each.name == USE_SIM_TIME]
            self._check_clock(values, (*simulated, self._node.get_parameter(USE_SIM_TIME).value)[0])
            if "body" in given:
                body_of(values.body)
            if "accuracy" in given:
                Accuracy.of(values.accuracy)
        except (ValueError, OSError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _check_clock(self, values: DynamicsParameters, use_sim_time: bool):
        """`ValueError` where the node is to make /clock and to take its time from there."""
        if use_sim_time is True and values.makes_clock:
            raise ValueError(
                "use_sim_time must be false in the node that makes /clock, got true; with follow_clock:=true the node "
                "follows the /clock of another node"
            )

    def _checked(self, parameters) -> dict:
        """The values of this node's `parameters`, checked one by one."""
        ours = [each for each in parameters if each.name in self._fields]
        return {each.name: checked(self._fields[each.name], each.value, each.name) for each in ours}

    def _changed_by(self, given: dict) -> tuple[DynamicsParameters, Scene]:
        """Values and scene of the next reset after the changes `given`."""
        of_scene = {name.removeprefix(SCENE): value for name, value in given.items() if name.startswith(SCENE)}
        others = {name: value for name, value in given.items() if not name.startswith(SCENE)}
        return replace(self.next_values, **others), replace(self.next_scene, **of_scene)

    def _apply(self, parameters):
        given = self._checked(parameters)
        if given:
            self.next_values, self.next_scene = self._changed_by(given)
            self.values = replace(self.values, **{name: given[name] for name in given if self._acts_at_once(name)})


def _declared(node, kind: type, overrides: dict, prefix: str, changeable: str | None = None):
    """An instance of the dataclass `kind` from the user's `overrides` and the defaults, declared as parameters."""
    given = {item.name: overrides.get(prefix + item.name, default_of(item)) for item in fields(kind)}
    values = from_values(kind, given, prefix)
    declare(node, values, prefix, changeable)
    return values
