"""Whether what is logged arrives: a disk may be full, a viewer may have stopped reading.

Rerun tells neither: a file that could not be written once swallows all that follows, and logging to a viewer that does
not read blocks for ever after some 300 MB, as ending that stream does. Both show when the stream is flushed: it fails,
or it takes for ever where writing failed in that very moment.
"""

import os
import pathlib
import sys
import threading
import time

import rerun as rr

LOOK = 0.5  # s between two looks: a process that is killed loses no more of its file
FILE_LIMIT = 1.0  # s that writing what is there may take, in mid-run
VIEWER_LIMIT = 0.1  # s in which a viewer takes what is there; nobody waits longer for it
PATIENCE = 2.0  # s without reading, after which it is said

_abandoned: list = []


class Flow:
    """One stream of a `Destination`: to the file `path`, to a viewer if it is live, or to whatever the caller wants,
    which is then the caller's to look after."""

    def __init__(self, stream: rr.RecordingStream, destination, path: pathlib.Path | None) -> None:
        self._stream, self._destination, self._path = stream, destination, path
        self._say, self._warn = destination.say, destination.warn
        self._watched = path is not None or destination.live
        self._looked = time.monotonic()
        self._since: float | None = None  # s: since when the viewer has not read
        self._told = False
        self._grown = (0, self._looked)  # bytes, s: size of the file, and when it was first seen
        self.lost = False  # the file cannot be written any more
        self.gone = False  # the viewer has ended

    @property
    def runs(self) -> bool:
        """Whether to log to it."""
        return not self.lost and not self.gone and self._since is None

    def attend(self) -> None:
        """Now and then: see whether all has arrived."""
        now = time.monotonic()
        if not self._watched or self.lost or self.gone or now - self._looked < LOOK:
            return
        if self._flushed(VIEWER_LIMIT if self._path is None else FILE_LIMIT):
            if self._told:
                self._say("the viewer reads again")
            self._since, self._told = None, False
        elif self._path is not None:
            self._watch_file(now)
        else:
            self._since = now if self._since is None else self._since
            if now - self._since > PATIENCE and not self._told:
                self._told = True
                self._warn(f"the viewer has not read for {PATIENCE:g} s: it misses what comes until it does")
        self._looked = time.monotonic()

    def _watch_file(self, now: float) -> None:
        """It may be slow; if it does not grow either, nobody writes it any more."""
        size = self._path.stat().st_size if self._path.exists() else 0
        if size != self._grown[0]:
            self._grown = (size, now)
        elif not self.lost and now - self._grown[1] > PATIENCE:
            self._lose()

    def close(self) -> None:
        """Bring out what is on its way and end the stream: a file is then complete."""
        arrived = not self._watched or self.lost or self.gone
        arrived = arrived or self._flushed(VIEWER_LIMIT if self._path is None else FILE_LIMIT)
        if self._path is None and not arrived and not self.gone:
            abandon(self._stream)
        elif not self.lost:
            self._destination.end(self._stream)

    def _flushed(self, seconds: float) -> bool:
        """Whether all has arrived within so many seconds."""
        try:
            self._stream.flush(timeout_sec=seconds)
        except RuntimeError as error:
            if "timed out" in str(error):
                return False
            if self._path is None:
                self.gone = True
            else:
                self._lose()
            return False
        return True

    def _lose(self) -> None:
        self.lost = True
        abandon(self._stream)
        self._destination.break_off(self._stream)


def obstacle_to_growth(path: pathlib.Path, size: int) -> str:
    """Why the file cannot take `size` more bytes, found by trying; empty if it can. What was tried is taken back."""
    try:
        before = path.stat().st_size
        with path.open("r+b") as file:
            try:
                os.posix_fallocate(file.fileno(), before, size)
            finally:
                file.truncate(before)
    except OSError as error:
        return error.strerror or str(error)
    return ""


def why_not_written(path: pathlib.Path) -> str:
    """The reason why the file could not be written a moment ago."""
    return obstacle_to_growth(path, 65536) or "an earlier attempt failed"


def abandon(blocked: rr.RecordingStream | threading.Thread) -> None:
    """Leave something alone that would block whoever ends it, this process at its end too."""
    _abandoned.append(blocked)


def leave(status: int) -> int:
    """`status`, for the process to exit with; where a stream had to be abandoned, the process ends here."""
    if _abandoned:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    return status
