"""Runs as .rrd files, where the user said; nowhere else."""

import datetime
import os
import pathlib
import time

import rerun as rr
from eel_gaits.output_file import Draft, NotWritten
from eel_gaits.wording import shown

from eel_viz.recording.delivery import obstacle_to_growth, why_not_written
from eel_viz.recording.destination import Destination, Say
from eel_viz.recording.loggers import Rates
from eel_viz.recording.rrd_frames import cut_to_whole_messages, is_complete
from eel_viz.settings import Settings

FILE_TICK = 0.6  # s: a process that is killed loses no more; each batch of an entity costs its file some 700 bytes
ROOM = 2**18  # bytes that must be free: rerun writes 170 kB at once, and may wait for ever where that fails
REMINDER = 30.0  # s between two times at which it is said that nothing is saved


class File(Destination):
    """A .rrd file; the second run and later ones get a number before the suffix.

    A recording is written as `run.part.rrd` and named `run.rrd` when it is complete; an older file stays until then.

    `patient_from`: number of the run from which on a file that cannot be written is said, now and then, and tried
    again; before that it is a ValueError. None: the runs do not come from a network and can be had again. Then it is
    always a ValueError, and a file that cannot be written to its end is removed, with the error `NotWritten`.
    """

    def __init__(self, settings: Settings, say: Say, warn: Say, *, patient_from: int | None = None) -> None:
        super().__init__(
            settings, Rates(numbers=0.0, drawings=settings.skin_rate, tick=FILE_TICK), say, warn, live=False
        )
        self._first = pathlib.Path(settings.recording) if settings.recording else new_file()
        self._patient_from = patient_from
        self._keep = patient_from is not None  # what there is of a run
        self._drafts: dict[int, Draft] = {}  # by the number of the run
        self._streams: dict[int, rr.RecordingStream] = {}
        self._incomplete = self._dropped = False
        self._reminded = (0, 0.0)  # number of the run, and when [s] it was said that it is not saved

    @property
    def incomplete(self) -> bool:
        """Whether it lacks a part of a run."""
        return self._incomplete

    def path(self, run: int) -> pathlib.Path:
        """The name of run number `run`."""
        first = self._first
        return first if run == 1 else first.with_name(f"{first.stem}-{run}{first.suffix}")

    def file(self, run: int) -> pathlib.Path | None:
        """The file that run number `run` is written to."""
        draft = self._drafts.get(run)
        return draft and draft.path

    def open(self, run: int, name: str) -> rr.RecordingStream | None:
        """The stream of run number `run`; None: it cannot be written now."""
        try:
            stream = super().open(run, name)
        except RuntimeError:  # the sink's first bytes found no room
            self._give_up(run, why_not_written(self._drafts[run].path))
            return None
        if stream is not None:
            self._streams[run] = stream
        return stream

    def end(self, stream: rr.RecordingStream) -> None:
        """End a run's stream and give its file the name. What the sink could not write at the end shows only now."""
        super().end(stream)
        if self._dropped:
            return
        draft = self._without(stream)
        if self.settings.index and not is_complete(draft.path):
            self._keep_what_there_is(draft, why_not_written(draft.path))
            return
        try:
            draft.complete()
        except OSError as error:
            self._keep_what_there_is(draft, error.strerror or str(error))

    def break_off(self, stream: rr.RecordingStream) -> None:
        """The stream's file cannot be written any more: keep what there is of a run that cannot be had again."""
        if not self._dropped:
            draft = self._without(stream)
            self._keep_what_there_is(draft, why_not_written(draft.path))

    def _keep_what_there_is(self, draft: Draft, reason: str) -> None:
        path = draft.path
        if not self._keep:
            draft.discard()
            self.drop()
            raise NotWritten(f"recording {shown(str(draft.name))} cannot be written: {reason}")
        self._incomplete = True
        size = cut_to_whole_messages(path) if path.exists() else 0
        self.warn(
            f"recording {shown(str(path))} cannot be written any more: {reason}; it ends here, and what there is "
            f"({size / 1e6:.1f} MB) can be opened"
        )

    def drop(self) -> None:
        """An error ends the runs: remove what is not complete, unless it cannot be had again."""
        self._dropped = not self._keep
        for draft in self._drafts.values():
            if self._dropped:
                draft.discard()

    def _without(self, stream: rr.RecordingStream) -> Draft:
        """The stream's draft; neither is held any longer."""
        run = next(run for run, each in self._streams.items() if each is stream)
        del self._streams[run]
        return self._drafts.pop(run)

    def _batches(self) -> rr.ChunkBatcherConfig:
        return rr.ChunkBatcherConfig(flush_tick=FILE_TICK)

    def _sink(self, run: int) -> rr.FileSink | None:
        path = self.path(run)
        try:
            draft = Draft(path)
        except OSError as error:
            self._refuse(run, path, error.strerror or str(error))
            return None
        self._drafts[run] = draft
        problem = obstacle_to_growth(draft.path, ROOM)
        if problem:
            self._give_up(run, problem)
            return None
        if path.exists():
            self.warn(f"{path} is there already and is replaced by the new recording when that is complete")
        self.say(f"saving to {path}; until it is complete, to {draft.path.name}")
        return rr.FileSink(str(draft.path), write_footer=self.settings.index)

    def _give_up(self, run: int, reason: str) -> None:
        """The run's draft has no room: remove it, and raise or say why."""
        draft = self._drafts.pop(run)
        draft.discard()
        if not self._keep:
            raise NotWritten(f"recording {shown(str(draft.name))} cannot be written: {reason}")
        self._refuse(run, draft.name, reason)

    def _refuse(self, run: int, path: pathlib.Path, reason: str) -> None:
        """Raise, or say that nothing is saved: at once for each run, and then as a reminder."""
        problem = f"recording {shown(str(path))} cannot be written: {reason}"
        if self._patient_from is None or run < self._patient_from:
            raise ValueError(problem)
        self._incomplete = True
        last, when = self._reminded
        if run != last or time.monotonic() - when > REMINDER:
            self._reminded = run, time.monotonic()
            self.warn(f"{problem}: nothing of this run is saved; it is tried again while running")


def new_file() -> pathlib.Path:
    """A file in the present folder, named after the time and this process: no other one takes the same."""
    return pathlib.Path(f"eel-{datetime.datetime.now():%Y%m%d-%H%M%S}-{os.getpid()}.rrd")
