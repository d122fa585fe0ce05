# SPDX-License-Identifier: Apache-2.0
"""The command line of a node: --help lists its parameters; non-ROS arguments are refused."""

import re
import sys
import textwrap
from collections.abc import Iterable
from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.utilities import remove_ros_args

from eel_common.command.command_line import print_to_stderr
from eel_common.wording import shown

USE_SIM_TIME = ("--ros-args", "-p", "use_sim_time:=true", "--")  # before the user's arguments, which override it
WIDTH, COLUMN = 100, 24  # characters of a line of --help, and of its column of names
POSITIONS = re.compile(r",? at \S+\.c:\d+")  # in the C sources of rcl


def handle_arguments(
    name: str,
    about: str,
    parameters: Iterable[tuple[str, str, Any]],
    words: list[str],
) -> int | None:
    """Handle the non-ROS arguments in `words` (the program first). Returns the exit status, or None to start the node.

    0 after -h or --help, which print `about` and the `parameters` (name, description, default). 2 for any other
    argument, or bad ROS arguments, after one line that explains it.
    """
    try:
        rest = remove_ros_args(words)[1:]
    except RuntimeError as error:  # from rcl's parser
        print_to_stderr(name, refusal(error))
        return 2
    if not rest:
        return None
    if not {"-h", "--help"} & set(rest):
        print_to_stderr(name, f"unknown argument {shown(rest[0])} (parameters come after --ros-args as -p NAME:=VALUE)")
        return 2
    lines = [f"usage: {name} [--ros-args -p NAME:=VALUE ...]", "", *about.splitlines(), "", "parameters:"]
    for key, description, default in parameters:
        shown_default = str(default).lower() if isinstance(default, bool) else "empty" if default == "" else default
        row = f"  {key:<{COLUMN}}  {description} (default {shown_default})"
        lines += textwrap.wrap(row, WIDTH, subsequent_indent=" " * (COLUMN + 4), break_on_hyphens=False)
    sys.stdout.write("\n".join([*lines, ""]))
    return 0


def refusal(error: RuntimeError) -> str:
    """The text of rcl's `error` for bad ROS arguments, without positions in its C sources."""
    text = str(error)
    if isinstance(error, rclpy_implementation.UnknownROSArgsError):  # its text is a list of the words
        return f"unknown ROS arguments {text.strip('[]')} (parameters come as -p NAME:=VALUE)"
    text = POSITIONS.sub("", text)
    return f"{text} (parameters come as -p NAME:=VALUE)" if "parameter" in text or "params" in text else text
