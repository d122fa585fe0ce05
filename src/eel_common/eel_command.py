# SPDX-License-Identifier: Apache-2.0
"""Starts all commands and nodes: before anything else is imported, it lets Ctrl-C end them silently, and refuses limits
of the shell that leave too little room.

Python's own handler of SIGINT raises KeyboardInterrupt in the midst of an import: a traceback, or a library that blames
its own installation. Libraries that find too little room abort, or blame theirs. So an entry point names `main` of a
module as `eel_command:main_of.PACKAGE.MODULE`, and each package imports this first, for `python -m PACKAGE.MODULE`.
Only Python's standard library is imported here, and nothing changes where a package is imported as a library.
"""

import contextlib
import importlib
import resource
import signal
import sys
from pathlib import Path

LEAST_FILES = 64  # a node has 20 to 30 files open, and one or two more for each other node
LEAST_MEMORY = 1.0  # GB of address space: a node or command takes up to 0.6 GB on two cores, and more on more
RERUN_MEMORY = 4.0  # GB, where Rerun is loaded
WITH_RERUN = ("eel_viz.ros.node", "eel_viz.bags.replay", "eel_viz.pictures.render")
CANNOT_START = 2  # exit status


class MainOf:
    """`main` of the module with this name, and the names of all modules below; it is imported when it is called."""

    def __init__(self, module: str) -> None:
        self._module = module

    def __getattr__(self, name: str) -> "MainOf":
        if name.startswith("_"):
            raise AttributeError(name)
        return MainOf(f"{self._module}.{name}".lstrip("."))

    def __call__(self, arguments: list[str] | None = None) -> int:
        """The exit status of `main`; `arguments`: None for those of this process, which then is this command alone."""
        if arguments is not None:
            status: int = importlib.import_module(self._module).main(arguments)
            return status
        name = Path(sys.argv[0]).name
        begin(self._module, name)
        with contextlib.suppress(OSError):  # the name of the process is python's after sh
            Path("/proc/self/comm").write_text(name)
        status = importlib.import_module(self._module).main()
        return status


def begin(module: str, name: str) -> None:
    """Make this process the command `name` in `module`: SIGINT ends it, also one that came before. SystemExit where it
    has too little room."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])  # executables of `make build` begin with it blocked
    files, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    memory, _ = resource.getrlimit(resource.RLIMIT_AS)
    least = RERUN_MEMORY if module in WITH_RERUN else LEAST_MEMORY
    reason = ""
    if 0 <= files < LEAST_FILES:
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
