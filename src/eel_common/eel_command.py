# SPDX-License-Identifier: Apache-2.0
"""Starts every command and node. Two things happen before any other import: Ctrl-C is set to end the process silently,
and too old a Python, or too low a limit of the shell, is refused.

Python's own handler of SIGINT raises KeyboardInterrupt in the middle of an import, which prints a traceback. Libraries
that lack memory or files abort, or report a broken installation. So an entry point names `main` of a module as
`eel_command:main_of.PACKAGE.MODULE`, and each package imports this module first, for `python -m PACKAGE.MODULE`.
This module imports only Python's standard library, and older Pythons read it. Importing a package as a library changes
nothing.
"""

from __future__ import annotations

import contextlib
import importlib
import resource
import signal
import sys
from pathlib import Path

LEAST_PYTHON = (3, 11)  # of the packages' `python_requires`; pip heeds it, a PYTHONPATH does not
LEAST_FILES = 64  # a node opens 20 to 30 files, and one or two more for each other node
LEAST_MEMORY = 1.0  # GB of address space: a node or command takes up to 0.6 GB on two cores, more on more cores
RERUN_MEMORY = 4.0  # GB, where Rerun is loaded
WITH_RERUN = ("eel_viz.ros.node", "eel_viz.bags.replay", "eel_viz.pictures.render")
CANNOT_START = 2  # exit status


class MainOf:
    """`main` of the named module. Attributes name the modules below it. A call imports the module."""

    def __init__(self, module: str) -> None:
        self._module = module

    def __getattr__(self, name: str) -> MainOf:
        if name.startswith("_"):
            raise AttributeError(name)
        return MainOf(f"{self._module}.{name}".lstrip("."))

    def __call__(self, arguments: list[str] | None = None) -> int:
        """Run `main` and return its exit status. arguments: None takes this process's own, as the command it runs."""
        if arguments is not None:
            status: int = importlib.import_module(self._module).main(arguments)
            return status
        name = Path(sys.argv[0]).name
        begin(self._module, name)
        with contextlib.suppress(OSError):  # started by sh, the process is named python
            Path("/proc/self/comm").write_text(name)
        status = importlib.import_module(self._module).main()
        return status


def begin(module: str, name: str) -> None:
    """Make this process the command `name` of `module`. SIGINT ends it, even one that is pending. Raises SystemExit
    where Python is too old, or the shell's limits are too low."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])  # executables of `make build` start with SIGINT blocked
    files, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    memory, _ = resource.getrlimit(resource.RLIMIT_AS)
    least = RERUN_MEMORY if module in WITH_RERUN else LEAST_MEMORY
    reason = ""
    if sys.version_info < LEAST_PYTHON:
        needed, found = (".".join(map(str, version[:3])) for version in (LEAST_PYTHON, sys.version_info))
        reason = (
            f"Python {needed} or later is needed, and {sys.executable} is {found}: install with a later one "
            "(make build PYTHON=python3.12, or python3.12 -m pip install)"
        )
    elif 0 <= files < LEAST_FILES:
        reason = f"at least {LEAST_FILES} open files are needed, and the limit is {files} (ulimit -n)"
    elif 0 <= memory < least * 1e9:
        reason = f"at least {least:g} GB of addresses are needed, and the limit is {1e-9 * memory:.2g} GB (ulimit -v)"
    if reason:
        sys.stderr.write(f"{name}: {reason}\n")
        sys.exit(CANNOT_START)


main_of = MainOf("")

# `python -m PACKAGE.MODULE` imports the package before the module; sys.argv begins with -m until then.
if sys.argv[:1] == ["-m"] and "-m" in sys.orig_argv:
    asked = sys.orig_argv[sys.orig_argv.index("-m") + 1]
    if asked.startswith("eel_"):
        begin(asked, asked)
