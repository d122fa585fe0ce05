# SPDX-License-Identifier: Apache-2.0
"""Checks that logged data arrives: a disk may be full, a viewer may have stopped reading.

Rerun reports neither. After one failed write a file silently drops everything that follows. Logging to a viewer that
does not read blocks for ever after some 300 MB, and so does closing that stream. Both faults show when the stream is
flushed: the flush fails, or it times out.
"""

import os
import pathlib
import threading
import time
from typing import Any

import rerun as rr

from eel_viz.recording.destination import Destination

CHECK_PERIOD = 0.5  # s between two checks; a process that is killed loses no more of its file
FILE_FLUSH_TIMEOUT = 1.0  # s for one flush to a file during a run
VIEWER_FLUSH_TIMEOUT = 0.1  # s for one flush to a viewer
STALL_TIMEOUT = 2.0  # s without progress, after which a viewer is reported and a file is given up

_detached: list[rr.RecordingStream | threading.Thread] = []


class DeliveryMonitor:
    """Watches one stream of a `Destination`: to the file `path`, or to a viewer if the destination is live.

    A stream that the caller owns is not watched.

    Attributes:
        stream: what it watches.
        failed: the file can no longer be written.
        disconnected: the viewer has ended.
    """

    def __init__(self, stream: rr.RecordingStream, destination: Destination, path: pathlib.Path | None) -> None:
        self.stream, self._destination = stream, destination
        self._path: Any = path  # None where there is no file
        self._log_info, self._log_warning = destination.log_info, destination.log_warning
        self._watched = path is not None or destination.live
        self._last_check = time.monotonic()
        self._stalled_since: float | None = None  # s: since when the viewer has not read
        self._stall_reported = False
        self._last_growth = (0, self._last_check)  # bytes, s: size of the file, and when it was first seen
        self.failed = False
        self.disconnected = False

    @property
    def accepts_data(self) -> bool:
        """Whether data may be logged to the stream now."""
        return not self.failed and not self.disconnected and self._stalled_since is None

    def check(self) -> None:
        """Flush the stream and update its state; at most once in `CHECK_PERIOD`."""
        now = time.monotonic()
        if not self._watched or self.failed or self.disconnected or now - self._last_check < CHECK_PERIOD:
            return
        if self._flush():
            if self._stall_reported:
                self._log_info("the viewer reads again")
            self._stalled_since, self._stall_reported = None, False
        elif self._path is not None:
            self._check_growth(now)
        else:
            self._stalled_since = now if self._stalled_since is None else self._stalled_since
            if now - self._stalled_since > STALL_TIMEOUT and not self._stall_reported:
                self._stall_reported = True
                self._log_warning(
                    f"the viewer has not read for {STALL_TIMEOUT:g} s: it misses what comes until it does"
                )
        self._last_check = time.monotonic()

    def close(self, end: float = 0.0) -> None:
        """Flush and close the stream of a run that ends at `end` [s], which completes a file.

        A stream that blocks is detached instead.
        """
        if self.accepts_data:
            self._destination.fit(self.stream, end)
        arrived = not self._watched or self.failed or self.disconnected or self._flush()
        if self._path is None and not arrived and not self.disconnected:
            detach_blocked(self.stream)
        elif not self.failed:
            self._destination.close_recording(self.stream)

    def _check_growth(self, now: float) -> None:
        """Give the file up if it has not grown for `STALL_TIMEOUT`: a slow disk still grows it."""
        size = self._path.stat().st_size if self._path.exists() else 0
        if size != self._last_growth[0]:
            self._last_growth = (size, now)
        elif not self.failed and now - self._last_growth[1] > STALL_TIMEOUT:
            self._fail()

    def _flush(self) -> bool:
        """Flush the stream; whether all data arrived within the time-out."""
        try:
            self.stream.flush(timeout_sec=VIEWER_FLUSH_TIMEOUT if self._path is None else FILE_FLUSH_TIMEOUT)
        except RuntimeError as error:
            if "timed out" in str(error):
                return False
            if self._path is None:
                self.disconnected = True
            else:
                self._fail()
            return False
        return True

    def _fail(self) -> None:
        self.failed = True
        detach_blocked(self.stream)
        self._destination.abort(self.stream)


def space_error(path: pathlib.Path, size: int) -> str:
    """The error when `size` more bytes are allocated at the file's end; empty if there is room.

    The allocated bytes are removed again.
    """
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


def write_error(path: pathlib.Path) -> str:
    """Why the last write to the file failed."""
    return space_error(path, 65536) or "an earlier attempt failed"


def detach_blocked(blocked: rr.RecordingStream | threading.Thread) -> None:
    """Keep a reference to a blocked stream or thread: its destructor would block this process."""
    _detached.append(blocked)
