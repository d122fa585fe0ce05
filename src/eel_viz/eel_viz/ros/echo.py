# SPDX-License-Identifier: Apache-2.0
"""`eel echo`: print the messages of a topic as YAML, without `ros2`."""

import argparse
import array
import sys
import time
from typing import Any

import numpy as np
import yaml
from eel_common.command.command_line import Parser, check_seconds
from eel_common.ros.qos import fitting
from eel_common.ros.run_node import run_node
from eel_common.ros.serving import ServedNode
from eel_common.wording import shown
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.utilities import remove_ros_args

from eel_viz.bags.definitions import message_class

NAME, COMMAND = "eel_echo", "eel echo"
SHORT = 128  # elements of an array printed without --full-length


class Echo(ServedNode):
    """Waits for a publisher of the topic, adopts its type and quality of service, and prints its messages."""

    def __init__(self, options: argparse.Namespace) -> None:
        check_seconds("--timeout", options.timeout)
        super().__init__(NAME)
        self._options = options
        self._topic = self.resolve_topic_name(options.topic)
        self._subscription: Any = None
        self._began = time.monotonic()
        self.printed = 0
        self.failure = ""

    def poll(self) -> bool:
        """Look for a publisher. Returns False after the message of --once, an error or the time-out."""
        if self.failure or (self._options.once and self.printed):
            return False
        limit = self._options.timeout
        if limit is not None and time.monotonic() - self._began > limit and not self.printed:
            self.failure = f"no message on {self._topic} within {limit:g} s"
            return False
        if self._subscription is None:
            found = self.get_publishers_info_by_topic(self._topic)
            if found:
                self._subscribe(found)
        return True

    def _subscribe(self, found: list[TopicEndpointInfo]) -> None:
        try:
            kind = message_class(found[0].topic_type)
        except ValueError as error:
            self.failure = str(error)
            return
        quality = fitting([info.qos_profile for info in found])
        self._subscription = self.create_subscription(kind, self._topic, self._print, quality)

    def _print(self, message: Any) -> None:
        if self.failure or (self._options.once and self.printed):
            return
        try:
            value = picked(message, self._options.field)
        except ValueError as error:
            self.failure = str(error)
            return
        try:
            print(as_yaml(value, short=None if self._options.full_length else SHORT), end="---\n", flush=True)
        except BrokenPipeError:
            self.failure = "nobody reads the output"
        self.printed += 1


def picked(message: Any, field: str | None) -> Any:
    """`message`, or its value at `field`, such as pose.position.x or status.0.name. `ValueError` if it is missing."""
    value, path = message, []
    for name in field.split(".") if field else ():
        path.append(name)
        try:
            value = value[int(name)] if name.lstrip("-").isdigit() else getattr(value, name)
        except (AttributeError, IndexError, TypeError) as error:
            raise ValueError(f"field {shown('.'.join(path))} is not in {type(message).__name__}") from error
    return value


def as_yaml(value: Any, *, short: int | None = None) -> str:
    """YAML of a message or a part of it. Arrays are cut after `short` elements."""
    plain = _plain(value, short)
    text: str = yaml.safe_dump(plain, sort_keys=False, allow_unicode=True, default_flow_style=False, width=10**6)
    return text.replace("\n...\n", "\n")


def _plain(value: Any, short: int | None) -> Any:
    """The value with messages and arrays converted to dictionaries, lists and numbers."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: _plain(getattr(value, name), short) for name in value.get_fields_and_field_types()}
    if isinstance(value, bytes):
        return int.from_bytes(value, "little") if len(value) == 1 else list(value)
    if isinstance(value, (list, tuple, array.array, np.ndarray)):
        listed = [_plain(entry, short) for entry in value[:short]]
        return listed if short is None or len(value) <= short else [*listed, "..."]
    return value.item() if isinstance(value, np.generic) else value


def main(arguments: list[str] | None = None) -> int:
    """Run the command. Exit status: 0; 1 if no message came or it has no such field; 2 if it cannot start."""
    words = sys.argv if arguments is None else [NAME, *arguments]
    parser = Parser(
        prog=COMMAND,
        description="Print the messages of a topic as YAML, as ros2 topic echo does. It waits for a publisher, and "
        "takes its type and quality of service.",
        epilog="Exit status: 0; 1 if no message came or it has no such field, 2 if it cannot begin, with one line that "
        "says why. ROS arguments follow --ros-args.",
    )
    parser.add_argument("topic", help="name, such as internal_wrench or /left/head_pose")
    parser.add_argument("--once", action="store_true", help="print one message and end")
    parser.add_argument("--field", metavar="F", help="print this part alone, such as pose.position.x")
    parser.add_argument("--timeout", type=float, metavar="SECONDS", help="give up, with status 1, if nothing comes")
    parser.add_argument("-f", "--full-length", action="store_true", help=f"print arrays beyond {SHORT} elements")
    options = parser.parse_args(remove_ros_args(args=words)[1:])
    return run_node(COMMAND, words, lambda: Echo(options), Echo.poll)


if __name__ == "__main__":
    sys.exit(main())
