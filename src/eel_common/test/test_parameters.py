# SPDX-License-Identifier: Apache-2.0
"""Parameters from a dataclass: type, range and description of each, the user's values over the defaults."""

from dataclasses import dataclass, field

import pytest
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.parameters import declare, default_of, help_rows, take_overrides, warn_of_unknown
from eel_common.wording import shown
from rclpy.context import Context
from rclpy.parameter import Parameter


def entry(default, description, unit="", **metadata):
    return field(default=default, metadata={"description": description, "unit": unit, **metadata})


@dataclass(frozen=True)
class Tank:
    depth: float = entry(2.0, "of the water", "m", minimum=0.5)
    pumps: int = entry(1, "that run", minimum=0, maximum=3, changeable=True)
    wall: str = entry("glass", "what it is made of", choices=("glass", "steel"))
    label: str = entry("", "text on it")
    size: tuple = entry((4.0, 3.0), "length and width", "m")
    density: float | None = entry(None, "of the water", "kg/m^3", minimum=0.0)


@pytest.fixture
def make_node(ros_domain):
    """make_node(*words, kind): a node with these ROS arguments."""
    made = []

    def make(*words, kind=ParameterNode):
        context = Context()
        context.init(args=["--ros-args", *words], domain_id=ros_domain)
        node = kind(
            "tank",
            context=context,
            start_parameter_services=False,
        )
        made.append((node, context))
        return node

    yield make
    for node, context in made:
        node.destroy_node()
        context.try_shutdown()


def test_descriptors_tell_unit_range_choices_and_whether_it_changes(make_node):
    node = make_node()
    declare(node, Tank(), "tank.")
    depth, pumps, wall, size, density = (
        node.describe_parameter(f"tank.{name}") for name in ("depth", "pumps", "wall", "size", "density")
    )
    assert depth.description == "of the water [m]" and depth.additional_constraints == ">= 0.5 m"
    (bounds,) = depth.floating_point_range
    assert bounds.from_value == 0.5 and bounds.to_value == float("inf") and depth.read_only
    (bounds,) = pumps.integer_range
    assert (bounds.from_value, bounds.to_value) == (0, 3) and not pumps.read_only
    assert wall.additional_constraints == "one of glass, steel" and not wall.floating_point_range
    assert node.get_parameter("tank.size").value == [4.0, 3.0] and size.description == "length and width [m]"
    assert node.get_parameter("tank.density").value == 0.0 and density.description.endswith("; 0: not overridden")


def test_a_declared_parameter_is_set_within_its_range_alone(make_node):
    node = make_node()
    declare(node, Tank())
    for value, successful in ((2, True), (4, False), (2.0, False)):
        (result,) = node.set_parameters([Parameter("pumps", value=value)])
        assert result.successful == successful, value
    (result,) = node.set_parameters([Parameter("depth", value=3.0)])
    assert not result.successful, "not changeable"
    assert node.get_parameter("pumps").value == 2 and node.get_parameter("depth").value == 2.0


def test_numbers_in_any_form_are_taken_for_floats_and_misfits_are_named(make_node):
    """`ros2 param set` hands over 1e-06, nan and [1.0, 2] as texts."""
    node = make_node()
    declare(node, Tank(), changeable=True)
    for name, given, held in (
        ("depth", 7, 7.0),
        ("depth", "1e+02", 100.0),
        ("size", [1, 2], [1.0, 2.0]),
        ("size", "[1.0, 2e-3]", [1.0, 0.002]),
        ("label", "1e-06", "1e-06"),
    ):
        result = node.set_parameters_atomically([Parameter(name, value=given)])
        assert result.successful, result.reason
        assert node.get_parameter(name).value == held and type(node.get_parameter(name).value) is not int
    for name, given, reason in (
        ("depth", "deep", "depth must be a number, got 'deep'"),
        ("depth", True, "depth must be a number, got True"),
        ("size", "[1.0, [2]]", "size must be 2 finite numbers, got [1.0, [2]]"),
        ("size", "[1.0, true]", "size must be 2 finite numbers, got [1.0, True]"),
        ("pumps", "two", "pumps must be an integer, got 'two'"),
        ("pump", 2, "no parameter 'pump' (did you mean 'pumps'?)"),
    ):
        result = node.set_parameters_atomically([Parameter(name, value=given)])
        assert not result.successful and result.reason == reason
    assert (node.get_parameter("depth").value, node.get_parameter("pumps").value) == (100.0, 1)


