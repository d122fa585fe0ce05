# SPDX-License-Identifier: Apache-2.0
"""The options that commands share: --set, --scene, --vary (NAME=VALUE, may be repeated), --body and --out.

A value is a number, true or false (on or off), or a word.
"""

from argparse import ArgumentParser, ArgumentTypeError
from collections.abc import Callable
from dataclasses import fields

import numpy as np
from eel_base.wording import shown

from eel_dynamics.model.body import NAMED, Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.settled_duration import UNTIL_SETTLED, until_settled

TRUTH = {"true": True, "on": True, "false": False, "off": False}


def add_repeated(parser: ArgumentParser, option: str, metavar: str, about: str, required: bool = False):
    """Add an `option` that may be repeated to the `parser` of a command; its value is a list."""
    about = f"{about}; may be repeated"
    parser.add_argument(option, action="append", default=[], metavar=metavar, required=required, help=about)


def named_texts(option: str, texts: list[str]) -> list[tuple[str, str]]:
    """The names and values of an `option`. `ValueError` for what is not NAME=VALUE."""
    pairs = [text.partition("=") for text in texts]
    for (name, _, value), text in zip(pairs, texts, strict=True):
        if not name or not value:
            raise ValueError(f"{option} must be NAME=VALUE, got {shown(text)}")
    check_names([name for name, _, _ in pairs])
    return [(name, value) for name, _, value in pairs]


def check_names(names: list[str]):
    """`ValueError` where a name is given twice."""
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"{name} must be given once, got it {names.count(name)} times")


def set_numbers(texts: list[str], option: str = "--set") -> dict[str, float]:
    """The numbers that an `option` gives, by name: those of a gait, of --set."""
    found = {}
    for name, text in named_texts(option, texts):
        try:
            found[name] = float(text)
        except ValueError:
            raise ValueError(f"{option} must be NAME=NUMBER, got {shown(f'{name}={text}')}") from None
    return found


def duration_option(text: str) -> float | str:
    """The value of --duration: seconds, or the word settled."""
    try:
        return text if until_settled(text) else float(text)
    except ValueError:
        raise ArgumentTypeError(f"must be a number of seconds, or {UNTIL_SETTLED}, got {shown(text)}") from None


def body_of(text: str) -> Body:
    """The body that --body gives: a name, or a file. `ValueError` where it does not fit; `OSError`: not readable."""
    return Body.named(text) if text in NAMED else Body.from_file(text)


def scene_of(texts: list[str], **defaults) -> Scene:
    """The scene that --scene gives. `ValueError` names the field that there is not, or whose value does not fit.

    defaults: fields that the command sets where --scene does not.
    """
    known = {item.name: item for item in fields(Scene)}
    found = dict(defaults)
    for name, text in named_texts("--scene", texts):
        if name not in known:
            raise ValueError(f"scene has no field {shown(name)}, it has: {', '.join(known)}")
        if isinstance(known[name].default, bool):
            found[name] = {"1": True, "0": False, **TRUTH}.get(text.lower(), text)
        elif "choices" in known[name].metadata:
            found[name] = text
        else:
            values = [value_of(part) for part in text.split(",")]
            found[name] = values[0] if len(values) == 1 else tuple(values)
    return Scene(**found)


def varied_values(text: str, check_count: Callable[[int], None]) -> list:
    """The values of --vary: a,b,c or start:end:count. `ValueError` where it is neither.

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
    return np.linspace(start, end, count).tolist()


def value_of(text: str):
    """A truth, a number, or the text itself."""
    if text.lower() in TRUTH:
        return TRUTH[text.lower()]
    try:
        return float(text)
    except ValueError:
        return text
