# SPDX-License-Identifier: Apache-2.0
"""Recordings as .rrd files."""

import datetime
import os
import pathlib
import time

import rerun as rr
from eel_common.files.output_file import Draft, NotWritten, appeared, numbered
from eel_common.wording import shown

from eel_viz.batched_stream import Rates
from eel_viz.recording.destination import (
    STALL_TIMEOUT,
    Delivery,
    Destination,
    LogFunction,
    close_stream,
    detach_blocked,
)
from eel_viz.recording.rrd_frames import cut_to_whole_messages, is_complete
from eel_viz.settings import Settings

FILE_TICK = 0.6  # s: most that a killed process loses; each batch of an entity takes some 700 bytes of the file
AGAIN_TICK = 60.0  # s: for data that can be recorded again; few large batches open fast in a catalogue
ROOM = 2**18  # bytes of free space needed: Rerun writes 170 kB at a time, and may block for ever if that fails
REMINDER = 30.0  # s between two warnings that nothing is saved
FILE_FLUSH_TIMEOUT = 1.0  # s for one flush to a file during a run


class FileDestination(Destination):
    """A .rrd file. The second recording and later ones get a number before the suffix.

    A recording is written to `run.part.rrd` and renamed to `run.rrd` when it is complete. An older file stays until
    then. A file that has appeared since the start is kept for good.

    retry_from: from this recording on, a file that cannot be written causes a warning and is retried; before, a
    ValueError. None: the data can be recorded again, so it is always a ValueError, and a file that cannot be completed
    is removed, with the error `NotWritten`.
    """

    def __init__(
        self, settings: Settings, log_info: LogFunction, log_warning: LogFunction, *, retry_from: int | None = None
    ) -> None:
        self._tick = AGAIN_TICK if retry_from is None else FILE_TICK
        rates = Rates(numbers=0.0, drawings=settings.skin_rate, tick=self._tick)
        super().__init__(settings, rates, log_info, log_warning, live=False)
        self._began = time.time_ns()
        self._first = pathlib.Path(settings.recording) if settings.recording else new_file()
        self._retry_from = retry_from
        self.keeps_partial = retry_from is not None
        self._reminded = (0, 0.0)  # number of the recording, and when [s] the last warning was logged

    def path(self, number: int) -> pathlib.Path:
        """The final path of recording `number`."""
        return self._first if number == 1 else numbered(self._first, number)

    def open(self, number: int, name: str) -> Delivery | None:
        """The stream of recording `number`; None if it cannot be written at present."""
        path = self.path(number)
        try:
            draft = Draft(path, self._began, kept=self.keeps_partial)
        except OSError as error:
            self._refuse(number, path, error.strerror or str(error))
            return None
        reason = space_error(draft.path, ROOM)
        if not reason:
            if draft.replaces:
                self.log_warning(f"{path} is there already and is replaced by the new recording when that is complete")
            self.log_info(f"saving to {path}; until it is complete, to {draft.path.name}")
            sink = rr.FileSink(str(draft.path), write_footer=self.settings.index)
            try:
                stream = self.make_stream(sink, name, rr.ChunkBatcherConfig(flush_tick=self._tick))
                return FileDelivery(self, stream, draft)
            except RuntimeError:  # no room for the sink's first bytes
                reason = write_error(draft.path)
        draft.discard()
        if not self.keeps_partial:
            raise NotWritten(_problem(draft.name, reason))
        self._refuse(number, draft.name, reason)
        return None

    def _refuse(self, number: int, path: pathlib.Path, reason: str) -> None:
        """Raise, or warn that nothing is saved: once per recording, then every `REMINDER` seconds."""
        problem = _problem(path, reason)
        if self._retry_from is None or number < self._retry_from:
            raise ValueError(problem)
        self.incomplete = True
        last, when = self._reminded
        if number != last or time.monotonic() - when > REMINDER:
            self._reminded = number, time.monotonic()
            self.log_warning(f"{problem}: nothing of this run is saved; it is tried again while running")


class FileDelivery(Delivery):
    """A stream to the file of a `draft`. If the file can no longer be written, it is given up: its readable part is
    kept where partial files are kept, otherwise it is removed."""

    destination: FileDestination

    def __init__(self, destination: FileDestination, stream: rr.RecordingStream, draft: Draft) -> None:
        super().__init__(destination, stream)
        self._draft, self._discarded = draft, False
        self._last_growth = (0, self._last_check)  # bytes, s: size of the file, and the time it was first seen

    def find_faults(self, now: float) -> None:
        """Give up the file if it has not grown for `STALL_TIMEOUT`. On a slow disk it still grows."""
        if self._arrived() or self.failed:
            return
        size = self._draft.path.stat().st_size if self._draft.path.exists() else 0
        if size != self._last_growth[0]:
            self._last_growth = (size, now)
        elif now - self._last_growth[1] > STALL_TIMEOUT:
            self._fail()

    def close(self, end: float = 0.0) -> None:
        """Close the stream and rename its file. A write error of the sink at the end shows only here."""
        if not self.failed:
            self.destination.fit(self.stream, end)
            self._arrived()
        if self.failed:
            return
        close_stream(self.stream)
        if self._discarded:
            return
        if self.destination.settings.index and not is_complete(self._draft.path):
            self._keep_part(write_error(self._draft.path))
            return
        try:
            path = self._draft.complete()
        except OSError as error:
            self._keep_part(error.strerror or str(error))
            return
        if path != self._draft.name:
            self.destination.log_warning(appeared(self._draft.name, path))

    def keep_older(self) -> None:
        if self._draft.replaces:
            self._discarded = True
            self._draft.discard()
            self.destination.log_info(f"nothing has come: {self._draft.name} stays as it was")

    def discard(self) -> None:
        """Remove the file, unless partial ones are kept."""
        self._discarded = not self.destination.keeps_partial
        if self._discarded:
            self._draft.discard()

    def _arrived(self) -> bool:
        try:
            return self.flushed(FILE_FLUSH_TIMEOUT)
        except RuntimeError:
            self._fail()
            return False

    def _fail(self) -> None:
        self.failed = True
        detach_blocked(self.stream)
        if not self._discarded:
            self._keep_part(write_error(self._draft.path))

    def _keep_part(self, reason: str) -> None:
        """Keep the readable part of the file, or remove it, with the error `NotWritten`."""
        path = self._draft.path
        if not self.destination.keeps_partial:
            self.discard()
            raise NotWritten(_problem(self._draft.name, reason))
        self.destination.incomplete = True
        size = cut_to_whole_messages(path) if path.exists() else 0
        self.destination.log_warning(
            f"recording {shown(str(path))} cannot be written any more: {reason}; it ends here, and what there is "
            f"({size / 1e6:.1f} MB) can be opened"
        )


def _problem(path: pathlib.Path, reason: str) -> str:
    return f"recording {shown(str(path))} cannot be written: {reason}"


def new_file() -> pathlib.Path:
    """A path in the working folder, made unique by the time and this process."""
    return pathlib.Path(f"eel-{datetime.datetime.now():%Y%m%d-%H%M%S}-{os.getpid()}.rrd")


def space_error(path: pathlib.Path, size: int) -> str:
    """The error of allocating `size` more bytes at the file's end; empty if there is room.

    The allocated bytes are released again.
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
    """The reason why the last write to the file failed."""
    return space_error(path, 65536) or "an earlier attempt failed"
