# SPDX-License-Identifier: Apache-2.0
"""ROS parameters from dataclasses: type, default, range and description come from the fields.

`eel_common.quantity` lists the metadata of a field.
"""

import contextlib
import math
import re
import sys
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import MISSING, Field, fields
from itertools import pairwise
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node

from eel_common.files.yaml_tree import read_yaml
from eel_common.quantity import AT_RESET, Quantities, limits
from eel_common.ros.parameter_node import ParameterNode, as_parameter
from eel_common.wording import did_you_mean, shown

ROS_PREFIXES = (
    "use_sim_time",
    "start_type_description_service",
    "qos_overrides.",
)  # ROS's own parameters
ALIKE = 0.8  # least likeness of a misspelt name, from 0 to 1; others belong to other nodes
FILE, VALUE, VALUES = "--params-file", ("-p", "--param"), "ros__parameters"
MAXIMUM_INTEGER = 2**63 - 1  # of an integer ROS parameter


def take_overrides(node: Node) -> dict[str, Any]:
    """The user's parameter overrides, by name.

    `node` has declared them. All except ROS's own are undeclared here, so that `declare` can declare them with type and
    range. A warning names each parameter file that is only for other nodes.
    """
    given: dict[str, Any] = node.get_parameters_by_prefix("")  # of `Parameter`s, not of values as rclpy says
    warn_of_other_nodes(node)
    overrides = {name: parameter.value for name, parameter in given.items()}
    for name in overrides:
        if not name.startswith(ROS_PREFIXES):
            node.undeclare_parameter(name)
    return overrides


def declare_all(node: ParameterNode, *kinds: type[Quantities]) -> list[Any]:
    """Declare the fields of these classes of `Quantities` as parameters, with the user's overrides, and return them.

    `ValueError` names an override that does not fit. A warning names overrides without a field.
    """
    overrides = take_overrides(node)
    made = [kind.among(overrides) for kind in kinds]
    for values in made:
        declare(node, values)
    warn_of_unknown(node, overrides, [item.name for kind in kinds for item in fields(kind)])
    return made


def warn_of_unknown(node: Node, overrides: Iterable[str], known: Collection[str]) -> None:
    """Warn of overrides that are not `known`; they are ignored.

    Overrides for all nodes (`/**` in a parameter file) may belong to another node, so of these only names that resemble
    a known one are reported.
    """
    unknown = [name for name in overrides if name not in known and not name.startswith(ROS_PREFIXES)]
    shared = shared_names(sys.argv) if unknown else set()
    hints = {name: did_you_mean(name, known, ALIKE) for name in unknown}
    named = [f"{name!r}{hint}" for name, hint in hints.items() if hint or name not in shared]
    if named:
        node.get_logger().warning(f"not parameters of this node, ignored: {', '.join(named)}")


def declare(node: ParameterNode, values: Any, prefix: str = "", changeable: bool | str | None = None) -> None:
    """Declare a parameter, named `prefix` and field, for each field of the dataclass instance `values`.

    changeable: replaces this entry of the metadata.
    """
    for item in fields(values):
        descriptor = _descriptor(item, changeable)
        value = as_parameter(getattr(values, item.name))
        node.parameter_fields[prefix + item.name] = item
        node.declare_parameter(prefix + item.name, value, descriptor, ignore_override=True)


def help_rows(kind: type[Any], prefix: str = "") -> Iterator[tuple[str, str, Any]]:
    """Name, description and default of each parameter of the dataclass `kind`."""
    for item in fields(kind):
        yield prefix + item.name, described(item), default_of(item)


def described(item: Field[Any]) -> str:
    """The description of a field, with its unit in brackets."""
    unit = item.metadata["unit"]
    return f"{item.metadata['description']} [{unit}]" if unit else str(item.metadata["description"])


def default_of(item: Field[Any]) -> Any:
    """The default of a field in the form of a ROS parameter: a list for a tuple, 0.0 for None."""
    assert item.default is not MISSING, item.name
    return as_parameter(item.default)


def _descriptor(item: Field[Any], changeable: bool | str | None) -> ParameterDescriptor:
    metadata = item.metadata
    if changeable is None:
        changeable = metadata.get("changeable", False)
    none = "; 0: not overridden" if item.default is None else ""
    when = f"; a change acts {AT_RESET}" if changeable == AT_RESET else ""
    descriptor = ParameterDescriptor(description=described(item) + none + when, read_only=not changeable)
    descriptor.dynamic_typing = metadata.get("number", False)
    low, high = metadata.get("minimum"), metadata.get("maximum")
    if "choices" in metadata:
        descriptor.additional_constraints = "one of " + ", ".join(metadata["choices"])
    elif low is not None or high is not None:
        descriptor.additional_constraints = limits(metadata)
        if isinstance(item.default, int):
            low, high = -MAXIMUM_INTEGER if low is None else int(low), MAXIMUM_INTEGER if high is None else int(high)
            descriptor.integer_range = [IntegerRange(from_value=low, to_value=high)]
        else:
            low, high = -math.inf if low is None else float(low), math.inf if high is None else float(high)
            descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    return descriptor


def shared_names(words: Sequence[str]) -> set[str]:
    """The names that the files in the command line `words` set for all nodes. An unreadable file sets none."""
    nodes = (each for _, found in _given_in(words) for each in found)
    return {name for node, values in nodes if "*" in node for name in _names_in(values)}


def warn_of_other_nodes(node: Node) -> None:
    """Warn of each parameter file and parameter in the command line that is only for other nodes."""
    own = node.get_fully_qualified_name()
    for option, nodes in _given_in(sys.argv):
        known = dict.fromkeys(name for name, _ in nodes)
        if known and not any(re.fullmatch(_pattern(name), own) for name in known):
            node.get_logger().warning(f"{option} is for {', '.join(known)}, not for this node, {own}: ignored")


def _pattern(node: str) -> str:
    """A regular expression for the node names that `node`, a key of a parameter file, matches; rclpy's rule."""
    return re.escape(node).replace(r"/\*\*", r"(/\w+)*").replace(r"/\*", r"(/\w+)")


def _given_in(words: Sequence[str]) -> Iterator[tuple[str, list[tuple[str, Any]]]]:
    """The options in the command line `words` that concern nodes by name, and for each the nodes and their content."""
    for option, word in pairwise(words):
        node, colon, name = word.partition(":=")[0].rpartition(":")
        if option == FILE:
            with contextlib.suppress(ValueError, OSError):  # ROS has already read it
                yield f"{option} {shown(word)}", list(_nodes_in(read_yaml(word)))
        elif option in VALUE and colon:
            yield f"{option} {shown(word)}", [("/" + node.strip("/"), {name: ""})]


def _nodes_in(content: Any, above: str = "") -> Iterator[tuple[str, Any]]:
    """The nodes in a parameter file, below the namespaces `above`, and their parameters."""
    for key, value in content.items() if isinstance(content, dict) else ():
        if key == VALUES:
            yield above, value
        else:
            own = str(key).strip("/")
            yield from _nodes_in(value, f"{above}/{own}" if own else above)


def _names_in(values: Any, above: str = "") -> Iterator[str]:
    """The full names of the parameters in `values`, with the prefix `above`."""
    for key, value in values.items() if isinstance(values, dict) else ():
        yield from _names_in(value, f"{above}{key}.") if isinstance(value, dict) else (f"{above}{key}",)
