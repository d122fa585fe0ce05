# SPDX-License-Identifier: Apache-2.0
"""What all commands have in common: errors of one line, the exit status, Ctrl-C, and the check of outputs."""

import argparse
import contextlib
from collections.abc import Callable
from pathlib import Path

from eel_base.command.command_line import Parser, interruptible, one_line_warnings, print_to_stderr
from eel_base.files.output_file import NotWritten, check_output, command_begins
from eel_base.wording import shown
from eel_base.work_stopped import WorkStopped

Work = Callable[[argparse.Namespace], int | None]  # of a command: returns its exit status, None for 0


def command(
    name: str, description: str, *, add_options: Callable[[Parser], None], epilog: str = "", interrupted: str = ""
) -> Callable[[Work], Callable[..., int]]:
    """Decorator: makes main(arguments) of the command `name` of what it does with its options.

    description, epilog: of its help. add_options(parser) adds its options. The rest as of `run_command`.
    """

    def main_of(work: Work) -> Callable[..., int]:
        def main(arguments: list[str] | None = None) -> int:
            parser = Parser(prog=name, description=description, epilog=epilog)
            add_options(parser)
            return run_command(parser, work, arguments, interrupted)

        return main

    return main_of


def run_command(
    parser: Parser,
    work: Work,
    arguments: list[str] | None,
    interrupted: str = "",
) -> int:
    """Do the `work` of a command with its `arguments`; None: those of this process.

    Returns the exit status: that of the work; 1 where an output cannot be written to its end; 2 for bad input, a
    missing package or too little memory; that of a `WorkStopped`, 3 for a swim that stops. An error prints one line
    with its reason. interrupted: what Ctrl-C leaves, printed with status 130; empty: Ctrl-C ends the command at once.
    """
    options, name = parser.parse_args(arguments), parser.prog
    try:
        with one_line_warnings(name), command_begins(), interruptible() if interrupted else contextlib.nullcontext():
            return work(options) or 0
    except NotWritten as error:
        print_to_stderr(name, error)
        return 1
    except (ValueError, OSError, ImportError) as error:
        print_to_stderr(name, error)
        return 2
    except MemoryError as error:
        print_to_stderr(name, f"it does not fit into memory: {error}")
        return 2
    except WorkStopped as error:
        print_to_stderr(name, error)
        return error.exit_status
    except KeyboardInterrupt:
        print_to_stderr(name, f"interrupted{interrupted}")
        return 130


def checked_out(command: str, out: str, suffixes: tuple[str, ...]) -> Path:
    """The path of an output of the `command`, which says so where the file exists. `ValueError` for another suffix."""
    path = Path(out)
    if path.suffix not in suffixes:
        raise ValueError(f"--out must end in {', '.join(suffixes[:-1])} or {suffixes[-1]}, got {shown(out)}")
    check_output("--out", path)
    if path.exists():
        print_to_stderr(command, f"{path} exists and will be overwritten")
    return path
