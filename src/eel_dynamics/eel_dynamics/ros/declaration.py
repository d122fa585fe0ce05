# SPDX-License-Identifier: Apache-2.0
"""The node's ROS parameters, declared from the dataclasses `DynamicsParameters` and `Scene` (as `scene.*`)."""

from collections.abc import Mapping
from dataclasses import Field, fields, replace
from typing import Any

from eel_common.quantity import checked
from eel_common.ros.headers import frame_in
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.parameters import AT_RESET, declare, take_overrides, warn_of_unknown
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.body.text import body_of
from eel_dynamics.model.fins.text import fins_from_text
from eel_dynamics.model.flow.plain import flow_of
from eel_dynamics.model.flow.text import flow_from_text, text_of_flow
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.text import wrenches_from_text
from eel_dynamics.ros.parameters import FRAMES, ROOT, DynamicsParameters
from eel_dynamics.ros.simulation_from_parameters import Sensors, check_sensors, robot_from_parameters
from eel_dynamics.ros.wrench_frames import wrench_frames
from eel_dynamics.sensors.suite import KINDS

SCENE, FLOW, USE_SIM_TIME = "scene.", "flow.", "use_sim_time"


class Declaration:
    """Declares all parameters of `node`. `ValueError` names an invalid one.

    Changes during the run are checked. Some act at once. The others, and the whole scene, act at the next reset, which
    calls `begin`.

    Attributes:
        values: the DynamicsParameters in force.
        scene: the Scene in force.
        sensors: the settings of sensors in force, one for each of `KINDS`.
        next_values, next_scene, next_sensors: the same from the next reset on.
    """

    def __init__(self, node: ParameterNode) -> None:
        overrides, space = take_overrides(node), node.get_namespace()
        frames = {name: frame_in(space, getattr(DynamicsParameters, name)) for name in FRAMES}
        if space.strip("/") and overrides.get("world_frame") != ROOT:
            frames["root_frame"] = ROOT
        overrides = with_flow_as_text(overrides)
        self.values = DynamicsParameters.among(frames | overrides)
        self.scene = replace(Scene(), **_checked({SCENE + item.name: item for item in fields(Scene)}, overrides))
        declare(node, self.values)
        declare(node, self.scene, SCENE, AT_RESET)
        self.sensors: Sensors = tuple(
            kind(**_checked({f"{name}.{item.name}": item for item in fields(kind)}, overrides))
            for name, kind in KINDS.items()
        )
        for settings in self.sensors:
            declare(node, settings, f"{settings.what}.", AT_RESET)
        self.next_values, self.next_scene, self.next_sensors = self._planned = self.present
        self._fields = node.parameter_fields
        warn_of_unknown(node, overrides, self._fields)
        self._node, self._paced = node, self.values.real_time_factor > 0.0
        self._check_clock(self.values, node.get_parameter(USE_SIM_TIME).value)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    @property
    def present(self) -> tuple[DynamicsParameters, Scene, Sensors]:
        """Values, scene and sensors in force."""
        return self.values, self.scene, self.sensors

    @property
    def next(self) -> tuple[DynamicsParameters, Scene, Sensors]:
        """Values, scene and sensors from the next reset on."""
        return self.next_values, self.next_scene, self.next_sensors

    @property
    def pending(self) -> bool:
        """Whether a change waits for the next reset."""
        return self.next != self.present

    def answer_to(self, names: list[str]) -> str:
        """The answer to a change of the parameters `names`: when it acts. Empty if it acts at once."""
        later = [name for name in names if name in self._fields and not self._acts_at_once(name)]
        return f"acts {AT_RESET}" if later else ""

    def begin(self, values: DynamicsParameters, scene: Scene, sensors: Sensors) -> None:
        """Put these settings in force. Parameters that act at once keep their latest values."""
        at_once = {name: getattr(self.values, name) for name in self._fields if self._acts_at_once(name)}
        self.values, self.scene, self.sensors = replace(values, **at_once), scene, sensors

    def _acts_at_once(self, name: str) -> bool:
        return self._fields[name].metadata.get("changeable") is True

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        """Check a change of `parameters` together with the others. If it is valid, `_apply` follows."""
        given = {each.name: each.value for each in parameters}
        try:
            of_scene = {name: item for name, item in self._fields.items() if name.startswith(SCENE)}
            scene = replace(self.next_scene, **_checked(of_scene, given))
            sensors = tuple(
                replace(each, **_checked({f"{each.what}.{item.name}": item for item in fields(each)}, given))
                for each in self.next_sensors
            )
            own = {item.name for item in fields(DynamicsParameters)}
            found = {name: given[name] for name in own & given.keys()}
            values = replace(self.next_values, **found)
            if (values.real_time_factor > 0.0) != self._paced:
                now = "> 0" if self._paced else "0 (as fast as possible)"
                factor = values.real_time_factor
                raise ValueError(f"real_time_factor was {now} at the start and has to stay so, got {factor:g}")
            self._check_clock(values, given.get(USE_SIM_TIME, self._node.get_parameter(USE_SIM_TIME).value))
            if "body" in found:
                body_of(values.body)
            if found.keys() & {"robot", "servo_torque_limit"}:
                robot_from_parameters(values)
            if "flow" in found:
                flow_from_text(values.flow)
            if "fins" in found:
                fins_from_text(values.fins)
            if "wrenches" in found:
                wrenches_from_text(values.wrenches)
            if "wrench_frames" in found:
                wrench_frames(values)
            if "accuracy" in found:
                Accuracy.of(values.accuracy)
            if sensors != self.next_sensors or (found and any(each.rate for each in sensors)):
                check_sensors(values, sensors)
            self._planned = values, scene, sensors
        except (ValueError, OSError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _check_clock(self, values: DynamicsParameters, use_sim_time: Any) -> None:
        """`ValueError` if parameters ask the node both to publish /clock and to follow it."""
        if use_sim_time is True and values.makes_clock:
            raise ValueError(
                "use_sim_time must be false in the node that makes /clock, got true; with follow_clock:=true the node "
                "follows the /clock of another node"
            )

    def _apply(self, parameters: list[Parameter]) -> None:
        self.next_values, self.next_scene, self.next_sensors = self._planned
        names = [each.name for each in parameters if each.name in self._fields and self._acts_at_once(each.name)]
        self.values = replace(self.values, **{name: getattr(self.next_values, name) for name in names})


def with_flow_as_text(overrides: dict[str, Any]) -> dict[str, Any]:
    """The `overrides`, with a scene file's flow.kind ... or flow.NAME.kind ... replaced by the parameter `flow`."""
    fields: dict[str, dict[str, Any]] = {}
    for name in [name for name in overrides if name.startswith(FLOW)]:
        part, _, field = name.removeprefix(FLOW).rpartition(".")
        fields.setdefault(part, {})[field] = overrides[name]
    if not fields:
        return overrides
    flow = flow_of(list(fields.values()))
    assert flow is not None
    rest = {name: value for name, value in overrides.items() if not name.startswith(FLOW)}
    return {"flow": text_of_flow(flow), **rest}


def _checked(known: Mapping[str, Field[Any]], given: Mapping[str, Any]) -> dict[str, Any]:
    """The checked values of the `given` parameters that are `known`, by the name of their field."""
    return {item.name: checked(item, given[name], name) for name, item in known.items() if name in given}
