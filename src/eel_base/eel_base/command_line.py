# SPDX-License-Identifier: Apache-2.0
"""The command line of every command and node: one line per error, and output that any terminal can show."""

import argparse
import contextlib
import signal
import sys
from collections.abc import Iterator
from typing import Any, NoReturn

from eel_base.wording import one_line


class Parser(argparse.ArgumentParser):
    """An argument parser that reports an error in one line."""

    def parse_args(self, *arguments: Any, **options: Any) -> Any:
        write_on_any_terminal()
        return super().parse_args(*arguments, **options)

    def error(self, message: str) -> NoReturn:
        complain(self.prog, f"{message} (see {self.prog} --help)")
        sys.exit(2)


def complain(program: str, error: object) -> None:
    """Write one line to stderr: the program's name and the text of `error`."""
    sys.stderr.write(f"{program}: {one_line(error)}\n")


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """Let Ctrl-C raise KeyboardInterrupt in here, for work that leaves something whole; before and after, `eel_command`
    lets it end a command at once."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def check_seconds(argument: str, value: float | None) -> None:
    """`ValueError` that names the `argument`, unless its `value` [s] is positive or None."""
    if value is not None and not value > 0.0:
        raise ValueError(f"{argument} must be > 0 s, got {value:g}")


def write_on_any_terminal() -> None:
    """Let stdout write an escape for each character that its encoding lacks, as stderr does, instead of failing."""
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")
