# SPDX-License-Identifier: Apache-2.0
"""The command `eel`: lists the commands of all installed packages, and runs one.

A package declares its commands as entry points of one of the groups below:
`simulate = eel_dynamics.commands.simulate`. The module has `main(arguments)`, which returns the exit status. The first
line of its docstring says what the command does, after a colon. The list reads that line without importing the module.
"""

import argparse
import importlib
import os
import platform
import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec
from pathlib import Path

import eel_command

from eel_common.command.command_line import COMPLETING, Parser, print_to_stderr
from eel_common.version import software
from eel_common.wording import bring_viz, did_you_mean, one_line, shown

OF_VIZ = "eel_viz."  # begins the modules that need the extra viz
VERSION = "eel.version"  # group of entry points: what is compiled, and a function that tells how
FIRST = "simulate"  # of its group; the others follow by name
GROUPS = {  # of entry points: heading in the list
    "eel.commands.swim": "swim",
    "eel.commands.study": "study",
    "eel.commands.look": "record and look",
    "eel.commands.shell": "shell",
}


def commands() -> dict[str, EntryPoint]:
    """The installed commands by name, in the order of `GROUPS`."""
    found = {group: entry_points(group=group) for group in GROUPS}
    rank = lambda entry: (entry.name != FIRST, entry.name)  # noqa: E731
    return {entry.name: entry for entries in found.values() for entry in sorted(entries, key=rank)}


def main(arguments: list[str] | None = None) -> int:
    """Return the exit status of the command; 0 after the list; 2 if it is unknown or cannot be imported."""
    words = sys.argv[1:] if arguments is None else arguments
    if COMPLETING in os.environ:
        words = _typed_before_the_cursor()
    known = commands()
    if words and words[0] in known:
        module = known[words[0]].value
        eel_command.begin(module, f"eel {words[0]}")
        try:
            command = importlib.import_module(module)
        except ImportError as error:  # a package of an extra, or a processor for which nothing is compiled
            hint = f"; {bring_viz()}" if module.startswith(OF_VIZ) and isinstance(error, ModuleNotFoundError) else ""
            print_to_stderr(f"eel {words[0]}", f"{error}{hint}")
            return 2
        status: int = command.main(words[1:])
        return status
    parser = _parser(known)
    if words and not words[0].startswith("-"):
        parser.error(f"no command {shown(words[0])}{did_you_mean(words[0], known)}")
    if parser.parse_args(words).version:
        print("\n".join(_versions()))
    else:
        parser.print_help()
    return 0


def _versions() -> Iterator[str]:
    """Version and commit, what is compiled, Python, and ROS: a line each."""
    yield software()
    for entry in entry_points(group=VERSION):
        try:
            compiled = entry.load()()
        except ImportError as error:
            yield f"{entry.name}: {one_line(error)}"
        else:
            yield f"{entry.name}: {compiled['level']}, {compiled['compiler'].strip()}"
    yield f"Python {platform.python_version()}, {sys.executable}"
    yield f"ROS 2 {os.environ.get('ROS_DISTRO', 'of an unknown name')}" if find_spec("rclpy") else "no ROS 2 (no rclpy)"


def summary_of(module: str) -> str:
    """The text after the colon in the first line of the `module`'s docstring, read without importing it."""
    package, *parts = module.split(".")
    spec = find_spec(package)
    path = Path(spec.submodule_search_locations[0], *parts) if spec and spec.submodule_search_locations else Path()
    with path.with_suffix(".py").open(encoding="utf-8") as lines:
        line = next(line for line in lines if line.startswith('"""'))
    return line.strip().strip('"').partition(": ")[2].rstrip(".")


def _parser(known: dict[str, EntryPoint]) -> Parser:
    rows = ["The simulator of elongated swimmers."]
    for group, heading in GROUPS.items():
        own = [entry for entry in known.values() if entry.group == group]
        rows += ["", f"{heading}:", *(f"  {each.name:<11s} {summary_of(each.value)}" for each in own)] if own else []
    parser = Parser(
        prog="eel",
        usage="eel COMMAND ...",
        description="\n".join(rows),
        epilog="eel COMMAND --help: its options. Nodes start by their names, or by ros2 run.",
    )
    parser.add_argument("--version", action="store_true", help="version, commit, level of the processor, Python, ROS")
    parser.add_argument("command", nargs="?", choices=known, help=argparse.SUPPRESS)
    return parser


def _typed_before_the_cursor() -> list[str]:
    """The command named in the line that the shell completes; empty while its name is being typed. The command's own
    parser completes the rest."""
    words = os.environ["COMP_LINE"].split()
    if len(words) < 2 or (len(words) == 2 and not os.environ["COMP_LINE"][-1].isspace()):
        return []
    os.environ[COMPLETING] = "2"  # argcomplete: the number of the word that is the command's name
    return words[1:2]
