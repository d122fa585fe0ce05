"""Runs as .rrd files, where the user said; nowhere else."""

import datetime
import os
import pathlib
import time

import rerun as rr

from eel_viz.destination import Destination, Say
from eel_viz.loggers import Rates
from eel_viz.settings import Settings

FILE_TICK = 0.6  # s: a process that is killed loses no more; each batch of an entity costs its file some 700 bytes
REMINDER = 30.0  # s between two times at which it is said that nothing is saved


class File(Destination):
    """A .rrd file; the second run and later ones get a number before the suffix.

    `patient_from`: number of the run from which on a file that cannot be written is said, now and then, and tried
    again; before that, and always if it is None, it is a ValueError.
    """

    def __init__(self, settings: Settings, say: Say, warn: Say, *, patient_from: int | None = None) -> None:
        super().__init__(
            settings, Rates(numbers=0.0, drawings=settings.skin_rate, tick=FILE_TICK), say, warn, live=False
        )
        self._first = pathlib.Path(settings.recording) if settings.recording else new_file()
        self._patient_from = patient_from
        self._files: dict[int, pathlib.Path] = {}
        self._incomplete = False
        self._reminded = (0, 0.0)  # number of the run, and when [s] it was said that it is not saved

    @property
    def incomplete(self) -> bool:
        """Whether it lacks a part of a run."""
        return self._incomplete

    def path(self, run: int) -> pathlib.Path:
        """The file of run number `run`."""
        first = self._first
        return first if run == 1 else first.with_name(f"{first.stem}-{run}{first.suffix}")

    def file(self, run: int) -> pathlib.Path | None:
        """The file that run number `run` is written to."""
        return self._files.get(run)

    def _batches(self) -> rr.ChunkBatcherConfig:
        return rr.ChunkBatcherConfig(flush_tick=FILE_TICK)

    def _sink(self, run: int) -> rr.FileSink | None:
        path = self.path(run)
        existed = path.exists() and path.stat().st_size > 0
        problem = obstacle(path)
        if problem:
            self._refuse(run, f"recording {str(path)!r} cannot be written: {problem}")
            return None
        if existed:
            self.warn(f"{path} is there already and is replaced")
        self.say(f"saving to {path}")
        self._files[run] = path
        return rr.FileSink(str(path), write_footer=self.settings.index)

    def _refuse(self, run: int, problem: str) -> None:
        """Raise, or say that nothing is saved: at once for each run, and then as a reminder."""
        if self._patient_from is None or run < self._patient_from:
            raise ValueError(problem)
        self._incomplete = True
        last, when = self._reminded
        if run != last or time.monotonic() - when > REMINDER:
            self._reminded = run, time.monotonic()
            self.warn(f"{problem}: nothing of this run is saved; it is tried again while running")


def new_file() -> pathlib.Path:
    """A file in the present folder, named after the time; made at once, so that no other process takes the same one."""
    name = f"eel-{datetime.datetime.now():%Y%m%d-%H%M%S}"
    path = pathlib.Path(f"{name}.rrd")
    try:
        path.open("xb").close()
    except FileExistsError:
        return pathlib.Path(f"{name}-{os.getpid()}.rrd")
    except OSError:
        pass  # said where it is opened
    return path


def obstacle(path: pathlib.Path) -> str:
    """Why `path` cannot be written; empty if it can. A FileSink does not say it."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("ab"):
            return ""
    except OSError as error:
        return error.strerror or str(error)
