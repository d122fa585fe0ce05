# SPDX-License-Identifier: Apache-2.0
"""Functions of the package eel_viz, found by their entry points: it knows of this package, but is not needed by it."""

from collections.abc import Callable
from importlib.metadata import entry_points
from typing import Any, cast

Function = Callable[..., Any]


def messages_of_bag() -> Function:
    """The function (path, namespace) that yields topic and message of the swimmer in a bag.

    `ImportError` where eel_viz is not installed, or cannot be imported.
    """
    return _function("eel_dynamics.bags", "messages", "from_bag", "rosbags and rerun-sdk")


def joints_of_bag() -> Function:
    """The function (path, topic) that gives time, angles and names of the joints in a bag. `ImportError` as above."""
    return _function("eel_dynamics.bags", "joints", "a bag of joint angles", "rosbags")


def recorder_of_runs() -> Function:
    """The function (target, messages of each run, names, properties, **settings) that records runs to Rerun.

    `ImportError` where eel_viz is not installed, or cannot be imported.
    """
    return _function("eel_dynamics.drawing", "rerun", "to_rerun", "rerun-sdk")


def _function(group: str, name: str, user: str, needs: str) -> Function:
    found = entry_points(group=group, name=name)
    try:
        (function,) = (each.load() for each in found)
    except (ValueError, ImportError) as error:
        reason = error if found else "it is not installed"
        raise ImportError(f"{user} needs the package eel_viz, with {needs}: {reason}") from error
    return cast(Function, function)
