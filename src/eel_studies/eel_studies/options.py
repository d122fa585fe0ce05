# SPDX-License-Identifier: Apache-2.0
"""Options shared by the commands of studies: the scene under study, ranges, and counts."""

import argparse

from eel_common.command.command_line import Parser
from eel_common.wording import shown
from eel_dynamics.commands.options import add_changes, add_options, named_texts, set_numbers, swim_from

from eel_dynamics import Swim
from eel_studies.points import point_at

ABOUT = "a .yaml file (docs/howto/scenes.md), or a gait by name"


def add_scene_options(parser: Parser, *left_out: str, several: bool = False) -> None:
    """Add the options that `chosen` reads to the `parser`, except those `left_out`. several: for several scenes."""
    parser.add_argument("swim", nargs="*" if several else "?", metavar="SCENE", help=f"{ABOUT} (falling)")
    add_options(parser, "--set")
    add_changes(parser, *left_out)


def chosen(base: str | Swim | None, options: argparse.Namespace) -> Swim:
    """The `base`, a swim or the name of a file or gait (None: falling), changed by the `options`."""
    swim, numbers = swim_from(base or "falling", options), set_numbers(options.set)
    return point_at(numbers, swim, {}, swim) if numbers else swim


def ranges_of(option: str, texts: list[str], bounds: str = "") -> dict[str, tuple[float, float]]:
    """The two numbers by name from an `option` NAME=LOW:HIGH. bounds: rule for them, in the words of an error."""
    found = {}
    for name, text in named_texts(option, texts):
        try:
            low, high = map(float, text.split(":"))
        except ValueError:
            raise ValueError(f"{option} must be NAME=LOW:HIGH{bounds}, got {shown(f'{name}={text}')}") from None
        found[name] = (low, high)
    return found


def check_least(options: argparse.Namespace, **least: int) -> None:
    """`ValueError` for an option below its `least` value."""
    for name, low in least.items():
        if getattr(options, name) < low:
            raise ValueError(f"--{name} must be {low} or more, got {getattr(options, name)}")
