# SPDX-License-Identifier: Apache-2.0
"""What users can give, and what they get, with defaults, units and bounds: one line each, as in interface.txt.

`tools/run.sh python test/interface.py` writes the file anew after a change that is meant.
"""

import argparse
import contextlib
import importlib
import pkgutil
from collections.abc import Iterator
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from unittest import mock

from eel_common.command.command_line import Parser
from eel_common.command.suite import commands
from eel_common.quantity import limits
from eel_common.topics import GLOBAL, OWN
from eel_dynamics.analysis.measures import MEASURES
from eel_dynamics.simulation.observations import OBSERVED
from eel_gaits.gaits.registry import GAITS
from eel_gaits.gaits.settings import FILE_GAITS, numbers_of
from eel_studies.scene_terms.terms import TERMS

from eel_gym import DepthEnv, HeadingEnv, WayPointsEnv

FILE = Path(__file__).with_name("interface.txt")
PACKAGES = "eel_common", "eel_gaits", "eel_dynamics", "eel_studies", "eel_gym", "eel_viz"


class Seen(Exception):
    """Carries the parser of a command, which goes no further."""


def text_of(value: object) -> str:
    """A plain value as it is written; of another, its type."""
    if isinstance(value, (tuple, list)):
        return f"({', '.join(map(text_of, value))})"
    plain = value is None or isinstance(value, (bool, int, float, str))
    return repr(value) if plain else f"a {type(value).__name__}"


def quantities(kind: type) -> Iterator[str]:
    """The fields of a dataclass that have a unit."""
    for item in fields(kind):
        if "unit" in item.metadata:
            default = "" if item.default is MISSING else f" = {text_of(item.default)}"
            allowed = text_of(list(item.metadata["choices"])) if "choices" in item.metadata else limits(item.metadata)
            yield f"{item.name}{default} [{item.metadata['unit']}] {allowed}".rstrip()


def classes() -> Iterator[type]:
    """All dataclasses of the packages with a quantity."""
    for package in map(importlib.import_module, PACKAGES):
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            try:
                module = importlib.import_module(found.name)
            except ImportError:  # of an extra that is not installed
                continue
            own = (each for each in vars(module).values() if isinstance(each, type) and each.__module__ == found.name)
            yield from (each for each in own if is_dataclass(each) and any("unit" in f.metadata for f in fields(each)))


def options(module: str) -> Iterator[str]:
    """The options and arguments of a command."""

    def stop(parser: Parser, *_: object) -> None:
        raise Seen(parser)

    with mock.patch.object(Parser, "parse_args", stop), contextlib.suppress(SystemExit):
        try:
            importlib.import_module(module).main([])
        except Seen as seen:
            for action in seen.args[0]._actions:
                if not isinstance(action, argparse._HelpAction):
                    name = " ".join(action.option_strings) or action.dest
                    more = "" if action.choices is None else f" of {text_of(sorted(map(str, action.choices)))}"
                    count = "" if action.nargs is None else f" x {action.nargs}"
                    must = " required" if action.required and action.option_strings else ""
                    yield f"{name} = {text_of(action.default)}{count}{more}{must}"


def lines() -> Iterator[str]:
    """The whole file."""
    for name, entry in commands().items():
        yield from (f"eel {name}: {option}" for option in options(entry.value))
    for kind in classes():
        yield from (f"{kind.__qualname__}: {each}" for each in quantities(kind))
    yield from (f"gait {name}: {numbers_of(name).__name__}" for name in sorted((*GAITS, *FILE_GAITS)))
    yield from (f"measure {name}: [{unit}]" for name, (unit, *_) in MEASURES.items())
    yield from (f"observed {name}: {text_of(each.dimensions)} [{each.unit}]" for name, each in OBSERVED.items())
    yield from (f"term {name}" for name in TERMS)
    for task in (DepthEnv, HeadingEnv, WayPointsEnv):
        yield from (f"{task.__name__} observes {text_of(each)}" for each in task.observed)
    yield from (f"topic {name}: {kind}" for name, kind in {**OWN, **GLOBAL}.items())


if __name__ == "__main__":
    FILE.write_text("".join(f"{line}\n" for line in lines()), encoding="utf-8")
