# SPDX-License-Identifier: Apache-2.0
"""The scene that a command is about: a file, or a gait by name, and the options that change it."""

import argparse
from typing import Any

from eel_base.command.command_line import Parser

from eel_dynamics.commands.options import add_options, scene_fields
from eel_dynamics.runs.scene_file import SUFFIXES, load_scene, swim_of
from eel_dynamics.runs.swim import Swim

CHANGES = "--scene", "--body", "--flow", "--robot", "--fins", "--duration", "--accuracy", "--sample-period"
FIELDS = "body", "flow", "robot", "fins", "duration", "accuracy", "sample_period", "stations"  # words of a file


def add_changes(parser: Parser, *left_out: str, **defaults: Any) -> None:
    """Add the options that `swim_from` takes to the `parser` of a command, but those `left_out`.

    defaults: as in `add_options`.
    """
    own = dict.fromkeys(("body", "accuracy", "duration", "sample_period"), (None, "the scene's"))
    add_options(parser, *(each for each in CHANGES if each not in left_out), **own | defaults)


def swim_from(name: str, options: argparse.Namespace, **words: Any) -> Swim:
    """The swim of the file called `name`, or of the gait, with what the `options` of `add_changes` change.

    words: further ones of a file, before those of the options.
    """
    swim = load_scene(name) if name.endswith(SUFFIXES) else swim_of({"gait": name})
    given = {field: getattr(options, field, None) for field in FIELDS}
    words |= {field: value for field, value in given.items() if value not in (None, "")}
    return swim_of({**words, "scene": {**words.get("scene", {}), **scene_fields(options.scene)}}, swim)
