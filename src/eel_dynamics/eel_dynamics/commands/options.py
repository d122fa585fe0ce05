# SPDX-License-Identifier: Apache-2.0
"""The options shared by commands, each defined once with its help; their checked values, and the scene made from them.

A value of NAME=VALUE is a number, true or false (on or off), or a word.
"""

import argparse
import inspect
from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np
from eel_common.command.command_line import Parser
from eel_common.texts import TRUTH, value_of
from eel_common.wording import shown
from eel_gaits.gaits.registry import GAITS, find

from eel_dynamics.accuracy.accuracy import PRESETS, STANDARD
from eel_dynamics.model.body.body import NAMED
from eel_dynamics.model.flow.text import NAMES
from eel_dynamics.model.robot.ready import READY
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.scene_file import SUFFIXES, load_scene, swim_of
from eel_dynamics.runs.settled_duration import UNTIL_SETTLED, until_settled
from eel_dynamics.runs.swim import Swim

OF_PARTS = "--scene", "--body", "--flow", "--robot", "--fins", "--wrenches"
CHANGES = *OF_PARTS, "--duration", "--accuracy", "--sample-period"
PARTS = "body", "flow", "robot", "fins", "wrenches"
FIELDS = *PARTS, "duration", "accuracy", "sample_period", "stations"  # keys of a scene file


def add_options(parser: Parser, *options: str, **defaults: Any) -> None:
    """Add shared `options` to the `parser` of a command.

    defaults: of options by name, shown in their help. A pair (None, text) describes a default that the command itself
    determines.
    """
    for option in options:
        about = OPTIONS[option]
        default = defaults.get(option.strip("-").replace("-", "_"), about.get("default"))
        default, shown_default = default if isinstance(default, tuple) else (default, default)
        text = f"{about['help']} ({shown_default})" if shown_default else about["help"]
        names = ("-o", option) if option == "--out" else (option,)
        added: Any = parser.add_argument(*names, **{**about, "default": default, "help": text.replace("%", "%%")})
        if "gait" in option:
            added.completer = lambda **_: GAITS  # for argcomplete
    if "gait" in options:
        parser.add_argument("-h", "--help", nargs="?", metavar="GAIT", action=_Help, help="this, or a gait's numbers")


def add_repeated(
    parser: argparse.ArgumentParser, option: str, metavar: str, about: str, required: bool = False
) -> None:
    """Add an `option` that may be repeated to the `parser` of a command. Its value is a list."""
    parser.add_argument(option, **_repeated(metavar, about), required=required)


def _repeated(metavar: str, about: str) -> dict[str, Any]:
    return {"action": "append", "default": [], "metavar": metavar, "help": f"{about}; may be repeated"}


