"""What every command and node does at its command line: one line for an error, output that any terminal takes."""

import argparse
import sys

from eel_gaits.wording import one_line


class Parser(argparse.ArgumentParser):
    """An argument parser that says in one line what is wrong."""

    def parse_args(self, *arguments, **options):
        write_on_any_terminal()
        return super().parse_args(*arguments, **options)

    def error(self, message):
        complain(self.prog, f"{message} (see {self.prog} --help)")
        sys.exit(2)


def complain(program: str, error):
    """Write one line to stderr: what `error` says."""
    sys.stderr.write(f"{program}: {one_line(error)}\n")


def check_seconds(argument: str, value: float | None):
    """ValueError that names the argument unless its value [s] is positive, or None."""
    if value is not None and not value > 0.0:
        raise ValueError(f"{argument} must be > 0 s, got {value:g}")


def write_on_any_terminal():
    """Have stdout write characters that its encoding lacks as escapes, as stderr does, instead of failing."""
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")
