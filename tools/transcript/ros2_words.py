# SPDX-License-Identifier: Apache-2.0
"""The words of the command `ros2` that the transcript uses, for a machine that has rclpy but no `ros2`.

Arguments and answers are those of ROS 2 Jazzy. `ros2 topic echo`, `ros2 bag record` and `ros2 run` are the suite's own
`eel_echo`, `record` and executables. Where a real `ros2` is on the PATH, the transcript takes that one.
"""

import argparse
import os
import statistics
import sys
import time
from collections.abc import Callable
from importlib import import_module
from itertools import pairwise

import rclpy
import yaml
from eel_ros.testing.node_process import found_executable
from eel_ros.testing.service_call import answer_of
from rcl_interfaces.msg import Parameter
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import get_parameter_value, parameter_dict_from_yaml_file, parameter_value_to_python
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data

LIMIT = 30.0  # s, until a node or a topic is found
OWN = {("topic", "echo"): "eel_echo", ("bag", "record"): "record"}
SECTIONS = ("Subscribers", "Publishers", "Service Servers")


class CannotAnswer(Exception):
    """The node, topic or type does not exist; its text says so."""


def wait_until(node: Node, condition: Callable[[], bool], what: str) -> None:
    """Spin `node` until the `condition` holds; CannotAnswer with `what` after LIMIT."""
    limit = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > limit:
            raise CannotAnswer(what)
        rclpy.spin_once(node, timeout_sec=0.05)


def called(node: Node, kind, name: str, request):
    """The answer of the service `name`."""
    client = node.create_client(kind, name)
    wait_until(node, client.service_is_ready, f"no service {name}")
    answer = answer_of(client, request)
    wait_until(node, lambda: answer() is not None, f"no answer from {name}")
    return answer()


def class_of(kind: str):
    """The Python class of a type such as std_srvs/srv/Trigger."""
    package, folder, name = kind.split("/")
    return getattr(import_module(f"{package}.{folder}"), name)


def fill(message, values: dict) -> None:
    """Set fields of the `message` from nested dictionaries."""
    for name, value in values.items():
        if isinstance(value, dict):
            fill(getattr(message, name), value)
        else:
            kind = message.get_fields_and_field_types()[name]
            setattr(message, name, float(value) if kind == "double" else value)


def param_list(node: Node, options) -> None:
    for name in parameter_names(node, options.node):
        print(f"  {name}")


def parameter_names(node: Node, of: str) -> list[str]:
    return sorted(called(node, ListParameters, f"{of}/list_parameters", ListParameters.Request()).result.names)


def parameter_values(node: Node, of: str, names: list[str]) -> list:
    answer = called(node, GetParameters, f"{of}/get_parameters", GetParameters.Request(names=names))
    return [parameter_value_to_python(value) for value in answer.values]


def param_get(node: Node, options) -> None:
    words = {bool: "Boolean", int: "Integer", float: "Double", str: "String"}
    (value,) = parameter_values(node, options.node, [options.name])
    if value is None:
        print("Parameter not set.")
    elif type(value) in words:
        print(f"{words[type(value)]} value is: {value}")
    else:
        print(f"{words[type(value[0])]} values are: {list(value)}")


def param_set(node: Node, options) -> None:
    parameter = Parameter(name=options.name, value=get_parameter_value(options.value))
    (result,) = set_parameters(node, options.node, [parameter])
    told = "Set parameter successful" if result.successful else "Setting parameter failed"
    print(told + (f": {result.reason}" if result.reason else ""))


def set_parameters(node: Node, of: str, parameters: list[Parameter]) -> list:
    request = SetParameters.Request(parameters=parameters)
    return called(node, SetParameters, f"{of}/set_parameters", request).results


def param_dump(node: Node, options) -> None:
    names, nested = parameter_names(node, options.node), {}
    for name, value in zip(names, parameter_values(node, options.node, names), strict=True):
        *groups, last = name.split(".")
        inner = nested
        for group in groups:
            inner = inner.setdefault(group, {})
        inner[last] = value if isinstance(value, (bool, int, float, str)) else list(value)
    print(yaml.dump({options.node: {"ros__parameters": nested}}, default_flow_style=False), end="")


def param_load(node: Node, options) -> None:
    parameters = list(parameter_dict_from_yaml_file(options.file, target_nodes=[options.node]).values())
    for parameter, result in zip(parameters, set_parameters(node, options.node, parameters), strict=True):
        told = "successful" if result.successful else "failed"
        print(f"Set parameter {parameter.name} {told}" + (f": {result.reason}" if result.reason else ""))


def service_call(node: Node, options) -> None:
    kind = class_of(options.kind)
    request = kind.Request()
    fill(request, yaml.safe_load(options.values))
    print(f"response:\n{called(node, kind, options.name, request)!r}")


