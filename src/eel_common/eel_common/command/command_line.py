# SPDX-License-Identifier: Apache-2.0
"""The command line of every command and node: one line per error, and output that every terminal can show."""

import argparse
import contextlib
import os
import re
import shutil
import signal
import sys
import textwrap
import warnings
from collections.abc import Iterable, Iterator
from typing import Any, NoReturn

from eel_common.wording import did_you_mean, not_one_of, one_line, shown

COMPLETING = "_ARGCOMPLETE"  # environment variable, set where a shell asks for completions


class Parser(argparse.ArgumentParser):
    """An argument parser that reports an error in one line, and wraps its texts line by line."""

    def __init__(self, *, description: str, epilog: str = "", **options: Any) -> None:
        super().__init__(
            description=_wrapped(description),
            epilog=_wrapped(epilog),
            formatter_class=_formatter(),
            conflict_handler="resolve",
            **options,
        )

    def parse_args(self, args: Iterable[str] | None = None, namespace: Any = None) -> Any:
        if hasattr(sys.stdout, "reconfigure"):  # characters outside its encoding are escaped, as on stderr
            sys.stdout.reconfigure(errors="backslashreplace")
        if COMPLETING in os.environ:
            import argcomplete

            argcomplete.autocomplete(self)
        words = sys.argv[1:] if args is None else list(args)
        self._check_options(words)
        return super().parse_args(words, namespace)

    def _check_options(self, words: list[str]) -> None:
        """Refuse an unknown option before argparse complains of a missing one."""
        for word in words:
            name = word.partition("=")[0]
            if name == "--":
                return
            if (
                name.startswith("--")
                and not name.count(" ")
                and not any(known.startswith(name) for known in self._option_string_actions)
            ):
                self.error(f"no option {shown(name)}{did_you_mean(name, self._option_string_actions)}")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Refuse an unknown choice, in the wording of all commands."""
        if action.choices is not None and value not in action.choices:
            raise argparse.ArgumentError(
                None, not_one_of("/".join(action.option_strings) or action.dest, value, map(str, action.choices))
            )

    def error(self, message: str) -> NoReturn:
        print_to_stderr(self.prog, f"{message} (see {self.prog} --help)")
        sys.exit(2)


def _formatter() -> type[argparse.HelpFormatter]:
    """The formatter of --help: with colours where the output is a terminal and rich-argparse is installed."""
    if sys.stdout is not None and sys.stdout.isatty():
        with contextlib.suppress(ImportError):
            from rich_argparse import RawDescriptionRichHelpFormatter

            class Coloured(RawDescriptionRichHelpFormatter):
                """Rich's markup is off: brackets hold units."""

                text_markup = help_markup = False

            return Coloured
    return argparse.RawDescriptionHelpFormatter


def _wrapped(text: str) -> str:
    """The text wrapped to the terminal's width, line by line. Continuation lines are indented by 4 more, or to the
    second column of a row."""
    width = shutil.get_terminal_size().columns - 2
    lines = text.splitlines()
    if len(lines) == 1:
        return textwrap.fill(text, width)
    return "\n".join(textwrap.fill(line, width, subsequent_indent=" " * _indent(line)) for line in lines)


def _indent(line: str) -> int:
    """Columns before the second column of a row, "  simulate    swim a gait"; else 4 more than before the `line`."""
    row = re.match(r"  \S+ {2,}(?=\S)", line)
    return row.end() if row else len(line) - len(line.lstrip()) + 4


def print_to_stderr(program: str, message: object) -> None:
    """Write one line: the program's name and the text of `message`."""
    sys.stderr.write(f"{program}: {one_line(message)}\n")


@contextlib.contextmanager
def one_line_warnings(program: str) -> Iterator[None]:
    """Print each warning as "PROGRAM: warning: ...", without its file and line."""

    def show(message: Warning | str, category: type[Warning], *place: Any, **written: Any) -> None:
        print_to_stderr(program, f"warning: {message}")

    with warnings.catch_warnings():
        warnings.showwarning = show
        yield


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """Inside, Ctrl-C raises KeyboardInterrupt, so that the work can complete its output. Outside, `eel_command` lets
    Ctrl-C end a command at once."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def check_seconds(argument: str, value: float | None) -> None:
    """`ValueError` that names the `argument`, unless its `value` [s] is positive or None."""
    if value is not None and not value > 0.0:
        raise ValueError(f"{argument} must be > 0 s, got {value:g}")
