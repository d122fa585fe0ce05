# SPDX-License-Identifier: Apache-2.0
"""Output files: an output has its name only when it is complete.

An output is written under a temporary name: `run.npz` as `run.part.npz`. It gets its own name when it is complete.
Until then an older file stays unchanged, even after a full disk, an error or a kill. Only a file that existed at the
start is replaced. If another one has appeared since, the output gets a number: `run-2.npz`. A signal that ends the
process removes its incomplete outputs first; only SIGKILL leaves them.
"""

import contextlib
import errno
import itertools
import os
import signal
import stat
import threading
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from eel_common.wording import shown

BEGINNINGS = {".npz": b"PK", ".nc": b"CDF", ".png": b"\x89PNG", ".rrd": b"RRF", ".svg": b"<?xml"}
LONGEST_NAME = 255  # bytes, in nearly all file systems
KINDS = {stat.S_IFLNK: "a symbolic link", stat.S_IFDIR: "a folder", stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket"}
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

_unfinished: dict[Path, int] = {}  # drafts that a signal removes, each with the process that writes it
_starts: list[int] = []  # ns: when the present command began
_own: dict[Path, tuple[int, ...] | None] = {}  # files that this process has written
_written_as: dict[Path, Path] = {}  # output: the path it was given


class NotWritten(OSError):
    """An output could not be completed. The text names it and gives the reason."""


class Draft:
    """A new file at `path`, to be written. `complete` gives it its `name`; `discard` removes it.

    since: the start [ns, of `time.time_ns`], unless `command_begins` was earlier; None: now.
    kept: whether the file stays where a signal ends the process.
    `OSError` where `name` cannot be written, or was something other than an older output at the start.
    """

    def __init__(self, name: str | os.PathLike[str], since: int | None = None, *, kept: bool = False) -> None:
        self.name = Path(name)
        if not self.name.parent.is_dir():
            raise FileNotFoundError(errno.ENOENT, f"there is no folder {shown(str(self.name.parent))}")
        starts = [*_starts[-1:], *([] if since is None else [since])]
        self._older = _identity(self.name, min(starts, default=None))
        if self._older and (other := _other_content(self.name)):
            raise FileExistsError(errno.EEXIST, f"it is {other}")
        self.path = self._made()
        if not kept:
            _unfinished[self.path] = os.getpid()
            _take_signals()

    @property
    def replaces(self) -> bool:
        """Whether an older file exists, whose name the draft will get."""
        return self._older is not None and _identity(self.name) == self._older

    def complete(self) -> Path:
        """Give the file its name, or one with a number, and return the path. It replaces the older file. `OSError` if
        that fails; the draft then stays."""
        with self.path.open("rb") as file:
            os.fsync(file.fileno())
        name = self.name
        if self.replaces:
            self.path.replace(name)
        else:
            for number in itertools.count(2):
                if _renamed(self.path, name):
                    break
                name = numbered(self.name, number)
        self._is_over()
        _own[name.absolute()], _written_as[self.name.absolute()] = _identity(name), name
        return name

    def discard(self) -> None:
        """Remove the file."""
        self.path.unlink(missing_ok=True)
        self._is_over()

    def _is_over(self) -> None:
        """From now on no signal removes the file."""
        _unfinished.pop(self.path, None)
        _take_signals()

    def _made(self) -> Path:
        """Create a new file and return its path. Another process, or a killed one, may hold the same draft name."""
        for mark in itertools.chain(["part"], map("part-{}".format, itertools.count(2))):
            with contextlib.suppress(FileExistsError):
                (path := part_of(self.name, mark)).open("xb").close()
                break
        return path


def _take_signals() -> None:
    """Take the signals that end the process while there are drafts to remove. Other handlers stay, such as a node's.

    Only then: Python calls a handler late, where the main thread is in compiled code."""
    if threading.current_thread() is threading.main_thread():
        old, new = (signal.SIG_DFL, _end) if _unfinished else (_end, signal.SIG_DFL)
        for number in ENDING:
            if signal.getsignal(number) is old:
                signal.signal(number, new)


def _end(number: int, frame: Any) -> None:
    """Remove the drafts of this process, and end it by the signal `number`. Those of a parent stay."""
    for path, process in list(_unfinished.items()):
        if process == os.getpid():
            path.unlink(missing_ok=True)
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


def part_of(name: Path, mark: str = "part") -> Path:
    """The path of the output `name` while it is incomplete."""
    return beside(name, f".{mark}")


@contextlib.contextmanager
def command_begins() -> Iterator[None]:
    """Mark the start of a command: files that appear until the context ends count as new."""
    _starts.append(time.time_ns())
    try:
        yield
    finally:
        _starts.pop()


def numbered(name: Path, number: int) -> Path:
    """The path of the output `name` with a `number`."""
    return beside(name, f"-{number}")


def beside(name: Path, mark: str, end: str = "") -> Path:
    """The path beside the output `name`: its stem, shortened if needed, the `mark`, its suffix and the `end`."""
    left = LONGEST_NAME - len(os.fsencode(mark + name.suffix + end))
    return name.with_name(os.fsdecode(os.fsencode(name.stem)[:left]) + mark + name.suffix + end)


def written_as(name: str | os.PathLike[str]) -> Path:
    """The path that the last output `name` of this process was given: `name`, or one with a number."""
    return _written_as.get(Path(name).absolute(), Path(name))


def check_output(argument: str, name: str | os.PathLike[str]) -> None:
    """`ValueError` that names the `argument` if the output `name` cannot be written. An older file of its kind may
    exist."""
    try:
        Draft(name).discard()
    except OSError as error:
        reason = error.strerror or str(error)
        raise ValueError(f"{argument} {shown(os.fspath(name))} cannot be written: {reason}") from None


@contextlib.contextmanager
def replacing(name: str | os.PathLike[str], since: int | None = None) -> Iterator[Path]:
    """The path at which to write the output `name`. It is complete when the context ends without an error.

    since: as in `Draft`. Warns if the output is given a number. `NotWritten` for an `OSError` within.
    """
    with contextlib.ExitStack() as undo:
        try:
            draft = Draft(name, since)
            undo.callback(draft.discard)
            yield draft.path
            path = draft.complete()
        except OSError as error:
            raise NotWritten(f"{shown(os.fspath(name))} cannot be written: {error.strerror or error}") from error
        undo.pop_all()
    if path != draft.name:
        warnings.warn(appeared(draft.name, path), stacklevel=3)


def appeared(name: Path, path: Path) -> str:
    """The line that explains why the output `name` is at `path`."""
    return f"{shown(str(name))} has appeared since the start, and stays: the output is {shown(str(path))}"


def _renamed(path: Path, name: Path) -> bool:
    """Give the file at `path` a new `name`. Returns whether that name was free."""
    try:
        os.link(path, name)
    except FileExistsError:
        return False
    except OSError:  # a file system without hard links
        if os.path.lexists(name):
            return False
        path.replace(name)
        return True
    path.unlink()
    return True


def _identity(path: Path, since: int | None = None) -> tuple[int, ...] | None:
    """An identity of the file at `path`; None if it does not exist, or has appeared after `since` [ns]."""
    try:
        found = path.lstat()
    except FileNotFoundError:
        return None
    identity = found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns
    newer = since is not None and found.st_ctime_ns > since
    return None if newer and _own.get(path.absolute()) != identity else identity


def _other_content(path: Path) -> str:
    """What `path` holds, in words. Empty for nothing, an empty file, or a file of the kind its suffix names."""
    try:
        mode = path.lstat().st_mode
    except FileNotFoundError:
        return ""
    if not stat.S_ISREG(mode):
        return KINDS.get(stat.S_IFMT(mode), "a device")
    beginning = BEGINNINGS.get(path.suffix, b"")
    with path.open("rb") as file:
        found = file.read(len(beginning))
    return f"a file of another kind than {path.suffix}" if found and found != beginning else ""
