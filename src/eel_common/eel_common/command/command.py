# SPDX-License-Identifier: Apache-2.0
"""What all commands share: one-line errors, the exit status, Ctrl-C, and the check of outputs."""

import argparse
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

from eel_common.command.command_line import Parser, interruptible, one_line_warnings, print_to_stderr
from eel_common.files.output_file import NotWritten, check_output, command_begins
from eel_common.wording import WorkStopped, shown

Work = Callable[[argparse.Namespace], int | None]  # the work of a command: returns its exit status, or None for 0


def command(
    name: str, description: str, *, add_options: Callable[[Parser], None], epilog: str = "", interrupted: str = ""
) -> Callable[[Work], Callable[..., int]]:
    """Decorator: turns a function of the options into main(arguments) of the command `name`.

    description, epilog: texts of its help.
    add_options(parser): adds its options.
    interrupted: printed after Ctrl-C, with status 130: what is left behind. Empty: Ctrl-C ends the command at once.
    main returns the exit status: that of the work; 1 where an output cannot be completed; 2 for bad input, a missing
    package or too little memory; that of a `WorkStopped`, 3 for a swim that stops. An error prints one line.
    """

    def main_of(work: Work) -> Callable[..., int]:
        def main(arguments: list[str] | None = None) -> int:
            parser = Parser(prog=name, description=description, epilog=epilog)
            add_options(parser)
            options, leaves_something = parser.parse_args(arguments), interruptible() if interrupted else nullcontext()
            try:
                with one_line_warnings(name), command_begins(), leaves_something:
                    return work(options) or 0
            except (NotWritten, ValueError, OSError, ImportError, MemoryError, WorkStopped) as error:
                print_to_stderr(
                    name, f"it does not fit into memory: {error}" if isinstance(error, MemoryError) else error
                )
                if isinstance(error, WorkStopped):
                    return error.exit_status
                return 1 if isinstance(error, NotWritten) else 2
            except KeyboardInterrupt:
                print_to_stderr(name, f"interrupted{interrupted}")
                return 130

        return main

    return main_of


def checked_out(command: str, out: str, suffixes: tuple[str, ...], option: str = "--out") -> Path:
    """The path of an output of the `command`, given by its `option`. Prints a notice if the file exists. `ValueError`
    for other suffixes."""
    path = Path(out)
    if path.suffix not in suffixes:
        raise ValueError(f"{option} must end in {', '.join(suffixes[:-1])} or {suffixes[-1]}, got {shown(out)}")
    check_output(option, path)
    if path.exists():
        print_to_stderr(command, f"{path} exists and will be overwritten")
    return path