class _Help(argparse.Action):
    """Prints the help of the command, or of a gait if one is named."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        given = getattr(namespace, "gait", None)
        name = values or (None if given == parser.get_default("gait") else given)
        try:
            print(f"{name}: {inspect.getdoc(find(name))}" if isinstance(name, str) else parser.format_help())
        except ValueError as error:
            parser.error(str(error))
        parser.exit()


def named_texts(option: str, texts: list[str]) -> list[tuple[str, str]]:
    """The names and values of an `option`. `ValueError` for anything but NAME=VALUE."""
    pairs = [text.partition("=") for text in texts]
    for (name, _, value), text in zip(pairs, texts, strict=True):
        if not name or not value:
            raise ValueError(f"{option} must be NAME=VALUE, got {shown(text)}")
    check_names([name for name, _, _ in pairs])
    return [(name, value) for name, _, value in pairs]


def check_names(names: list[str]) -> None:
    """`ValueError` if a name is given twice."""
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"{name} must be given once, got it {names.count(name)} times")


def set_numbers(texts: list[str], option: str = "--set") -> dict[str, float]:
    """The numbers of an `option`, by name, such as those of a gait in --set."""
    found = {}
    for name, text in named_texts(option, texts):
        found[name] = value_of(text)
        if not isinstance(found[name], float):
            raise ValueError(f"{option} must be NAME=NUMBER, got {shown(f'{name}={text}')}")
    return found


def duration_option(text: str) -> float | str:
    """The value of --duration: seconds, or the word settled."""
    try:
        return text if until_settled(text) else float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"must be a number of seconds, or {UNTIL_SETTLED}, got {shown(text)}"
        ) from None


def scene_of(texts: list[str], base: Scene | None = None) -> Scene:
    """The scene `base`, or the default one, changed by --scene. `ValueError` names an unknown field."""
    return (base or Scene()).changed(scene_fields(texts))


def scene_fields(texts: list[str]) -> dict[str, Any]:
    """The fields of --scene by name; the names are not checked."""
    known = {item.name: item for item in fields(Scene)}
    found: dict[str, Any] = {}
    for name, text in named_texts("--scene", texts):
        item = known.get(name)
        if item is not None and isinstance(item.default, bool):
            found[name] = {"1": True, "0": False, **TRUTH}.get(text.lower(), text)
        elif item is not None and "choices" in item.metadata:
            found[name] = text
        else:
            found[name] = value_of(text)
    return found


def varied_values(text: str, check_count: Callable[[int], None]) -> list[Any]:
    """The values of --vary: a,b,c or start:end:count. `ValueError` for anything else.

    check_count(count) may refuse the count before the values are made."""
    bounds = text.split(":")
    if len(bounds) != 3:
        return [value_of(part) for part in text.split(",")]
    try:
        start, end, count = float(bounds[0]), float(bounds[1]), int(bounds[2])
    except ValueError:
        count = 0
    if count < 1:
        raise ValueError(f"--vary must be NAME=start:end:count, count >= 1, or NAME=a,b,c, got {shown(text)}")
    check_count(count)
    values: list[Any] = np.linspace(start, end, count).tolist()
    return values


def add_changes(parser: Parser, *left_out: str, **defaults: Any) -> None:
    """Add the options that `swim_from` reads to the `parser` of a command, except those `left_out`.

    defaults: as in `add_options`.
    """
    own = dict.fromkeys(("body", "accuracy", "duration", "sample_period"), (None, "the scene's"))
    add_options(parser, *(each for each in CHANGES if each not in left_out), **own | defaults)


def swim_from(base: str | Swim, options: argparse.Namespace, **words: Any) -> Swim:
    """The `base`, a swim or the name of a file or gait, changed by the `options` of `add_changes`.

    words: further keys of a file, overridden by those of the options.
    """
    swim = base if isinstance(base, Swim) else load_scene(base) if base.endswith(SUFFIXES) else swim_of({"gait": base})
    given = {field: getattr(options, field, None) for field in FIELDS}
    words |= {field: value for field, value in given.items() if value not in (None, "")}
    return swim_of({**words, "scene": {**words.get("scene", {}), **scene_fields(options.scene)}}, swim)


OPTIONS = {  # the arguments for argparse
    "gait": {"nargs": "?", "help": f"one of {', '.join(sorted(GAITS))}"},
    "gaits": {"nargs": "*", "metavar": "GAIT", "help": f"of {', '.join(sorted(GAITS))}"},
    "--gait": {"metavar": "GAIT", "help": f"one of {', '.join(sorted(GAITS))}"},
    "--set": _repeated("NAME=VALUE", "a number of the gait, listed by --help GAIT"),
    "--scene": _repeated("NAME=VALUE", "physics, a field of the list that eel simulate --help ends with"),
    "--flow": {
        "default": "",
        "metavar": "FLOW",
        "help": f"how the water moves: {', '.join(NAMES)} with numbers, as 'shear velocity=0.1,0,0 width=0.5', a .nc "
        "file of a grid, or several with ' + ' between: docs/howto/flow.md",
    },
    "--robot": {
        "default": "",
        "metavar": "ROBOT",
        "help": f"what bends by itself, and follows the law: {', '.join(READY)}, or a .yaml or URDF file (this "
        "with joints=flush, or the drag coefficient of its links)",
    },
    "--fins": {
        "default": "",
        "metavar": "FINS",
        "help": "pair, left or right with numbers, as 'pair station=0.5 area=0.0015 aspect_ratio=2.5 k_p=4 k_d=0.5 "
        "time_constant=0.05', several with ' + ' between: docs/howto/fins.md",
    },
    "--wrenches": {
        "default": "",
        "metavar": "WRENCHES",
        "help": "wrenches from outside in the axes of their section or the world, as 'section station=0 force=2,0,0', "
        "several with ' + ' between: docs/howto/tow.md",
    },
    "--body": {
        "default": "boyer2010",
        "help": f"{', '.join(NAMED)}, a table or .npz file of half-axes, or links with their numbers, as 'links "
        "length=1 number=8 half_width=0.03 half_height=0.04 joints=flush'; what differs follows, as 'fish.csv "
        "base_drag=0.2'",
    },
    "--accuracy": {
        "default": STANDARD,
        "metavar": "TARGET",
        "help": f"{', '.join(PRESETS)}, or a target relative error",
    },
    "--duration": {
        "type": duration_option,
        "metavar": "SECONDS",
        "help": f"s, or {UNTIL_SETTLED}: until the gait has settled",
    },
    "--bare": {"action": "store_true", "help": "do not measure a run's own error; --accuracy is not kept"},
    "--sample-period": {
        "type": float,
        "default": (None, "0.05, or a 20th of the gait's period where that is less"),
        "metavar": "SECONDS",
        "help": "s; the last sample is at its last whole multiple within the duration",
    },
    "--scale": {"type": float, "default": 1.0, "metavar": "M", "help": "metres in the file's unit of length"},
    "--out": _repeated("FILE", ".png, .svg, .pdf: a picture; .csv: a table"),
}
