"""What makes the Rerun streams of runs: one for each run, of the application `APPLICATION`, with a blueprint."""

import contextlib
import pathlib
from collections.abc import Callable

import rerun as rr
import rerun.blueprint as rrb

from eel_viz.recording.blueprint import arrangement
from eel_viz.recording.loggers import Rates
from eel_viz.settings import Settings

APPLICATION = "eel"
CLOSING_LIMIT = 3.0  # s for what is still on its way

Say = Callable[[str], None]


class Destination:
    """Makes the streams of runs. `rates`: how much of a run goes there; `say`, `warn`: one line to the user.
    `live`: a viewer looks on."""

    def __init__(self, settings: Settings, rates: Rates, say: Say, warn: Say, *, live: bool) -> None:
        self.settings, self.rates, self.say, self.warn = settings, rates, say, warn
        self.live = live
        self._arranged = False  # the viewer has our arrangement; in later runs the user's changes of it stay

    def file(self, run: int) -> pathlib.Path | None:
        """The file that run number `run` is written to; None where it goes elsewhere."""
        return None

    def open(self, run: int, name: str) -> rr.RecordingStream | None:
        """The stream of run number `run` (1, 2, ...), called `name`; None: not now."""
        sink = self._sink(run)
        if sink is None:
            return None
        return self._connected(sink, name)

    def _connected(self, sink: rr.FileSink | rr.GrpcSink, name: str) -> rr.RecordingStream | None:
        stream = rr.RecordingStream(APPLICATION, batcher_config=self._batches())
        stream.set_log_time_enabled(False)
        stream.set_sinks(sink, default_blueprint=self._blueprint())
        if self.live and not self._arranged:  # a default one that comes after the first data is not looked at
            stream.send_blueprint(self._blueprint(), make_active=True, make_default=True)
            self._arranged = True
        stream.send_recording_name(name)
        return stream

    def end(self, stream: rr.RecordingStream) -> None:
        """End a run's stream."""
        close_stream(stream)

    def break_off(self, stream: rr.RecordingStream) -> None:
        """The file of the run's `stream` cannot be written any more."""

    def drop(self) -> None:
        """An error ends the runs: what is not complete yet is not kept."""

    def lost(self) -> bool:
        """Whether what was open has gone, and its stream is to be given up."""
        return False

    @property
    def incomplete(self) -> bool:
        """Whether it lacks a part of a run that was to be kept there."""
        return False

    def close(self) -> None:
        """End what is not a run's: a server."""

    def _batches(self) -> rr.ChunkBatcherConfig:
        """How data are gathered before they are sent."""
        return rr.ChunkBatcherConfig.DEFAULT()

    def _blueprint(self) -> rrb.Blueprint:
        return arrangement(
            self.settings.blueprint, live=self.live, compare=bool(self.settings.compare), frames=self.settings.frames
        )

    def _sink(self, run: int) -> rr.FileSink | rr.GrpcSink | None:
        raise NotImplementedError


def close_stream(stream: rr.RecordingStream) -> None:
    """Bring out what is on its way, within `CLOSING_LIMIT`, and end the stream: a file is then complete."""
    with contextlib.suppress(RuntimeError):  # the viewer has gone; a file is complete all the same
        stream.flush(timeout_sec=CLOSING_LIMIT)
    stream.disconnect()
