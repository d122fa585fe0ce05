# SPDX-License-Identifier: Apache-2.0
"""Starts a node, or reports in one line why it cannot start."""

from collections.abc import Callable

import rclpy
from rclpy.exceptions import NameValidationException, ParameterException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport

from eel_ros.fastdds_profile import use_profile

CANNOT_START = (
    ValueError,
    RuntimeError,
    OSError,
    ParameterException,
    NameValidationException,
    UnsupportedTypeSupport,
)
REPAIR = "a library of the messages is damaged or missing, `make clean build` makes all anew"


def start(
    name: str, words: list[str], make: Callable[[], Node], complain: Callable[[str, object], None]
) -> Node | None:
    """Initialise rclpy with the command line `words` (the program first) and return the node that `make()` returns.

    If that fails, `complain(name, error)` gets the reason, with the command that repairs a damaged build, and the
    result is None.
    """
    use_profile()
    try:
        rclpy.init(args=words, signal_handler_options=SignalHandlerOptions.NO)
        return make()
    except CANNOT_START as error:
        damaged = isinstance(error, UnsupportedTypeSupport) or "type support" in str(error).lower()
        complain(name, f"{REPAIR}: {error}" if damaged else error)
        rclpy.try_shutdown()
        return None