def node_list(node: Node, options) -> None:
    settle(node)
    for name, space in sorted(node.get_node_names_and_namespaces(), key=lambda each: each[::-1]):
        if not name.startswith("_"):
            print(f"{space.rstrip('/')}/{name}")


def node_info(node: Node, options) -> None:
    space, _, name = options.node.rpartition("/")
    settle(node)
    print(options.node)
    asked = (
        node.get_subscriber_names_and_types_by_node,
        node.get_publisher_names_and_types_by_node,
        node.get_service_names_and_types_by_node,
    )
    for heading, ask in zip(SECTIONS, asked, strict=True):
        print(f"  {heading}:")
        for topic, kinds in sorted(ask(name, space or "/")):
            print(f"    {topic}: {', '.join(kinds)}")


def settle(node: Node) -> None:
    """Wait until the nodes, topics and services found have not changed for a second."""
    seen, since = None, time.monotonic()
    while time.monotonic() - since < 1.0:
        nodes, topics = node.get_node_names_and_namespaces(), node.get_topic_names_and_types()
        found = (nodes, topics, node.get_service_names_and_types())
        if found != seen:
            seen, since = found, time.monotonic()
        rclpy.spin_once(node, timeout_sec=0.05)


def topic_list(node: Node, options) -> None:
    settle(node)
    for topic, kinds in sorted(node.get_topic_names_and_types()):
        print(f"{topic} [{', '.join(kinds)}]" if options.types else topic)


def topic_hz(node: Node, options) -> None:
    """One line, after two seconds of messages; the real command goes on."""
    times = []
    wait_until(node, lambda: bool(node.get_publishers_info_by_topic(options.topic)), f"no topic {options.topic}")
    kind = class_of(node.get_publishers_info_by_topic(options.topic)[0].topic_type)
    node.create_subscription(kind, options.topic, lambda _: times.append(time.monotonic()), qos_profile_sensor_data)
    wait_until(node, lambda: len(times) > 2 and times[-1] - times[0] > 2.0, f"no messages on {options.topic}")
    gaps = [after - before for before, after in pairwise(times)]
    print(f"average rate: {1.0 / statistics.fmean(gaps):.3f}")


def topic_pub(node: Node, options) -> None:
    kind = class_of(options.kind)
    message = kind()
    fill(message, yaml.safe_load(options.values))
    reliability = ReliabilityPolicy[options.reliability.upper()]
    publisher = node.create_publisher(kind, options.topic, QoSProfile(depth=10, reliability=reliability))
    wait_until(node, lambda: publisher.get_subscription_count() > 0, f"no subscriber of {options.topic}")
    publisher.publish(message)
    print(f"publishing #1 on {options.topic}")
    end = time.monotonic() + 0.5  # as the real one: the message leaves before the process does
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(prog="ros2")
    groups = top.add_subparsers(required=True)

    def verb(group, name: str, action: Callable, *arguments: str) -> argparse.ArgumentParser:
        made = group.add_parser(name)
        made.set_defaults(action=action)
        for argument in arguments:
            made.add_argument(argument)
        return made

    param = groups.add_parser("param").add_subparsers(required=True)
    verb(param, "list", param_list, "node")
    verb(param, "get", param_get, "node", "name")
    verb(param, "set", param_set, "node", "name", "value")
    verb(param, "dump", param_dump, "node")
    verb(param, "load", param_load, "node", "file")
    service = groups.add_parser("service").add_subparsers(required=True)
    verb(service, "call", service_call, "name", "kind").add_argument("values", nargs="?", default="{}")
    node = groups.add_parser("node").add_subparsers(required=True)
    verb(node, "list", node_list)
    verb(node, "info", node_info, "node")
    topic = groups.add_parser("topic").add_subparsers(required=True)
    verb(topic, "list", topic_list).add_argument("-t", dest="types", action="store_true")
    verb(topic, "hz", topic_hz, "topic")
    pub = verb(topic, "pub", topic_pub, "topic", "kind", "values")
    pub.add_argument("--once", action="store_true", required=True)
    pub.add_argument("--qos-reliability", dest="reliability", default="reliable")
    return top


def main(words: list[str]) -> int:
    """Exit status: 0; 1 if what was asked for does not exist; that of the executable for `ros2 run`."""
    own = ("run", words[1]) if words[:1] == ["run"] else tuple(words[:2])
    if words[:1] == ["run"]:
        executable = found_executable(words[2])
        os.execvp(executable, [executable, *words[3:]])
    if own in OWN:
        os.execvp(OWN[own], [OWN[own], *words[2:]])
    options = parser().parse_args(words)
    rclpy.init()
    try:
        options.action(Node("_ros2cli", start_parameter_services=False), options)
    except CannotAnswer as reason:
        print(reason, file=sys.stderr)
        return 1
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
