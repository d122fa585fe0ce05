# SPDX-License-Identifier: Apache-2.0
"""Starts a node, or reports in one line why it cannot start."""

import os
from collections.abc import Callable
from typing import TypeVar

import rclpy
from rclpy.exceptions import NameValidationException, ParameterException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport

from eel_common.command.command_line import print_to_stderr
from eel_common.ros.fastdds_profile import use_profile

Started = TypeVar("Started", bound=Node)

CANNOT_START = (
    ValueError,
    RuntimeError,
    OSError,
    ParameterException,
    NameValidationException,
    UnsupportedTypeSupport,
)
REPAIR = "a library of the messages is damaged or missing, `make clean build` makes all anew"


def start(name: str, words: list[str], make: Callable[[], Started]) -> Started | None:
    """Initialise rclpy with the command line `words` (the program first) and return the node that `make()` returns.

    If that fails, one line on stderr gives the reason: no more files can be opened, even if another error came of it;
    or the error, with the command that repairs a damaged build. The result is then None.
    """
    use_profile()
    try:
        rclpy.init(args=words, signal_handler_options=SignalHandlerOptions.NO)
        return make()
    except CANNOT_START as error:
        damaged = isinstance(error, UnsupportedTypeSupport) or "type support" in str(error).lower()
        print_to_stderr(name, _no_more_files() or (f"{REPAIR}: {error}" if damaged else error))
        rclpy.try_shutdown()
        return None


def _no_more_files() -> str:
    """An error text if no more files can be opened; otherwise empty."""
    try:
        os.close(os.open(os.devnull, os.O_RDONLY))
    except OSError as error:
        return f"{error.strerror} (ulimit -n raises the limit)"
    return ""
