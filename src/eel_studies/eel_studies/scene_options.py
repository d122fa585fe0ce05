# SPDX-License-Identifier: Apache-2.0
"""The scene that a study is about: the options of its command."""

import argparse
from pathlib import Path

from eel_base.command.command_line import Parser
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.commands.options import add_options, scene_of, set_numbers
from eel_dynamics.runs.scene_file import SUFFIXES, load_scene
from eel_dynamics.runs.swim import Swim
from eel_gaits.gaits.settings import Settings
from eel_model.body.body import Body, body_of
from eel_model.fins.text import fins_from_text
from eel_model.scene import Scene

ABOUT = "a .yaml file (docs/howto/scenes.md), or a gait by name"


def add_scene_options(parser: Parser, several: bool = False) -> None:
    """Add the options of `swim_from` to the `parser` of a command. several: it takes more than one scene."""
    parser.add_argument("swim", nargs="*" if several else "?", metavar="SCENE", help=f"{ABOUT} (falling)")
    defaults = {"body": (None, "the scene's"), "accuracy": (None, "the scene's"), "duration": (None, "the scene's")}
    add_options(parser, "--set", "--scene", "--body", "--fins", "--duration", "--accuracy", **defaults)


def swim_from(name: str | None, options: argparse.Namespace) -> Swim:
    """The swim of the file called `name`, or of the gait, with what the other `options` change."""
    if name is not None and name.endswith(SUFFIXES):
        swim = load_scene(name)
    else:
        gait = Settings().changed({"gait": name or "falling"})
        swim = Swim(gait.law(), Body.boyer2010(), Scene(), Accuracy.of("standard"), gait=gait)
    numbers = set_numbers(options.set)
    swim = swim._replace(scene=scene_of(options.scene, swim.scene))
    swim = swim.with_gait(**numbers) if numbers else swim
    if options.fins:
        swim = swim._replace(fins=fins_from_text(options.fins))
    if options.body is not None:
        file = options.body if Path(options.body).suffix else ""
        swim = swim._replace(body=body_of(options.body), body_file=file)
    if options.accuracy is not None:
        swim = swim._replace(accuracy=Accuracy.of(options.accuracy))
    return swim if options.duration is None else swim._replace(duration=options.duration)