def test_changeable_for_all_replaces_the_metadata(make_node):
    node = make_node()
    declare(node, Tank(), changeable=True)
    (result,) = node.set_parameters([Parameter("depth", value=3.0)])
    assert result.successful


def test_overrides_are_taken_with_their_own_type_and_ros_keeps_its_own(make_node):
    node = make_node("-p", "depth:=7", "-p", "colour:=blue", "-p", "use_sim_time:=true")
    overrides = take_overrides(node)
    assert overrides["depth"] == 7 and isinstance(overrides["depth"], int) and overrides["colour"] == "blue"
    assert not node.has_parameter("depth") and not node.has_parameter("colour")
    assert node.get_parameter("use_sim_time").value is True
    declare(node, Tank(depth=float(overrides["depth"])))
    assert node.get_parameter("depth").value == 7.0


def test_unknown_overrides_are_named_in_one_warning(make_node, monkeypatch):
    node, lines = make_node("-p", "depth:=7", "-p", "colour:=blue", "-p", "lid:=true"), []
    monkeypatch.setattr(type(node.get_logger()), "warning", lambda logger, text: lines.append(text))
    overrides = take_overrides(node)
    warn_of_unknown(node, overrides, ["depth"])
    assert lines == ["not parameters of this node, ignored: 'colour', 'lid'"]
    warn_of_unknown(node, overrides, ["depth", "colour", "lid"])
    assert len(lines) == 1


@pytest.mark.parametrize(
    ("file", "words", "told"),
    [
        ("tank: {ros__parameters: {depth: 1.0}}", (), ""),
        ("/**: {ros__parameters: {depth: 1.0}}", ("-r", "__ns:=/a/b"), ""),
        ("/*/tank: {ros__parameters: {depth: 1.0}}", ("-r", "__ns:=/a"), ""),
        ("a: {tank: {ros__parameters: {depth: 1.0}}}", ("-r", "__ns:=/a"), ""),
        ("/: {tank: {ros__parameters: {depth: 1.0}}}", (), ""),
        ("pump: {ros__parameters: {}}\ntank: {ros__parameters: {depth: 1.0}}", (), ""),
        ("/**: {ros__parameters: {depth: 1.0}}\npump: {ros__parameters: {rate: 1}}", (), ""),
        ("pool: {ros__parameters: {depth: 1.0}}", ("-r", "__node:=pool"), ""),
        ("pump: {ros__parameters: {depth: 1.0}}\n/a/tank: {ros__parameters: {depth: 1.0}}", (), "/pump, /a/tank"),
        ("tank: {ros__parameters: {depth: 1.0}}", ("-r", "__ns:=/a"), "/tank"),
        ("/*/tank: {ros__parameters: {depth: 1.0}}", (), "/*/tank"),
        ("tank: {ros__parameters: {depth: 1.0}}", ("-r", "__node:=pool"), "/tank"),
        (None, ("-p", "pump:depth:=1.0"), "/pump"),
        (None, ("-p", "tank:depth:=1.0"), ""),
    ],
)
@pytest.mark.fault(
    "parameters", "a parameter file, or a parameter, keyed to the name of another node", "WARN with both names"
)
def test_parameters_of_another_node_are_told_at_the_start(make_node, monkeypatch, tmp_path, file, words, told):
    """Just where rclpy takes none of them."""
    path, lines = tmp_path / "tank.yaml", []
    if file is not None:
        path.write_text(file)
        words = ("--params-file", str(path), *words)
    monkeypatch.setattr("sys.argv", ["tank", "--ros-args", *words])
    node = make_node(*words)
    monkeypatch.setattr(type(node.get_logger()), "warning", lambda logger, text: lines.append(text))
    overrides = take_overrides(node)
    own = node.get_fully_qualified_name()
    assert overrides.get("depth") == (None if told else 1.0)
    assert lines == ([f"{words[0]} {shown(words[1])} is for {told}, not for this node, {own}: ignored"] if told else [])


def test_help_rows_are_the_fields_with_units_and_defaults():
    assert next(help_rows(Tank, "tank.")) == ("tank.depth", "of the water [m]", 2.0)
    assert [default for _, _, default in help_rows(Tank)] == [2.0, 1, "glass", "", [4.0, 3.0], 0.0]


def test_a_field_without_a_default_is_an_error():
    @dataclass
    class Bare:
        depth: float = field(metadata={"description": "of the water", "unit": "m"})

    with pytest.raises(AssertionError, match="depth"):
        default_of(*Bare.__dataclass_fields__.values())
