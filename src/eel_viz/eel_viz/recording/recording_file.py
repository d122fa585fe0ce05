# SPDX-License-Identifier: Apache-2.0
"""Recordings as .rrd files."""

import datetime
import os
import pathlib
import time

import rerun as rr
from eel_base.files.output_file import Draft, NotWritten, appeared, numbered
from eel_base.wording import shown

from eel_viz.batched_stream import Rates
from eel_viz.recording.delivery import space_error, write_error
from eel_viz.recording.destination import Destination, LogFunction
from eel_viz.recording.rrd_frames import cut_to_whole_messages, is_complete
from eel_viz.settings import Settings

FILE_TICK = 0.6  # s: a process that is killed loses no more; each batch of an entity takes some 700 bytes of the file
AGAIN_TICK = 60.0  # s: where the data can be recorded again; few large batches make a catalogue of files open fast
ROOM = 2**18  # bytes that must be free: Rerun writes 170 kB at once, and may block for ever if that fails
REMINDER = 30.0  # s between two warnings that nothing is saved


class FileDestination(Destination):
    """A .rrd file; the second recording and later ones get a number before the suffix.

    A recording is written to `run.part.rrd` and renamed to `run.rrd` when it is complete; an older file stays until
    then, and one that has appeared since the start stays for good.

    retry_from: from this recording on, a file that cannot be written gives a warning and is retried; before, it is a
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
        self._keeps_partial = retry_from is not None
        self._drafts: dict[int, Draft] = {}  # by number of the recording
        self._streams: dict[int, rr.RecordingStream] = {}
        self._discarded = False
        self._reminded = (0, 0.0)  # number of the recording, and when [s] the last warning was logged

    def path(self, number: int) -> pathlib.Path:
        """The final path of recording `number`."""
        return self._first if number == 1 else numbered(self._first, number)

    def file(self, number: int) -> pathlib.Path | None:
        """The file that recording `number` is written to now."""
        draft = self._drafts.get(number)
        return draft.path if draft else None

    def open(self, number: int, name: str) -> rr.RecordingStream | None:
        """The stream of recording `number`; None if it cannot be written now."""
        path = self.path(number)
        try:
            draft = Draft(path, self._began)
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
            except RuntimeError:  # no room for the sink's first bytes
                reason = write_error(draft.path)
            else:
                self._drafts[number], self._streams[number] = draft, stream
                return stream
        draft.discard()
        if not self._keeps_partial:
            raise NotWritten(_problem(draft.name, reason))
        self._refuse(number, draft.name, reason)
        return None

    def close_recording(self, stream: rr.RecordingStream) -> None:
        """Close the stream and rename its file. A write error of the sink at the end shows only now."""
        super().close_recording(stream)
        if self._discarded:
            return
        draft = self._pop_draft(stream)
        if self.settings.index and not is_complete(draft.path):
            self._keep_partial(draft, write_error(draft.path))
            return
        try:
            path = draft.complete()
        except OSError as error:
            self._keep_partial(draft, error.strerror or str(error))
            return
        if path != draft.name:
            self.log_warning(appeared(draft.name, path))

    def abort(self, stream: rr.RecordingStream) -> None:
        """Handle a file that can no longer be written: keep its readable part, or remove it."""
        if not self._discarded:
            draft = self._pop_draft(stream)
            self._keep_partial(draft, write_error(draft.path))

    def _keep_partial(self, draft: Draft, reason: str) -> None:
        path = draft.path
        if not self._keeps_partial:
            draft.discard()
            self.discard()
            raise NotWritten(_problem(draft.name, reason))
        self.incomplete = True
        size = cut_to_whole_messages(path) if path.exists() else 0
        self.log_warning(
            f"recording {shown(str(path))} cannot be written any more: {reason}; it ends here, and what there is "
            f"({size / 1e6:.1f} MB) can be opened"
        )

    def discard(self) -> None:
        """After an error: remove the incomplete files, unless partial ones are kept."""
        self._discarded = not self._keeps_partial
        for draft in self._drafts.values():
            if self._discarded:
                draft.discard()

    def _pop_draft(self, stream: rr.RecordingStream) -> Draft:
        """Forget the stream, and return its draft."""
        number = next(number for number, each in self._streams.items() if each is stream)
        del self._streams[number]
        return self._drafts.pop(number)

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


def _problem(path: pathlib.Path, reason: str) -> str:
    return f"recording {shown(str(path))} cannot be written: {reason}"


def new_file() -> pathlib.Path:
    """A path in the working folder, named after the time and this process, so that it is unique."""
    return pathlib.Path(f"eel-{datetime.datetime.now():%Y%m%d-%H%M%S}-{os.getpid()}.rrd")
