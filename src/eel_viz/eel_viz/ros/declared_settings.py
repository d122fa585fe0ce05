# SPDX-License-Identifier: Apache-2.0
"""Declares the parameters of a node from a dataclass of settings."""

from dataclasses import fields
from typing import TypeVar

from eel_ros.parameters import declare, default_of, take_overrides, warn_of_unknown
from rclpy.node import Node

from eel_viz.settings import Drawing

Kind = TypeVar("Kind", bound=Drawing)


def declared_settings(node: Node, kind: type[Kind]) -> Kind:
    """Settings of the `kind` from the user's overrides, each a read-only parameter; `ValueError` names a bad one."""
    overrides = take_overrides(node)
    values = {item.name: overrides.get(item.name, default_of(item)) for item in fields(kind)}
    settings = kind.from_values(values)
    declare(node, settings)
    warn_of_unknown(node, overrides, values)
    return settings
