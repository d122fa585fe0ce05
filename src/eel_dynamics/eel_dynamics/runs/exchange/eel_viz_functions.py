# SPDX-License-Identifier: Apache-2.0
"""Functions of the package eel_viz, found by their entry points: it knows of this package, but is not needed by it."""

from collections.abc import Callable
from importlib.metadata import entry_points
from typing import Any, cast

from eel_common.wording import bring_viz

FUNCTIONS = {  # by name: the group of its entry points, what uses it, and what it needs
    "messages": ("eel_dynamics.bags", "from_bag", "rosbags and rerun-sdk"),  # of a bag: (path, namespace)
    "joints": ("eel_dynamics.bags", "a bag of joint angles", "rosbags"),  # time, angles and names: (path, topic)
    "rerun": ("eel_dynamics.drawing", "to_rerun", "rerun-sdk"),  # (target, messages of runs, names, properties, **how)
}


def function_of_eel_viz(name: str) -> Callable[..., Any]:
    """One of the `FUNCTIONS`. `ImportError` where eel_viz is not installed, or cannot be imported."""
    group, user, needs = FUNCTIONS[name]
    found = entry_points(group=group, name=name)
    try:
        (function,) = (each.load() for each in found)
    except (ValueError, ImportError) as error:
        reason = error if found else "it is not installed"
        raise ImportError(f"{user} needs the package eel_viz, with {needs}: {reason}; {bring_viz()}") from error
    return cast(Callable[..., Any], function)
