# SPDX-License-Identifier: Apache-2.0
"""Output files: an output has its name only when it is complete.

An output is written beside its name: `run.npz` as `run.part.npz`. It takes its name when it is complete. Until then an
older file stays as it was, whatever happens: a full disk, an error, a kill.
"""

import contextlib
import errno
import itertools
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from eel_base.wording import shown

BEGINNINGS = {".npz": b"PK", ".nc": b"CDF", ".png": b"\x89PNG", ".rrd": b"RRF", ".svg": b"<?xml"}
KINDS = {stat.S_IFLNK: "a symbolic link", stat.S_IFDIR: "a folder", stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket"}


class NotWritten(OSError):
    """An output could not be completed. The text names it and gives the reason."""


class Draft:
    """A new file at `path`, to be written. `complete` gives it its `name`; `discard` removes it.

    `OSError` where `name` cannot be written, or holds something other than an older output.
    """

    def __init__(self, name: str | os.PathLike[str]) -> None:
        self.name = Path(name)
        if not self.name.parent.is_dir():
            raise FileNotFoundError(errno.ENOENT, f"there is no folder {shown(str(self.name.parent))}")
        other = _other_content(self.name)
        if other:
            raise FileExistsError(errno.EEXIST, f"it is {other}")
        self.path = self._made()

    def complete(self) -> None:
        """Give the file its name, in place of an older one. `OSError` where that fails; the draft then stays."""
        with self.path.open("rb") as file:
            os.fsync(file.fileno())
        self.path.replace(self.name)

    def discard(self) -> None:
        """Remove the file."""
        self.path.unlink(missing_ok=True)

    def _made(self) -> Path:
        """The path of a new file. Another process, or a killed one, may have left a draft of the same name."""
        path = part_of(self.name)
        for number in itertools.count(2):
            try:
                path.open("xb").close()
                break
            except FileExistsError:
                path = part_of(self.name, f"part-{number}")
        return path


def part_of(name: Path, mark: str = "part") -> Path:
    """The path of the output `name` until it is complete."""
    return name.with_name(f"{name.stem}.{mark}{name.suffix}")


def obstacle(name: str | os.PathLike[str]) -> str:
    """The reason why the output `name` cannot be written; empty if it can. An older file of its kind is no obstacle."""
    try:
        Draft(name).discard()
    except OSError as error:
        return error.strerror or str(error)
    return ""


def check_output(argument: str, name: str | os.PathLike[str]) -> None:
    """`ValueError` that names the `argument` where the output `name` cannot be written."""
    problem = obstacle(name)
    if problem:
        raise ValueError(f"{argument} {shown(os.fspath(name))} cannot be written: {problem}")


@contextlib.contextmanager
def replacing(name: str | os.PathLike[str]) -> Iterator[Path]:
    """The path to which to write the output `name`. The output is complete when the context ends without an error.

    `NotWritten` where an `OSError` occurs in the context.
    """
    with contextlib.ExitStack() as undo:
        try:
            draft = Draft(name)
            undo.callback(draft.discard)
            yield draft.path
            draft.complete()
        except OSError as error:
            raise NotWritten(f"{shown(os.fspath(name))} cannot be written: {error.strerror or error}") from error
        undo.pop_all()


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
