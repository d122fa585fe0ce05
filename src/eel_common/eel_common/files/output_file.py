# SPDX-License-Identifier: Apache-2.0
"""Output files: an output has its name only when it is complete.

An output is written beside its name: `run.npz` as `run.part.npz`. It takes its name when it is complete. Until then an
older file stays as it was, whatever happens: a full disk, an error, a kill. Only a file that was there at the start is
replaced. Where another one has appeared since, the output gets a number: `run-2.npz`.
"""

import contextlib
import errno
import itertools
import os
import stat
import time
import warnings
from collections.abc import Iterator
from pathlib import Path

from eel_common.wording import shown

BEGINNINGS = {".npz": b"PK", ".nc": b"CDF", ".png": b"\x89PNG", ".rrd": b"RRF", ".svg": b"<?xml"}
LONGEST_NAME = 255  # bytes, in nearly all file systems
KINDS = {stat.S_IFLNK: "a symbolic link", stat.S_IFDIR: "a folder", stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket"}

_starts: list[int] = []  # ns: when the present command began
_own: dict[Path, tuple[int, ...] | None] = {}  # files that this process has written
_written_as: dict[Path, Path] = {}  # output: the path that it has got


class NotWritten(OSError):
    """An output could not be completed. The text names it and gives the reason."""


class Draft:
    """A new file at `path`, to be written. `complete` gives it its `name`; `discard` removes it.

    since: the start [ns, of `time.time_ns`], where the command has not begun before (`command_begins`); None: now.
    `OSError` where `name` cannot be written, or held something other than an older output at the start.
    """

    def __init__(self, name: str | os.PathLike[str], since: int | None = None) -> None:
        self.name = Path(name)
        if not self.name.parent.is_dir():
            raise FileNotFoundError(errno.ENOENT, f"there is no folder {shown(str(self.name.parent))}")
        starts = [*_starts[-1:], *([] if since is None else [since])]
        self._older = _identity(self.name, min(starts, default=None))
        if self._older and (other := _other_content(self.name)):
            raise FileExistsError(errno.EEXIST, f"it is {other}")
        self.path = self._made()

    @property
    def replaces(self) -> bool:
        """Whether there is an older file, whose name the draft will get."""
        return self._older is not None and _identity(self.name) == self._older

    def complete(self) -> Path:
        """Give the file its name, in place of the older one, or one with a number; returns it. `OSError` where that
        fails; the draft then stays."""
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
        _own[name.absolute()], _written_as[self.name.absolute()] = _identity(name), name
        return name

    def discard(self) -> None:
        """Remove the file."""
        self.path.unlink(missing_ok=True)

    def _made(self) -> Path:
        """The path of a new file. Another process, or a killed one, may have left a draft of the same name."""
        for mark in itertools.chain(["part"], map("part-{}".format, itertools.count(2))):
            with contextlib.suppress(FileExistsError):
                (path := part_of(self.name, mark)).open("xb").close()
                break
        return path


def part_of(name: Path, mark: str = "part") -> Path:
    """The path of the output `name` until it is complete."""
    return beside(name, f".{mark}")


@contextlib.contextmanager
def command_begins() -> Iterator[None]:
    """What appears from now on, until the context ends, has appeared since the start."""
    _starts.append(time.time_ns())
    try:
        yield
    finally:
        _starts.pop()


def numbered(name: Path, number: int) -> Path:
    """The path of the output `name` with a `number`."""
    return beside(name, f"-{number}")


def beside(name: Path, mark: str, end: str = "") -> Path:
    """The path beside the output `name` of its stem, cut where it must be, the `mark`, its suffix and the `end`."""
    left = LONGEST_NAME - len(os.fsencode(mark + name.suffix + end))
    return name.with_name(os.fsdecode(os.fsencode(name.stem)[:left]) + mark + name.suffix + end)


def written_as(name: str | os.PathLike[str]) -> Path:
    """The path that the last output `name` of this process has got: `name`, or one with a number."""
    return _written_as.get(Path(name).absolute(), Path(name))


def check_output(argument: str, name: str | os.PathLike[str]) -> None:
    """`ValueError` that names the `argument` where the output `name` cannot be written. An older file of its kind is no
    obstacle."""
    try:
        Draft(name).discard()
    except OSError as error:
        reason = error.strerror or str(error)
        raise ValueError(f"{argument} {shown(os.fspath(name))} cannot be written: {reason}") from None


@contextlib.contextmanager
def replacing(name: str | os.PathLike[str], since: int | None = None) -> Iterator[Path]:
    """The path to which to write the output `name`. It is complete when the context ends without an error.

    since: as in `Draft`. A warning says where it has got a number. `NotWritten` where an `OSError` occurs within.
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
    """The line that says why the output `name` is at `path`."""
    return f"{shown(str(name))} has appeared since the start, and stays: the output is {shown(str(path))}"


def _renamed(path: Path, name: Path) -> bool:
    """Give the file at `path` a new `name`; whether that was free."""
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
    """What tells the file at `path` from any other; None if there is none, or if it has appeared since a time [ns]."""
    try:
        found = path.lstat()
    except FileNotFoundError:
        return None
    identity = found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns
    newer = since is not None and found.st_ctime_ns > since
    return None if newer and _own.get(path.absolute()) != identity else identity


def _other_content(path: Path) -> str:
    """What `path` holds, in words. Empty for nothing, an empty file, or a file that begins as its kind does."""
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
